#include "register/seen_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "register/place_table.h"
#include "scan/board.h"
#include "scan/read_scan.h"
#include "scan/registration.h"

namespace hydrodip {
namespace {

GridLanding landing_of(const PrintedFilm& film, const Board& board) {
  return [&film, board](const GridPlace& place) -> std::optional<Vec3> {
    const auto at = film.map->to_object(board.on_film(place));
    if (!at) return std::nullopt;
    return position_at(film.posed.mesh(), *at);
  };
}

// A scan, taken for one of a board.
struct Reading {
  Board board;
  std::vector<std::optional<GridPlace>> place;
  CornerGrid grid;  // posed-object frame
  bool turned = false, mirrored = false;
  double off_mm = 0;  // rms of the corners from where the job lays them
};

double distance_mm(const Reading& reading, const GridLanding& landing) {
  double square = 0, count = 0;
  for (std::size_t c = 0; c < reading.place.size(); ++c) {
    if (!reading.place[c]) continue;
    const auto lands = landing(*reading.place[c]);
    if (!lands) continue;
    square += (*lands - reading.grid.position[c]).squaredNorm();
    ++count;
  }
  return std::sqrt(square / count);
}

Reading reading_as(const Board& board, const CornerGrid& scan, const PrintedFilm& film,
                   const FilmOptions& sheet, bool aligned, const std::string& name) {
  const GridLanding landing = landing_of(film, board);
  const GridPlace reach = reach_of(sheet, board.square_mm);
  Reading reading{board, {}, scan};
  reading.place.resize(scan.position.size());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (!aligned) {
    const GridMatch match = match_grid(scan, landing, reach, board.square_mm, name);
    pose = align(scan, match, film.posed.surface(), landing).pose;
    reading.place = match.place;
    reading.turned = match.turned;
    reading.mirrored = match.mirrored;
  }
  place_patches(scan, pose, reading.turned, landing, reach, board.square_mm, reading.place);
  if (std::none_of(reading.place.begin(), reading.place.end(),
                   [](const auto& place) { return place.has_value(); }))
    throw InputError(fmt::format(
        "{}, taken for the {} board: {}", name, board.name,
        why_unplaced(moved(scan, pose), film.posed.surface(), landing, reach, board.square_mm)));
  reading.grid = moved(scan, pose);
  reading.off_mm = distance_mm(reading, landing);
  return reading;
}

// The boards lie half a square beside each other along both axes. One is believed that fits clearly
// better, and so well that film that lay that far off is not taken for the other one.
bool is_clear(const Reading& best, const Reading& other) {
  constexpr double kClearlyBetter = 0.7, kLargestOff_squares = 0.25;
  return best.off_mm < kClearlyBetter * other.off_mm &&
         best.off_mm < kLargestOff_squares * best.board.square_mm;
}

Reading best_reading(const std::vector<Board>& boards, const CornerGrid& scan,
                     const PrintedFilm& film, const FilmOptions& sheet, bool aligned,
                     const std::string& name) {
  std::vector<Reading> readings;
  std::string refusal;
  for (const Board& board : boards) {
    try {
      readings.push_back(reading_as(board, scan, film, sheet, aligned, name));
    } catch (const InputError& error) {
      refusal = error.what();
    }
  }
  if (readings.empty()) throw InputError(refusal);
  std::sort(readings.begin(), readings.end(),
            [](const Reading& a, const Reading& b) { return a.off_mm < b.off_mm; });
  if (readings.size() > 1 && !is_clear(readings[0], readings[1]))
    throw InputError(
        fmt::format("{}: could be of the {} board, {:.2f} mm off, or of the {} one, {:.2f} mm off; "
                    "say which one "
                    "was dipped, with --board tints (what the kit prints) or --board black",
                    name, readings[0].board.name, readings[0].off_mm, readings[1].board.name,
                    readings[1].off_mm));
  return readings[0];
}

std::vector<Board> boards_asked(const CorrectRequest& request) {
  if (!request.board.empty()) return {board_named(request.board, request.square_mm)};
  return {tint_board(request.square_mm > 0 ? request.square_mm : kTintSquare_mm),
          black_board(request.square_mm > 0 ? request.square_mm : kBlackSquare_mm)};
}

SeenPlaces read_grid(const std::filesystem::path& file, const PrintedFilm& film,
                     const FilmOptions& sheet, const CorrectRequest& request,
                     const RunContext& context) {
  const std::vector<Board> boards = boards_asked(request);
  const Scan scan = read_scan(file, {request.scan_units, boards.front().square_mm, false}, context);
  const Reading reading =
      best_reading(boards, scan.grid, film, sheet, request.aligned, file.string());
  if (reading.mirrored)
    throw InputError(
        fmt::format("{}: only the scan's mirror image fits the object; save it without mirroring",
                    file.string()));
  if (reading.turned)
    throw InputError(fmt::format(
        "{}: rows and columns run the wrong way round: its faces look into the object, or it is a "
        "mirror image, of which the correction would be wrong; turn its faces outwards, or save it "
        "without mirroring",
        file.string()));
  SeenPlaces seen{{}, reading.board.name, reading.board.square_mm};
  for (std::size_t i = 0; i < reading.place.size(); ++i)
    if (reading.place[i])
      seen.places.push_back({reading.board.on_film(*reading.place[i]), reading.grid.position[i]});
  return seen;
}

SeenPlaces read_table(const std::filesystem::path& file, const CorrectRequest& request) {
  if ((!request.scan_units.empty() && request.scan_units != "mm") || !request.board.empty() ||
      request.square_mm > 0)
    throw InputError(fmt::format(
        "{}: a table of places is in mm and of no board: leave out --scan-units, --board and "
        "--square",
        file.string()));
  SeenPlaces seen;
  for (const PlaceRow& row : read_place_table(file))
    seen.places.push_back({row.on_sheet, row.position});
  return seen;
}

}  // namespace

SeenPlaces read_seen_places(const std::filesystem::path& file, const PrintedFilm& film,
                            const FilmOptions& sheet, const CorrectRequest& request,
                            const RunContext& context) {
  return is_place_table(file) ? read_table(file, request)
                              : read_grid(file, film, sheet, request, context);
}

}  // namespace hydrodip
