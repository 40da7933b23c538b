#include "job/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace hydrodip {
namespace {

// Rounding in a model's coordinates must not refuse an object that just fits.
constexpr double kFitTolerance_mm = 1e-6;
// Film needs room to stretch between the object and the tape.
constexpr double kComfortableClearance_mm = 5;

// A unit mistaken (metres read as inches, ...) shows as a misfit of this factor.
constexpr double kSuspiciousMisfit = 9;

constexpr double kTiny_mm = 5;

// Millimetres to a hundredth, without trailing zeros.
std::string mm(double length_mm) {
  std::string text = fmt::format("{:.2f}", length_mm);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " mm";
}

// Extent of the part of the object that gets wet, as seen from the film's centre.
struct Footprint {
  double half_width_mm = 0;   // largest |x|
  double half_height_mm = 0;  // largest |y|
  double radius_mm = 0;

  void add(const Vec3& p) {
    half_width_mm = std::max(half_width_mm, std::abs(p.x()));
    half_height_mm = std::max(half_height_mm, std::abs(p.y()));
    radius_mm = std::max(radius_mm, std::hypot(p.x(), p.y()));
  }
};

// Triangles are cut at the water line: a partly dipped funnel may be wider above it.
Footprint wet_footprint(const Object& posed, double depth_mm) {
  Footprint footprint;
  for (const Triangle& triangle : posed.triangles)
    for (int k = 0; k < 3; ++k) {
      const Vec3& a =
          posed.positions[static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)])];
      const Vec3& b =
          posed
              .positions[static_cast<std::size_t>(triangle[static_cast<std::size_t>((k + 1) % 3)])];
      if (a.z() <= depth_mm) footprint.add(a);
      if ((a.z() <= depth_mm) != (b.z() <= depth_mm))
        footprint.add(a + (b - a) * ((depth_mm - a.z()) / (b.z() - a.z())));
    }
  return footprint;
}

// "--size 71": the largest extent at which the object would just fit; "" if size cannot help.
std::string shrunk_size(const Object& posed, double needed_mm, double available_mm) {
  const double size = std::floor(posed.bounds().size().maxCoeff() * available_mm / needed_mm);
  return size >= 1 ? fmt::format("--size {:.0f} or less", size) : "--size";
}

RoomFit film_fit(const Object& posed, const std::string& what, double needed_mm,
                 double available_mm) {
  const std::string remedy =
      fmt::format("shrink it with {}, turn it with --rotate, or take a larger --film",
                  shrunk_size(posed, needed_mm, available_mm));
  return {what, "the free film inside the taped rim", needed_mm, available_mm, remedy};
}

RoomFit bath_fit(const Object& posed, const std::string& what, double needed_mm,
                 double available_mm) {
  const std::string remedy = fmt::format(
      "shrink it with {}, turn it with --rotate or --down, or give the size of your bath with "
      "--set bath.{}_mm=...",
      shrunk_size(posed, needed_mm, available_mm),
      what.starts_with("wide") ? "width" : (what.starts_with("long") ? "height" : "depth"));
  return {what, "the bath", needed_mm, available_mm, remedy};
}

// The bath lies under the sheet with its longer side along the sheet's longer side.
Vec2 bath_along_film(const JobConfig& config) {
  const double longer = std::max(config.bath.width_mm, config.bath.height_mm);
  const double shorter = std::min(config.bath.width_mm, config.bath.height_mm);
  return config.film.width_mm > config.film.height_mm ? Vec2(longer, shorter)
                                                      : Vec2(shorter, longer);
}

void add_film_fits(std::vector<RoomFit>& list, const Object& posed, const Footprint& footprint,
                   const FilmOptions& film) {
  if (film.shape == FilmShape::kDisc) {
    const double diameter = std::min(film.width_mm, film.height_mm) - 2 * film.margin_mm;
    list.push_back(film_fit(posed, "across", 2 * footprint.radius_mm, diameter));
    return;
  }
  list.push_back(
      film_fit(posed, "wide (x)", 2 * footprint.half_width_mm, film.width_mm - 2 * film.margin_mm));
  list.push_back(film_fit(posed, "long (y)", 2 * footprint.half_height_mm,
                          film.height_mm - 2 * film.margin_mm));
}

void add_bath_fits(std::vector<RoomFit>& list, const Object& posed, const Footprint& footprint,
                   const JobConfig& config) {
  const Vec2 bath = bath_along_film(config);
  list.push_back(bath_fit(posed, "wide (x)", 2 * footprint.half_width_mm, bath.x()));
  list.push_back(bath_fit(posed, "long (y)", 2 * footprint.half_height_mm, bath.y()));
  RoomFit depth =
      bath_fit(posed, "deep in the water", dip_depth_mm(posed, config), config.bath.depth_mm);
  depth.remedy = "dip less of it with --depth, " + depth.remedy;
  list.push_back(depth);
}

void warn_if_sheet_exceeds_bath(const JobConfig& config, RunContext& context) {
  const Vec2 bath = bath_along_film(config);
  if (config.film.width_mm <= bath.x() && config.film.height_mm <= bath.y()) return;
  context.warn(fmt::format(
      "The film of {} by {} is larger than the bath of {} by {}: cut it, or give the size of your "
      "bath (bath.width_mm, bath.height_mm).",
      mm(config.film.width_mm), mm(config.film.height_mm), mm(bath.x()), mm(bath.y())));
}

void warn_if_tight(const std::vector<RoomFit>& list, RunContext& context) {
  for (const RoomFit& fit : list) {
    if (fit.room == "the bath" || -fit.excess_mm() >= 2 * kComfortableClearance_mm) continue;
    context.warn(fmt::format(
        "Only {} of free film is left beside the object where it is {} {}: the film there will "
        "stretch strongly; a larger --film helps.",
        mm(-0.5 * fit.excess_mm()), mm(fit.needed_mm), fit.what));
  }
}

// Area and volume grow with the object.
void pose(LoadedObject& loaded, const PoseOptions& options) {
  const Eigen::Matrix4d matrix = pose_matrix(loaded.object, options);
  apply_pose(loaded.object, matrix);
  const double scale = matrix.col(0).head<3>().norm();
  loaded.health.area_mm2 *= scale * scale;
  loaded.health.volume_mm3 *= scale * scale * scale;
}

void warn_if_tiny(const Object& object, RunContext& context) {
  const double largest = object.bounds().size().maxCoeff();
  if (largest < kTiny_mm)
    context.warn(fmt::format(
        "The object's largest extent is {}: if that is not meant, say its --units or --size.",
        mm(largest)));
}

}  // namespace

LoadedObject load_posed(const JobConfig& config, RunContext& context) {
  context.progress("loading", 0);
  LoadedObject loaded = load_object(config.model, config.object.load, context);
  for (const std::string& finding : loaded.health.findings()) context.warn(finding);
  pose(loaded, config.object.pose);
  warn_if_tiny(loaded.object, context);
  context.progress("loading", 1);
  return loaded;
}

void require_appearance(const Object& object, const std::filesystem::path& model) {
  if (object.has_appearance()) return;
  if (!object.uvs.empty())
    throw InputError(fmt::format(
        "{}: the model has texture coordinates but no texture: name the image with --texture",
        model.string()));
  throw InputError(fmt::format(
      "{}: the model has neither texture coordinates (UVs) nor vertex colours, so there is nothing "
      "to print: unwrap it (in Blender: UV > Smart UV Project) and name an image with --texture, "
      "or "
      "paint vertex colours and save it as PLY",
      model.string()));
}

LinearColor base_color(const JobConfig& config) {
  const auto channel = [&](std::size_t at) {
    return srgb8_to_linear(
        static_cast<std::uint8_t>(std::stoi(config.object.base_color.substr(at, 2), nullptr, 16)));
  };
  return {channel(1), channel(3), channel(5), 1};
}

Trajectory trajectory(const Object& object, const JobConfig& config) {
  return make_trajectory(config.trajectory, object.positions);
}

double dip_depth_mm(const Object& object, const JobConfig& config) {
  return trajectory(object, config).depth_mm();
}

std::vector<RoomFit> fits(const Object& posed, const JobConfig& config) {
  const Footprint footprint = wet_footprint(posed, dip_depth_mm(posed, config));
  std::vector<RoomFit> list;
  add_film_fits(list, posed, footprint, config.film);
  add_bath_fits(list, posed, footprint, config);
  return list;
}

void require_fit(const Object& posed, const JobConfig& config, RunContext& context) {
  const std::vector<RoomFit> list = fits(posed, config);
  for (const RoomFit& fit : list)
    if (fit.excess_mm() > kFitTolerance_mm)
      throw InputError(fmt::format(
          "the object is {} {}, {} more than the {} of {}: {}{}", mm(fit.needed_mm), fit.what,
          mm(fit.excess_mm()), mm(fit.available_mm), fit.room, fit.remedy,
          fit.needed_mm > kSuspiciousMisfit * fit.available_mm ? "; are its --units right?" : ""));
  warn_if_sheet_exceeds_bath(config, context);
  warn_if_tight(list, context);
}

}  // namespace hydrodip
