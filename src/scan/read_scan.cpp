#include "scan/read_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/small_file.h"
#include "base/table_rows.h"
#include "base/unicode.h"
#include "model_io/load.h"
#include "model_io/text.h"
#include "scan/dark_squares.h"

namespace hydrodip {

const char* const kSyntheticMark = "synthetic scan by hydrodip";

namespace {

// A film stretches on an object, and a square is looked at along its edges: their median length is
// between these times the printed length, or the unit is wrong.
constexpr double kLeastEdge = 0.7, kLargestEdge = 2.0;
constexpr std::size_t kFewestCorners = 4;
constexpr std::size_t kMostCorners = 1000000;

struct Unit {
  const char* name;
  const char* plural;
  double mm;
};
constexpr Unit kUnits[] = {{"mm", "millimetres", 1},
                           {"cm", "centimetres", 10},
                           {"in", "inches", kMmPerInch},
                           {"m", "metres", 1000}};

const Unit& find_unit(const std::string& name) {
  for (const Unit& unit : kUnits)
    if (name == unit.name || (name.empty() && unit.mm == 1)) return unit;
  throw InputError(fmt::format("--scan-units {}: not a known unit; use mm, cm, m or in", name));
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return extension;
}

// ---- quads ----

CornerGrid read_quads(const std::filesystem::path& file, const PolygonMesh& mesh) {
  std::vector<std::array<std::int32_t, 4>> quads;
  std::size_t triangles = 0, others = 0;
  for (const auto& face : mesh.faces) {
    if (face.size() == 4)
      quads.push_back({face[0], face[1], face[2], face[3]});
    else
      ++(face.size() == 3 ? triangles : others);
  }
  if (quads.empty() && triangles > 0)
    throw InputError(
        fmt::format("{}: all {} faces are triangles, but one face is needed for each square of the "
                    "checkerboard, with its four corners; draw a quad mesh over the scan "
                    "(docs/calibration.md), "
                    "or join triangles into quads before the export",
                    file.string(), triangles));
  if (triangles + others > 0)
    throw InputError(fmt::format(
        "{}: {} of {} faces do not have four corners; every face must be one square of the "
        "checkerboard: delete the others",
        file.string(), triangles + others, mesh.faces.size()));
  return grid_of_quads(mesh.positions, quads, file.string());
}

// ---- scans with colours ----

bool has_quads(const PolygonMesh& mesh) {
  return std::any_of(mesh.faces.begin(), mesh.faces.end(),
                     [](const auto& face) { return face.size() == 4; });
}

CornerGrid read_colours(const std::filesystem::path& file, double square_mm,
                        const std::string& units, const RunContext& context) {
  const LoadedObject loaded = load_object(file, {units, {}}, context.quiet());
  if (!loaded.object.has_appearance())
    throw InputError(fmt::format(
        "{}: a scan of triangles needs its colours, as a texture or of its vertices{}; or draw a "
        "quad mesh over it, a face for each square (docs/calibration.md)",
        file.string(),
        loaded.picture_problems.empty() ? "" : ": " + loaded.picture_problems.front()));
  CornerGrid grid = grid_of_dark_squares(find_dark_squares(loaded.object, square_mm));
  if (grid.position.size() < kFewestCorners)
    throw InputError(fmt::format(
        "{}: no dark squares of {:g} mm, each alone, are to be seen on it; check --square and "
        "--scan-units, or draw a quad mesh over it (docs/calibration.md)",
        file.string(), square_mm));
  return grid;
}

// ---- tables ----

bool is_heading(const std::vector<std::string>& cells) {
  return std::ranges::any_of(cells, [](const std::string& cell) {
    return std::ranges::any_of(cell, [](char c) {
      return (c >= 'a' && c <= 'z' && c != 'e') || (c >= 'A' && c <= 'Z' && c != 'E');
    });
  });
}

bool in_range(std::int64_t place) { return place > -100000 && place < 100000; }

CornerGrid read_table(const std::filesystem::path& file, std::string_view text) {
  CornerGrid grid;
  std::map<GridPlace, std::size_t> line_of;
  bool heading_allowed = true;
  for (TableRows rows(text); rows.next();) {
    const std::vector<std::string>& cells = rows.cells();
    const std::size_t number = rows.line();
    const bool heading = std::exchange(heading_allowed, false) && is_heading(cells);
    if (heading) continue;
    std::int64_t column = 0, row = 0;
    Vec3 p;
    bool good =
        cells.size() == 5 && parse_integer(cells[0], column) && parse_integer(cells[1], row);
    for (std::size_t k = 0; k < 3; ++k) good = good && parse_number(cells[2 + k], p[int(k)]);
    good = good && in_range(column) && in_range(row);
    if (!good)
      throw InputError(fmt::format(
          "{}, line {}: a corner is given as column,row,x,y,z: two whole numbers and three lengths",
          file.string(), number));
    const GridPlace place = {int(column), int(row)};
    const auto [entry, is_new] = line_of.try_emplace(place, number);
    if (!is_new)
      throw InputError(fmt::format("{}: lines {} and {} give the same corner (column {}, row {})",
                                   file.string(), entry->second, number, column, row));
    grid.position.push_back(p);
    grid.place.push_back(place);
    grid.patch.push_back(0);
    if (grid.place.size() > kMostCorners)
      throw InputError(fmt::format("{}: more than {} corners", file.string(), kMostCorners));
  }
  return grid;
}

// ---- checks ----

double median_edge(const CornerGrid& grid) {
  std::vector<double> edges;
  for (const GridLength& length : grid_lengths(grid))
    if (!length.diagonal)
      edges.push_back(
          (grid.position[std::size_t(length.from)] - grid.position[std::size_t(length.to)]).norm());
  if (edges.empty()) return 0;
  std::nth_element(edges.begin(), edges.begin() + std::ptrdiff_t(edges.size() / 2), edges.end());
  return edges[edges.size() / 2];
}

bool plausible(double edge_mm, double square_mm) {
  return edge_mm > kLeastEdge * square_mm && edge_mm < kLargestEdge * square_mm;
}

void check_size(const CornerGrid& grid, const Unit& unit, double square_mm,
                const std::string& name) {
  if (grid.position.size() < kFewestCorners)
    throw InputError(fmt::format("{}: {} corners are too few for a grid; at least {} are needed",
                                 name, grid.position.size(), kFewestCorners));
  const double edge_mm = median_edge(grid);
  if (!(edge_mm > 0))
    throw InputError(fmt::format(
        "{}: no two corners are neighbours at different places; check columns and rows", name));
  if (plausible(edge_mm, square_mm)) return;
  for (const Unit& other : kUnits)
    if (plausible(edge_mm / unit.mm * other.mm, square_mm))
      throw InputError(fmt::format(
          "{}: squares of {:.3g} mm were printed {:g} mm wide, so the scan's unit seems to be {}, "
          "not {}; give --scan-units {}",
          name, edge_mm, square_mm, other.plural, unit.plural, other.name));
  throw InputError(fmt::format(
      "{}: its squares are {:.3g} mm wide, but {:g} mm were printed; check --scan-units and "
      "--square",
      name, edge_mm, square_mm));
}

bool says_synthetic(std::string_view text) {
  return text.substr(0, 400).find(kSyntheticMark) != std::string_view::npos;
}

enum class ScanKind { kTable, kPolygons, kOther };

ScanKind kind_of(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (extension == ".csv" || extension == ".txt" || extension == ".tsv") return ScanKind::kTable;
  return extension == ".obj" || extension == ".ply" ? ScanKind::kPolygons : ScanKind::kOther;
}

// A mesh's faces turn round with it.
void turn_back(CornerGrid& grid, bool has_faces) {
  for (Vec3& p : grid.position) p.x() = -p.x();
  if (has_faces)
    for (GridPlace& place : grid.place) place[0] = -place[0];
}

constexpr std::uintmax_t kLargestTable = 64 << 20;

// Corners that somebody drew, or listed: by `read` from the file's text.
template <class Read>
Scan read_corners(const std::filesystem::path& file, const ScanOptions& options, const Read& read) {
  const Unit& unit = find_unit(options.units);
  const std::vector<std::uint8_t> bytes =
      kind_of(file) == ScanKind::kTable
          ? in_utf8(read_small_file(file, kLargestTable, "a table of corners"))
          : read_file(file);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  Scan scan;
  scan.synthetic = says_synthetic(text);
  scan.grid = read(text);
  for (Vec3& p : scan.grid.position) p *= unit.mm;
  check_size(scan.grid, unit, options.square_mm, file.string());
  if (options.mirrored) turn_back(scan.grid, kind_of(file) == ScanKind::kPolygons);
  return scan;
}

}  // namespace

Scan read_scan(const std::filesystem::path& file, const ScanOptions& options,
               const RunContext& context) {
  const ScanKind kind = kind_of(file);
  if (kind == ScanKind::kTable) return read_corner_scan(file, options, context);
  if (kind == ScanKind::kPolygons) {
    const PolygonMesh mesh = load_polygons(file, context);
    if (has_quads(mesh))
      return read_corners(file, options, [&](auto) { return read_quads(file, mesh); });
  }
  find_unit(options.units);
  const std::vector<std::uint8_t> bytes = read_file(file);
  Scan scan;
  scan.synthetic = says_synthetic({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  scan.grid = read_colours(file, options.square_mm, options.units, context);
  if (options.mirrored) turn_back(scan.grid, true);
  return scan;
}

Scan read_corner_scan(const std::filesystem::path& file, const ScanOptions& options,
                      const RunContext& context) {
  find_unit(options.units);
  switch (kind_of(file)) {
    case ScanKind::kTable:
      return read_corners(file, options,
                          [&](std::string_view text) { return read_table(file, text); });
    case ScanKind::kPolygons:
      return read_corners(file, options,
                          [&](auto) { return read_quads(file, load_polygons(file, context)); });
    case ScanKind::kOther:
      break;
  }
  throw InputError(fmt::format(
      "{}: a scan is a quad mesh (OBJ, PLY) or a table of corners (CSV, TXT)", file.string()));
}

void write_scan_table(const std::filesystem::path& file, const CornerGrid& grid,
                      const std::string& comment) {
  GridPlace low = {1 << 30, 1 << 30};
  for (const GridPlace& place : grid.place)
    low = {std::min(low[0], place[0]), std::min(low[1], place[1])};
  std::string text = fmt::format("# {}\ncolumn,row,x,y,z\n", comment);
  for (std::size_t c = 0; c < grid.position.size(); ++c)
    text += fmt::format("{},{},{:.6f},{:.6f},{:.6f}\n", grid.place[c][0] - low[0],
                        grid.place[c][1] - low[1], grid.position[c].x(), grid.position[c].y(),
                        grid.position[c].z());
  write_file(file, text);
}

void write_scan_quads(const std::filesystem::path& file, const CornerGrid& grid,
                      const std::string& comment) {
  std::map<GridPlace, std::size_t> corner_at;
  for (std::size_t c = 0; c < grid.place.size(); ++c) corner_at[grid.place[c]] = c;
  std::string text = fmt::format("# {}\n", comment);
  for (const Vec3& p : grid.position)
    text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x(), p.y(), p.z());
  for (const auto& [place, corner] : corner_at) {
    // Clockwise on the film, which is counter-clockwise from outside the object.
    std::array<std::size_t, 4> quad{};
    bool whole = true;
    constexpr GridPlace kAround[] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto found = corner_at.find({place[0] + kAround[k][0], place[1] + kAround[k][1]});
      whole = whole && found != corner_at.end();
      if (whole) quad[k] = found->second + 1;
    }
    if (whole) text += fmt::format("f {} {} {} {}\n", quad[0], quad[1], quad[2], quad[3]);
  }
  write_file(file, text);
}

}  // namespace hydrodip
