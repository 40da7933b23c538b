// Ink bends lines. As in the paper: a checkerboard printed on film is not straight on the pyramid,
// and only a simulation that knows the ink says how. And what that is good for: a checkerboard
// wanted on the pyramid, from a print made without and with regard to the ink, each dipped as it
// will be.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "figures.h"
#include "image/files.h"
#include "samples/samples.h"
#include "study.h"

namespace hydrodip::paper {
namespace {

constexpr double kSample_mm = 0.25;  // along lines
// Of the sample's own checkerboard, and of the one on film.
constexpr double kWantedCell_mm = 5, kFilmCell_mm = 10;

struct Deviation {
  double squares = 0, largest = 0;
  long count = 0;
  void add(double length) {
    squares += length * length;
    largest = std::max(largest, length);
    ++count;
  }
  double rms() const { return std::sqrt(squares / double(std::max(1L, count))); }
  std::string text() const { return fmt::format("{:.3f} | {:.3f}", rms(), largest); }
};

// Calls work(point, axis, line) for points on lines of a square grid: `axis` stays the same along
// `line`.
template <class Work>
void for_grid_points(double cell_mm, double reach_mm, const Work& work) {
  const int lines = int(reach_mm / cell_mm), samples = int(reach_mm / kSample_mm);
  for (int axis = 0; axis < 2; ++axis)
    for (int line = -lines; line <= lines; ++line)
      for (int s = -samples; s <= samples; ++s) {
        Vec2 point;
        point[axis] = line * cell_mm;
        point[1 - axis] = s * kSample_mm;
        work(point, axis, line);
      }
}

// Which of the pyramid's sloping faces a normal belongs to; nothing for its base.
std::optional<int> face_of(const Vec3& normal) {
  if (normal.head<2>().norm() < 0.1) return std::nullopt;
  const int axis = std::abs(normal.x()) > std::abs(normal.y()) ? 0 : 1;
  return 2 * axis + (normal[axis] > 0 ? 1 : 0);
}

// ---- the paper's figure: lines on the film, and what becomes of them ----

struct Landed {
  Vec3 position;
  int face;
};
std::optional<Landed> land(const DippedObject& dipped, const Vec2& u) {
  const TriangleMesh& mesh = dipped.posed.mesh();
  const auto at = dipped.map->to_object(u);
  if (!at) return std::nullopt;
  const auto face = face_of(face_normal(mesh, at->triangle));
  if (!face) return std::nullopt;
  return Landed{position_at(mesh, *at), *face};
}

// From the straight line that fits points on a plane best.
void add_bending(const std::vector<Vec3>& points, Deviation& bending) {
  if (points.size() < 20) return;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / double(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) spread += (p - mean) * (p - mean).transpose();
  const Vec3 along = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
  for (const Vec3& p : points) bending.add((p - mean).cross(along).norm());
}

// Of every line of the film's checkerboard on every face.
Deviation bending(const DippedObject& dipped) {
  std::map<std::array<int, 3>, std::vector<Vec3>> lines;
  for_grid_points(kFilmCell_mm, 60, [&](const Vec2& u, int axis, int line) {
    if (const auto at = land(dipped, u)) lines[{at->face, axis, line}].push_back(at->position);
  });
  Deviation result;
  for (const auto& [key, points] : lines) add_bending(points, result);
  return result;
}

// Between where two dips put the same points of the film's lines.
Deviation apart(const DippedObject& a, const DippedObject& b) {
  Deviation result;
  for_grid_points(kFilmCell_mm, 60, [&](const Vec2& u, int, int) {
    const auto in_a = land(a, u), in_b = land(b, u);
    if (in_a && in_b) result.add((in_a->position - in_b->position).norm());
  });
  return result;
}

// Over the whole sheet.
Image checkerboard(const SheetRaster& raster) {
  constexpr std::uint8_t kDark[4] = {38, 84, 124, 255};
  constexpr std::uint8_t kLight[4] = {255, 255, 255, 255};
  Image image(raster.width_px(), raster.height_px());
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) {
      const Vec2 u = raster.to_film(x + 0.5, y + 0.5) / kFilmCell_mm;
      const bool dark = (long(std::floor(u.x())) + long(std::floor(u.y()))) % 2 != 0;
      std::copy_n(dark ? kDark : kLight, 4, image.pixel(x, y));
    }
  return image;
}

struct Forward {
  Deviation even, inked, apart;
  Image film, even_picture, inked_picture;
};

Forward dip_checkerboard(const PosedObject& pyramid, const DesignOptions& options,
                         const ColorModel& model, const Study& study) {
  const SheetRaster raster = raster_of(options.film, options.dpi);
  const Image board = checkerboard(raster);
  const DippedObject even = dip_blank(pyramid, options, study.context);
  const DippedObject inked =
      dip_printed(pyramid, inks_of_film(board, model), options, study.context);
  Forward result;
  result.even = bending(even);
  result.inked = bending(inked);
  result.apart = apart(even, inked);
  result.film = film_square(board, raster, 90, kPicture_px);
  result.even_picture = dipped_picture(even, board, raster, kPicture_px, study.context);
  result.inked_picture = dipped_picture(inked, board, raster, kPicture_px, study.context);
  return result;
}

// ---- a checkerboard wanted on the pyramid ----

// How far the wanted board's lines land from where they should, across themselves: `design` says
// which bit of film was given the colour of a point, `dip` where that bit ends up.
Deviation misplaced(const DippedObject& design, const DippedObject& dip) {
  Deviation result;
  const Surface& surface = design.posed.surface();
  const double top = design.posed.mesh().bounds().max.z() + 1;
  for_grid_points(kWantedCell_mm, 30, [&](const Vec2& plan, int axis, int) {
    const auto hit = surface.first_hit(Vec3(plan.x(), plan.y(), -1), Vec3(0, 0, 1), 0, top);
    if (!hit) return;
    const Vec3 normal = surface.normal(*hit), wanted = surface.position(*hit);
    const auto u = design.map->to_film(wanted, normal);
    const auto at = u ? dip.map->to_object(*u) : std::nullopt;
    if (!at) return;
    const Vec3 along = normal.cross(axis == 0 ? Vec3::UnitX() : Vec3::UnitY()).normalized();
    const Vec3 off = position_at(dip.posed.mesh(), *at) - wanted;
    result.add((off - off.dot(along) * along).norm());
  });
  return result;
}

struct Printed {
  Deviation off;
  int rounds = 0;
  Image object;
};

Printed print_and_dip(int rounds, const PosedObject& pyramid, const DesignOptions& options,
                      const ColorModel& model, const Study& study) {
  const SheetRaster raster = raster_of(options.film, options.dpi);
  const Designed design = designed(pyramid, model, options, rounds, study.context);
  const InkImage& inks = design.ink.ink.inking.inks;
  const DippedObject dip = dip_printed(pyramid, inks, options, study.context);
  const FilmStretch stretch = film_stretch(*dip.map, raster, 0, study.context);
  const Image look = look_on_object(inks, stretch.area_ratio, model, {1, 1, 1, 1});
  return {misplaced(design.dipped, dip), int(design.ink.rounds.size()),
          dipped_picture(dip, look, raster, kPicture_px, study.context)};
}

}  // namespace

std::string figure_6(const Study& study) {
  const DesignOptions options = paper_config().design;
  const auto model = make_device_model();
  const PosedObject pyramid = posed(make_sample("pyramid"));

  const Forward forward = dip_checkerboard(pyramid, options, *model, study);
  const Printed without = print_and_dip(1, pyramid, options, *model, study);
  const Printed with = print_and_dip(options.rounds_max, pyramid, options, *model, study);
  save_png(study.folder / "figure_6.png",
           panels({{"checkerboard on film", forward.film},
                   {"stiffness even", forward.even_picture},
                   {"stiffness by ink", forward.inked_picture},
                   {"wanted on the object", wanted_picture(pyramid, kPicture_px, study.context)},
                   {"printed without regard to ink", without.object},
                   {"printed with regard to ink", with.object}},
                  3));

  Table table({"lines of", "what", "rms (mm)", "largest (mm)"});
  const auto row = [&](const std::string& lines, const std::string& what, const Deviation& d) {
    table.add({lines, what, d.text()});
  };
  row("10 mm checkerboard on film", "bent, simulated with even stiffness", forward.even);
  row("", "bent, simulated with the ink's stiffness", forward.inked);
  row("", "the two simulations apart", forward.apart);
  row("5 mm checkerboard wanted on the pyramid", "off, printed without regard to ink", without.off);
  row("", fmt::format("off, printed with regard to ink ({} rounds)", with.rounds), with.off);
  return table.text();
}

}  // namespace hydrodip::paper
