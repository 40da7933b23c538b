#include "studio/mends.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "plan/fit.h"
#include "settings/settings.h"

namespace hydrodip {
namespace {

constexpr double kTolerance_mm = 1e-6;
constexpr int kMostGuesses = 12;
// Film torn up to that share of what lies on the object at that depth is none for a hand.
constexpr double kMayTear = 0.003;

std::vector<RoomFit> fits_of(const JobConfig& config, const TriangleMesh& posed,
                             const FilmOptions& film) {
  const Trajectory way = make_trajectory(config.design.trajectory, posed.positions);
  return fits(posed.bounds().size().maxCoeff(), room_of(posed, way), film, config.bath);
}

std::string shown_name(std::string name) {
  name[0] = char(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

Json mend(const std::string& text, Json patch) {
  return {{"text", text}, {"patch", std::move(patch)}};
}

// The smallest sheet on which it fits, in either direction.
void add_film(Json& list, const JobConfig& config, const TriangleMesh& posed) {
  std::vector<FilmFormat> formats = film_formats();
  std::sort(formats.begin(), formats.end(), [](const FilmFormat& a, const FilmFormat& b) {
    return a.width_mm * a.height_mm < b.width_mm * b.height_mm;
  });
  for (const FilmFormat& format : formats)
    for (const bool lying : {false, true}) {
      FilmOptions film = config.design.film;
      film.width_mm = lying ? format.height_mm : format.width_mm;
      film.height_mm = lying ? format.width_mm : format.height_mm;
      if (!sheet_fits_bath(film, config.bath) || !fits_well(fits_of(config, posed, film))) continue;
      list.push_back(
          mend(fmt::format("Choose {}{}", shown_name(format.name), lying ? ", lying" : ""),
               {{"film", {{"width_mm", film.width_mm}, {"height_mm", film.height_mm}}}}));
      return;
    }
}

TriangleMesh shrunk(TriangleMesh posed, double share) {
  for (Vec3& p : posed.positions) p *= share;
  return posed;
}

// The largest at which it fits; 0: it was not found. At a given depth more of a smaller object gets
// wet, so that it does not grow smaller alike.
double fitting_size(const JobConfig& config, const PosedObject& posed) {
  double size = posed.size_mm();
  for (int guess = 0; guess < kMostGuesses && size >= 1; ++guess) {
    const TriangleMesh mesh = shrunk(posed.mesh(), size / posed.size_mm());
    const std::vector<RoomFit> list = fits_of(config, mesh, config.design.film);
    if (fits_well(list)) return size;
    size = std::floor(size * shrinking_to_fit(list) + kTolerance_mm);
  }
  return 0;
}

void add_size(Json& list, const JobConfig& config, const PosedObject& posed) {
  const double size = fitting_size(config, posed);
  if (size >= 1)
    list.push_back(mend(fmt::format("Make it {:.0f} mm", size), {{"object", {{"size_mm", size}}}}));
}

void add_depth(Json& list, const JobConfig& config, const TriangleMesh& posed) {
  if (!config.design.trajectory.path.empty()) return;  // which says itself how deep it goes
  for (const RoomFit& fit : fits_of(config, posed, config.design.film)) {
    const double depth = std::floor(fit.available_mm);
    if (!fit.what.starts_with("deep") || fit.excess_mm() <= kTolerance_mm || depth < 1) continue;
    JobConfig mended = config;
    mended.design.trajectory.depth_mm = depth;
    if (fits_well(fits_of(mended, posed, config.design.film)))
      list.push_back(
          mend(fmt::format("Dip {:.0f} mm only", depth), {{"dip", {{"depth_mm", depth}}}}));
  }
}

bool has_room(const JobConfig& config, const TriangleMesh& posed) {
  return std::ranges::all_of(fits_of(config, posed, config.design.film),
                             [](const RoomFit& fit) { return fit.excess_mm() <= kTolerance_mm; });
}

// The same straight down into the middle, if it only goes down beside it.
std::optional<JobConfig> unshifted(const JobConfig& config) {
  const std::vector<Keyframe>& way = config.design.trajectory.path;
  const auto is_shifted_alike = [&](const Keyframe& key) {
    return key.shift_x_mm == way.front().shift_x_mm && key.shift_y_mm == way.front().shift_y_mm &&
           key.turn_x_deg == 0 && key.turn_y_deg == 0 && key.turn_z_deg == 0;
  };
  if (way.empty() || !std::ranges::all_of(way, is_shifted_alike)) return std::nullopt;
  JobConfig mended = config;
  mended.design.trajectory.path.clear();
  mended.design.trajectory.depth_mm = way.back().lower_mm;
  return mended;
}

// Whether it has no room only as it is shifted too far.
bool hangs_beside(const JobConfig& config, const TriangleMesh& posed) {
  const auto middle = unshifted(config);
  return middle && has_room(*middle, posed) && !has_room(config, posed);
}

void add_middle(Json& list, const JobConfig& config) {
  list.push_back(mend(
      "Back over the middle",
      {{"path", nullptr}, {"dip", {{"depth_mm", config.design.trajectory.path.back().lower_mm}}}}));
}

std::string shift_of(const JobConfig& config) {
  const Keyframe& key = config.design.trajectory.path.front();
  std::string text;
  for (const auto& [mm, axis] : {std::pair(key.shift_x_mm, "x"), std::pair(key.shift_y_mm, "y")})
    if (mm != 0) text += fmt::format("{}{:g} mm ({})", text.empty() ? "" : " and ", mm, axis);
  return text;
}

}  // namespace

Json room_mends(const JobConfig& config, const PosedObject& posed) {
  Json list = Json::array();
  if (hangs_beside(config, posed.mesh())) {
    add_middle(list, config);
    add_film(list, config, posed.mesh());
    return list;
  }
  add_film(list, config, posed.mesh());
  add_depth(list, config, posed.mesh());
  add_size(list, config, posed);
  return list;
}

std::string misfit(const JobConfig& config, const TriangleMesh& posed) {
  for (const RoomFit& fit : fits_of(config, posed, config.design.film)) {
    if (fit.excess_mm() <= kTolerance_mm) continue;
    if (hangs_beside(config, posed))
      return fmt::format(
          "Shifted by {} it reaches beyond {}, which ends {:.0f} mm from its middle.",
          shift_of(config), fit.room, fit.available_mm / 2);
    return fmt::format("Too large: {:.0f} mm {}, and {} has {:.0f} mm.", fit.needed_mm, fit.what,
                       fit.room, fit.available_mm);
  }
  return "";
}

Json orient_mend() {
  return {{"text", "Look for a better way to hold it"},
          {"patch", Json::object()},
          {"task", {{"kind", "orient"}}}};
}

Json auto_mends() {
  return {orient_mend(), mend("As it stands, and whole", {{"object", {{"rotate_deg", {0, 0, 0}}}},
                                                          {"dip", {{"depth_mm", 0}}}})};
}

Json tear_mends(const JobConfig& config, const DippedFilm& film) {
  Json list = Json::array();
  const FilmMesh& mesh = film.mesh();
  std::vector<std::pair<double, double>> torn;  // when, and how much
  double area = 0;
  const auto area_of = [&](std::size_t t) {
    const Triangle& v = mesh.triangles[t];
    const Vec2 a = mesh.u[std::size_t(v[1])] - mesh.u[std::size_t(v[0])],
               b = mesh.u[std::size_t(v[2])] - mesh.u[std::size_t(v[0])];
    return 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (film.lies_on_object(t)) area += area_of(t);
    if (std::isfinite(film.torn_at_mm[t])) torn.emplace_back(film.torn_at_mm[t], area_of(t));
  }
  std::sort(torn.begin(), torn.end());
  double sum = 0, depth = film.depth_mm;
  for (const auto& [at, how_much] : torn) {
    sum += how_much;
    if (sum <= kMayTear * area) continue;
    depth = std::floor(2 * at) / 2 - 0.5;  // a little before that
    break;
  }
  const bool straight = config.design.trajectory.path.empty() &&
                        config.design.trajectory.tilt_deg == 0 &&
                        config.design.trajectory.roll_deg == 0;
  if (straight && depth >= 2 && depth < film.depth_mm)
    list.push_back(mend(fmt::format("Dip {:g} mm only", depth), {{"dip", {{"depth_mm", depth}}}}));
  list.push_back(orient_mend());
  return list;
}

Json air_mends(const TrappedAir& air) {
  Json list = Json::array();
  if (!air.pockets.empty() && air.pockets.front().lets_out) {
    const Tilt& tilt = *air.pockets.front().lets_out;
    list.push_back(
        mend(fmt::format("Tilt it by {:.0f} degrees", tilt.tilt_deg),
             {{"dip", {{"tilt_deg", tilt.tilt_deg}, {"tilt_toward_deg", tilt.toward_deg}}}}));
  }
  return list;
}

Json size_mends() {
  return {mend("It is in metres", {{"object", {{"units", "m"}}}}),
          mend("It is in inches", {{"object", {{"units", "in"}}}}),
          mend("Make it 80 mm", {{"object", {{"size_mm", 80}}}})};
}

}  // namespace hydrodip
