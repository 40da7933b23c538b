#include "plan/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "dip/travel.h"

namespace hydrodip {
namespace {

// Rounding in a model's coordinates must not refuse an object that just fits.
constexpr double kFitTolerance_mm = 1e-6;
// Film needs room to stretch between the object and the tape.
constexpr double kComfortableClearance_mm = 5;

constexpr const char *kBath = "the bath", *kDeep = "deep in the water";

// A path is looked at so often.
constexpr int kPathParts = 24;

// A unit mistaken (metres read as inches, ...) shows as a misfit of this factor.
constexpr double kSuspiciousMisfit = 9;

// Millimetres to a hundredth, without trailing zeros.
std::string mm(double length_mm) {
  std::string text = fmt::format("{:.2f}", length_mm);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " mm";
}

void add(Room& room, const Vec3& in_bath) {
  room.half_width_mm = std::max(room.half_width_mm, std::abs(in_bath.x()));
  room.half_height_mm = std::max(room.half_height_mm, std::abs(in_bath.y()));
  room.radius_mm = std::max(room.radius_mm, std::hypot(in_bath.x(), in_bath.y()));
}

// Triangles are cut at the water line: a partly dipped funnel may be wider above it.
void add_wet_part(Room& room, const TriangleMesh& posed, const Moment& moment) {
  const double level = moment.level_mm;
  for (const Triangle& triangle : posed.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = moment.to_sinking(posed.positions[std::size_t(triangle[k])]);
      const Vec3 b = moment.to_sinking(posed.positions[std::size_t(triangle[(k + 1) % 3])]);
      if (a.z() <= level) add(room, a);
      if ((a.z() <= level) != (b.z() <= level))
        add(room, a + (b - a) * ((level - a.z()) / (b.z() - a.z())));
    }
}

// Whether the way of a smaller object is so much smaller: it ends under water, and shifts nowhere.
bool goes_with_size(const TriangleMesh& posed, const Travel& travel) {
  const std::vector<Keyframe>& way = travel.trajectory().keyframes();
  const bool shifts = std::ranges::any_of(way, [&](const Keyframe& key) {
    return key.shift_x_mm != way.front().shift_x_mm || key.shift_y_mm != way.front().shift_y_mm;
  });
  const Moment last = travel.at(travel.length_mm());
  return !shifts && std::ranges::all_of(posed.positions, [&](const Vec3& p) {
    return last.height(p) < kFitTolerance_mm;
  });
}

// "--size 71 or less": the largest extent at which the object would fit well, as far as it is
// known.
std::string shrunk_size(double size_mm, const Room& room, double share) {
  const double size = std::floor(size_mm * share + kFitTolerance_mm);
  if (size < 1) return "--size";
  switch (room.shrinks) {
    case Room::Shrinks::kWhole:
      return fmt::format("--size {:.0f} or less", size);
    case Room::Shrinks::kWithDepth:
      return fmt::format("--size {:.0f} and --depth {:.1f}", size,
                         std::floor(10 * room.depth_mm * size / size_mm) / 10);
    case Room::Shrinks::kUnknown:
      return "--size (its way stays as it is)";
  }
  return "--size";
}

// The bath lies under the sheet with its longer side along the sheet's longer side.
Vec2 bath_along_film(const FilmOptions& film, const BathOptions& bath) {
  const double longer = std::max(bath.width_mm, bath.height_mm);
  const double shorter = std::min(bath.width_mm, bath.height_mm);
  return film.width_mm > film.height_mm ? Vec2(longer, shorter) : Vec2(shorter, longer);
}

// What a sheet would have to be like for the object to fit well, as far as the bath has room for
// it.
std::string larger_film(const Room& room, FilmOptions film, const BathOptions& tank) {
  const double beside_mm = 2 * (film.margin_mm + kComfortableClearance_mm);
  const bool disc = film.shape == FilmShape::kDisc;
  film.width_mm = 2 * (disc ? room.radius_mm : room.half_width_mm) + beside_mm;
  film.height_mm = 2 * (disc ? room.radius_mm : room.half_height_mm) + beside_mm;
  const double longer = std::max(film.width_mm, film.height_mm);
  const double shorter = std::min(film.width_mm, film.height_mm);
  const double bath_longer = std::max(tank.width_mm, tank.height_mm);
  const double bath_shorter = std::min(tank.width_mm, tank.height_mm);
  if (longer > bath_longer || shorter > bath_shorter)
    return "take a larger --film in a larger bath (bath.width_mm, bath.height_mm)";
  return fmt::format("take a larger --film (the bath has room for {:g} x {:g} mm)", bath_shorter,
                     bath_longer);
}

// With the parameter that says it, as their remedy.
std::vector<RoomFit> room_in_bath(const Room& footprint, const FilmOptions& film,
                                  const BathOptions& tank) {
  const Vec2 bath = bath_along_film(film, tank);
  const bool x_by_width = (film.width_mm > film.height_mm) == (tank.width_mm >= tank.height_mm);
  const char *of_x = "bath.width_mm", *of_y = "bath.height_mm";
  if (!x_by_width) std::swap(of_x, of_y);
  return {{"wide (x)", kBath, 2 * footprint.half_width_mm, bath.x(), of_x},
          {"long (y)", kBath, 2 * footprint.half_height_mm, bath.y(), of_y},
          {kDeep, kBath, footprint.depth_mm, tank.depth_mm, "bath.depth_mm"}};
}

}  // namespace

Room room_of(const TriangleMesh& posed, double depth_mm) {
  Room room{.depth_mm = depth_mm};
  if (depth_mm < posed.bounds().max.z() - kFitTolerance_mm)
    room.shrinks = Room::Shrinks::kWithDepth;
  add_wet_part(room, posed, Moment::at_depth(depth_mm));
  return room;
}

Room room_of(const TriangleMesh& posed, const Trajectory& trajectory) {
  if (trajectory.is_straight_down()) return room_of(posed, trajectory.depth_mm());
  const Travel travel(trajectory, posed.positions, posed.triangles);
  Room room;
  if (!goes_with_size(posed, travel)) room.shrinks = Room::Shrinks::kUnknown;
  for (int part = 0; part <= kPathParts; ++part) {
    const Moment moment = travel.at(travel.length_mm() * part / kPathParts);
    add_wet_part(room, posed, moment);
    for (const Vec3& p : posed.positions)
      room.depth_mm = std::max(room.depth_mm, -moment.height(p));
  }
  return room;
}

bool fits_well(const std::vector<RoomFit>& list) {
  return std::ranges::all_of(list, [](const RoomFit& fit) {
    return fit.excess_mm() + fit.comfort_mm <= kFitTolerance_mm;
  });
}

double shrinking_to_fit(const std::vector<RoomFit>& list) {
  double share = 1;
  for (const RoomFit& fit : list)
    if (fit.needed_mm > 0)
      share = std::min(share, (fit.available_mm - fit.comfort_mm) / fit.needed_mm);
  return std::max(0.0, share);
}

std::vector<RoomFit> film_fits(const Room& room, const FilmOptions& film) {
  const auto fit = [](const char* what, double needed_mm, double available_mm) {
    return RoomFit{.what = what,
                   .room = "the free film inside the taped rim",
                   .needed_mm = needed_mm,
                   .available_mm = available_mm,
                   .remedy = "",
                   .comfort_mm = 2 * kComfortableClearance_mm};
  };
  if (film.shape == FilmShape::kDisc)
    return {fit("across", 2 * room.radius_mm,
                std::min(film.width_mm, film.height_mm) - 2 * film.margin_mm)};
  return {
      fit("wide (x)", 2 * room.half_width_mm, film.width_mm - 2 * film.margin_mm),
      fit("long (y)", 2 * room.half_height_mm, film.height_mm - 2 * film.margin_mm),
  };
}

std::vector<RoomFit> fits(double size_mm, const Room& room, const FilmOptions& film,
                          const BathOptions& bath) {
  std::vector<RoomFit> list = film_fits(room, film);
  for (RoomFit& fit : room_in_bath(room, film, bath)) list.push_back(std::move(fit));
  const std::string shrink = "shrink it with " + shrunk_size(size_mm, room, shrinking_to_fit(list));
  for (RoomFit& fit : list) {
    if (fit.room != kBath)
      fit.remedy =
          fmt::format("{}, turn it with --rotate, or {}", shrink, larger_film(room, film, bath));
    else
      fit.remedy = fmt::format(
          "{}{}, turn it with --rotate or --down, or give the size of your bath with --set {}=...",
          fit.what == kDeep ? "dip less of it with --depth, " : "", shrink, fit.remedy);
  }
  return list;
}

bool sheet_fits_bath(const FilmOptions& film, const BathOptions& bath) {
  const Vec2 room = bath_along_film(film, bath);
  return film.width_mm <= room.x() && film.height_mm <= room.y();
}

void warn_if_sheet_exceeds_bath(const FilmOptions& film, const BathOptions& tank,
                                const RunContext& context) {
  if (sheet_fits_bath(film, tank)) return;
  const Vec2 bath = bath_along_film(film, tank);
  context.warn(fmt::format(
      "The film of {} by {} is larger than the bath of {} by {}: cut it, or give the size of your "
      "bath (bath.width_mm, bath.height_mm).",
      mm(film.width_mm), mm(film.height_mm), mm(bath.x()), mm(bath.y())));
}

void require_room(double size_mm, const Room& room, const FilmOptions& film,
                  const BathOptions& bath) {
  half_of_free_film(film);  // throws where there is none
  for (const RoomFit& fit : fits(size_mm, room, film, bath))
    if (fit.excess_mm() > kFitTolerance_mm)
      throw InputError(fmt::format(
          "the object is {} {}, {} more than the {} of {}: {}{}", mm(fit.needed_mm), fit.what,
          mm(fit.excess_mm()), mm(fit.available_mm), fit.room, fit.remedy,
          fit.needed_mm > kSuspiciousMisfit * fit.available_mm ? "; are its --units right?" : ""));
}

void warn_if_tight(const Room& room, const FilmOptions& film, const RunContext& context) {
  for (const RoomFit& fit : film_fits(room, film)) {
    if (-fit.excess_mm() >= fit.comfort_mm - kFitTolerance_mm) continue;
    context.warn(fmt::format(
        "Only {} of free film is left beside the object where it is {} {}: the film there will "
        "stretch strongly; a larger --film helps.",
        mm(std::max(0.0, -0.5 * fit.excess_mm())), mm(fit.needed_mm), fit.what));
  }
}

void require_fit(double size_mm, const Room& room, const FilmOptions& film, const BathOptions& bath,
                 const RunContext& context) {
  require_room(size_mm, room, film, bath);
  warn_if_sheet_exceeds_bath(film, bath, context);
  warn_if_tight(room, film, context);
}

}  // namespace hydrodip
