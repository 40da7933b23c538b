#include "register/tank_file.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/eigenpairs.h"
#include "base/error.h"
#include "base/json_nesting.h"
#include "base/json_text.h"
#include "base/schema_version.h"
#include "base/small_file.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLargest = 1e6;
constexpr int kSchemaVersion = 1;
constexpr std::uintmax_t kLargestFile = 1 << 20;

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw InputError(fmt::format(
      "{}: this is not a camera's calibration; 'hydrodip register --calibrate-camera PHOTOS' makes "
      "one",
      file.string()));
}

std::vector<double> numbers(const Json& json, const char* name, std::size_t count,
                            const std::filesystem::path& file) {
  if (!json.is_object() || !json.contains(name) || !json[name].is_array() ||
      json[name].size() != count)
    refuse(file);
  std::vector<double> result;
  for (const Json& value : json[name]) {
    if (!value.is_number()) refuse(file);
    result.push_back(value.get<double>());
    if (!(std::abs(result.back()) <= kLargest)) refuse(file);
  }
  return result;
}

// Whether every pixel of the rim sees one direction: no such distortion folds the picture.
bool is_believable(const Tank& tank) {
  constexpr double kOff_px = 0.1;
  for (const double x : {0.0, 0.5, 1.0})
    for (const double y : {0.0, 0.5, 1.0}) {
      const Vec2 px(x * tank.width_px, y * tank.height_px);
      if (!((tank.lens.project(tank.lens.ray(px)) - px).norm() < kOff_px)) return false;
    }
  return true;
}

}  // namespace

std::string tank_as_json(const Tank& tank) {
  const auto values = tank.lens.values();
  Json covariance = Json::array();
  for (int i = 0; i < Lens::kValues; ++i)
    for (int j = 0; j < Lens::kValues; ++j) covariance.push_back(tank.lens_covariance(i, j));
  Json board = Json::array();
  for (const auto& [tag, corner] : tank.corner_mm)
    board.push_back({double(tag), corner.x(), corner.y(), corner.z()});
  return json_text(
      {{"schema_version", kSchemaVersion},
       {"generator", "hydrodip register --calibrate-camera"},
       {"photo_px", {tank.width_px, tank.height_px}},
       {"lens_focal_center_k1_k2_p1_p2", std::vector<double>(values.begin(), values.end())},
       {"lens_covariance", covariance},
       {"rms_px", tank.rms_px},
       {"place_x_y_mm_turn_deg",
        {tank.place.middle_mm.x(), tank.place.middle_mm.y(), tank.place.turn_deg}},
       {"water_below_mm", tank.water_below_mm},
       {"board_tag_x_y_z_mm", board}});
}

bool keep_what_was_said(const Tank& earlier, Tank& tank) {
  constexpr double kUnmoved_mm = 1;
  tank.water_below_mm = earlier.water_below_mm;
  const bool was_set = earlier.place.middle_mm != Vec2::Zero() || earlier.place.turn_deg != 0;
  if (!was_set) return true;
  if (earlier.corner_mm.size() != tank.corner_mm.size()) return false;
  for (const auto& [tag, corner] : earlier.corner_mm) {
    const auto now = tank.corner_mm.find(tag);
    if (now == tank.corner_mm.end() || !((now->second - corner).norm() < kUnmoved_mm)) return false;
  }
  tank.place = earlier.place;
  return true;
}

Tank read_tank(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes =
      read_small_file(file, kLargestFile, "a camera's calibration");
  const Json json = parsed_json<Json>(bytes);
  require_known_schema(json, kSchemaVersion, file, "this camera's calibration");
  Tank tank;
  const auto px = numbers(json, "photo_px", 2, file);
  const auto lens = numbers(json, "lens_focal_center_k1_k2_p1_p2", Lens::kValues, file);
  const auto covariance = numbers(json, "lens_covariance", Lens::kValues * Lens::kValues, file);
  const auto place = numbers(json, "place_x_y_mm_turn_deg", 3, file);
  tank.width_px = int(px[0]);
  tank.height_px = int(px[1]);
  tank.lens = Lens::of(Eigen::Map<const Eigen::Matrix<double, Lens::kValues, 1>>(lens.data()));
  tank.lens_covariance =
      Eigen::Map<const Eigen::Matrix<double, Lens::kValues, Lens::kValues>>(covariance.data());
  tank.place = {{place[0], place[1]}, place[2]};
  const Eigen::VectorXd spread = eigenpairs(tank.lens_covariance).values;
  const bool usable = tank.width_px > 0 && tank.height_px > 0 && tank.lens.focal_px > 1 &&
                      tank.lens_covariance.isApprox(tank.lens_covariance.transpose(), 1e-6) &&
                      spread[0] > -1e-12 * spread[Lens::kValues - 1] && is_believable(tank);
  if (!usable || !json.contains("water_below_mm") || !json["water_below_mm"].is_number() ||
      !json.contains("board_tag_x_y_z_mm") || !json["board_tag_x_y_z_mm"].is_array())
    refuse(file);
  tank.water_below_mm = json["water_below_mm"];
  if (json.contains("rms_px") && json["rms_px"].is_number()) tank.rms_px = json["rms_px"];
  for (const Json& row : json["board_tag_x_y_z_mm"]) {
    const auto mark = numbers({{"mark", row}}, "mark", 4, file);
    tank.corner_mm[int(mark[0])] = {mark[1], mark[2], mark[3]};
  }
  return tank;
}

}  // namespace hydrodip
