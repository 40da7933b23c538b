#include "job/correction_fit.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "base/file.h"

namespace hydrodip {
namespace {

// What changes a dip less than a correction is good for.
constexpr double kSameTurn_deg = 0.5, kSameSize = 0.002, kSameDepth_mm = 0.5, kSameFilm_mm = 0.5;
constexpr double kSameSwelling = 0.003, kSameMaterial = 0.01, kSameRatio = 0.02;

void append(std::vector<std::uint8_t>& bytes, const void* data, std::size_t size) {
  const auto* begin = static_cast<const std::uint8_t*>(data);
  bytes.insert(bytes.end(), begin, begin + size);
}

std::string shape_hash(const Object& object) {
  std::vector<std::uint8_t> bytes;
  for (const Vec3& p : object.positions) append(bytes, p.data(), 3 * sizeof(double));
  for (const Triangle& t : object.triangles) append(bytes, t.data(), sizeof t);
  return sha256_hex(bytes);
}

std::string path_hash(const TrajectoryOptions& way) {
  std::vector<std::uint8_t> bytes;
  for (const Keyframe& key : way.path)
    for (const double value : {key.lower_mm, key.shift_x_mm, key.shift_y_mm, key.turn_x_deg,
                               key.turn_y_deg, key.turn_z_deg})
      append(bytes, &value, sizeof value);
  append(bytes, way.pivot_mm.data(), 3 * sizeof(double));
  return sha256_hex(bytes);
}

// Of the turn between them, whatever their sizes.
double turn_between_deg(const Mat3& a, const Mat3& b) {
  const double size = a.col(0).norm() * b.col(0).norm();
  const Mat3 turn = a * b.transpose() / std::max(size, 1e-300);
  return Eigen::AngleAxisd(turn).angle() * 180 / std::numbers::pi;
}

// In which way the dips differ; empty: in none that matters.
std::string difference(const CorrectedDip& then, const CorrectedDip& now) {
  const bool same_model = then.shape_sha256 == now.shape_sha256 ||
                          (!now.model_sha256.empty() && then.model_sha256 == now.model_sha256);
  if (!same_model) return fmt::format("is of another model, {}", then.model);
  const double turn_deg = turn_between_deg(then.to_posed, now.to_posed);
  if (!(turn_deg < kSameTurn_deg))
    return fmt::format("was found with the object turned by {:.1f} degrees against this pose",
                       turn_deg);
  const double larger = now.size_mm.norm() / std::max(then.size_mm.norm(), 1e-300) - 1;
  if (!(std::abs(larger) < kSameSize))
    return fmt::format("was found for the object at another size: this one is {:.1f} % {}",
                       100 * std::abs(larger), larger > 0 ? "larger" : "smaller");
  if (!(std::abs(then.depth_mm - now.depth_mm) < kSameDepth_mm))
    return fmt::format("was found {:.1f} mm deep, and this dip goes {:.1f} mm deep", then.depth_mm,
                       now.depth_mm);
  if (!((then.film_mm - now.film_mm).cwiseAbs().maxCoeff() < kSameFilm_mm) ||
      !(std::abs(then.margin_mm - now.margin_mm) < kSameFilm_mm))
    return fmt::format(
        "was found on film of {:g} x {:g} mm with a margin of {:g} mm, and this one is of {:g} x "
        "{:g} mm with {:g} mm",
        then.film_mm.x(), then.film_mm.y(), then.margin_mm, now.film_mm.x(), now.film_mm.y(),
        now.margin_mm);
  if (!((then.swelling - now.swelling).cwiseAbs().maxCoeff() < kSameSwelling))
    return fmt::format(
        "was found on a print for film that swells by {:.2f} x {:.2f} %, and this one is for "
        "{:.2f} "
        "x {:.2f} %: swelling would be taken out twice, or not at all",
        100 * (then.swelling.x() - 1), 100 * (then.swelling.y() - 1), 100 * (now.swelling.x() - 1),
        100 * (now.swelling.y() - 1));
  const bool same_material =
      std::abs(then.z_stretch - now.z_stretch) < kSameMaterial &&
      std::abs(then.poisson - now.poisson) < kSameMaterial &&
      std::abs(then.ink_stiffness_ratio / now.ink_stiffness_ratio - 1) < kSameRatio;
  if (!same_material)
    return fmt::format(
        "was found with film of z_stretch {:g}, Poisson's ratio {:g} and ink stiffness ratio {:g}, "
        "and this job has {:g}, {:g} and {:g}",
        then.z_stretch, then.poisson, then.ink_stiffness_ratio, now.z_stretch, now.poisson,
        now.ink_stiffness_ratio);
  if (!then.way.empty() && then.way != now.way)
    return fmt::format("was found for a dip {}, and this one goes {}", then.way, now.way);
  return "";
}

// "straight down", "along a path (1f0a93c2), projected"
std::string way_of(const DesignOptions& design) {
  const TrajectoryOptions& way = design.trajectory;
  std::string text = "straight down";
  if (!way.path.empty()) {
    text = fmt::format("along a path ({})", path_hash(way).substr(0, 8));
  } else if (way.tilt_deg != 0 || way.roll_deg != 0) {
    text = fmt::format("leaning over by {:g} degrees towards {:g}, rolled by {:g}", way.tilt_deg,
                       way.tilt_toward_deg, way.roll_deg);
  }
  if (design.dip.method == DipMethod::kSingleStep) text += ", draped in a single step";
  if (design.dip.method == DipMethod::kProjection) text += ", projected";
  if (design.film.shape == FilmShape::kDisc) text += ", through a disc of film";
  return text;
}

}  // namespace

CorrectedDip corrected_dip(const JobConfig& config, const PosedObject& posed, double depth_mm) {
  const FilmOptions& film = config.design.film;
  CorrectedDip dip;
  dip.model = config.model.string();
  // A mesh that a program gave has no file.
  std::error_code ignored;
  if (std::filesystem::is_regular_file(config.model, ignored))
    dip.model_sha256 = sha256_hex(read_file(config.model));
  dip.shape_sha256 = shape_hash(posed.object());
  dip.to_posed = posed.matrix().topLeftCorner<3, 3>();
  dip.size_mm = posed.mesh().bounds().size();
  dip.depth_mm = depth_mm;
  dip.film_mm = {film.width_mm, film.height_mm};
  dip.margin_mm = film.margin_mm;
  dip.swelling = {film.swelling_x, film.swelling_y};
  dip.z_stretch = config.design.dip.material.z_stretch;
  dip.poisson = config.design.dip.material.poisson;
  dip.ink_stiffness_ratio = config.design.stiffness.ratio;
  dip.way = way_of(config.design);
  return dip;
}

void require_correction_fits(const JobConfig& config, const PosedObject& posed, double depth_mm) {
  if (config.correction.empty()) return;
  const std::string why =
      difference(read_correction(config.correction).of, corrected_dip(config, posed, depth_mm));
  if (!why.empty())
    throw InputError(fmt::format(
        "{}: this correction {}; give the job as it was, or print it without the correction, dip "
        "that and run 'hydrodip correct' on it",
        config.correction.string(), why));
}

}  // namespace hydrodip
