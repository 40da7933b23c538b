#include "rig/registration_file.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/json_nesting.h"
#include "base/schema_version.h"

namespace hydrodip {
namespace {

using Json = nlohmann::json;

// Less than that nobody can move by hand.
constexpr double kStill_mm = 0.05, kStill_deg = 0.02;
constexpr std::uintmax_t kLargestFile = 1 << 20;

std::optional<double> number(const Json& json, const char* group, const char* name) {
  if (!json.is_object() || !json.contains(group) || !json[group].is_object()) return {};
  const Json& values = json[group];
  if (!values.contains(name) || !values[name].is_number()) return {};
  return values[name].get<double>();
}

}  // namespace

std::optional<Registration> read_registration(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);  // of regular files alone
  std::ifstream file(path);
  if (error || size > kLargestFile || !file) return {};
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const Json json = parsed_json<Json>(text);
  const auto x = number(json, "shift_mm", "x"), y = number(json, "shift_mm", "y"),
             turn = number(json, "turn_deg", "value"), sx = number(json, "swelling", "x"),
             sy = number(json, "swelling", "y");
  if (!x || !y || !turn || !sx || !sy) return {};
  require_known_schema(json, kRegistrationSchemaVersion, path, "this registration");
  Registration result{{*x, *y}, *turn, {*sx, *sy}, ""};
  if (json.contains("photo") && json["photo"].is_object()) {
    const Json& photo = json["photo"];
    if (photo.contains("sha256") && photo["sha256"].is_string())
      result.photo_sha256 = photo["sha256"];
  }
  return result;
}

std::string advice(const Registration& registration) {
  std::string words;
  const auto add = [&](const std::string& more) { words += (words.empty() ? "" : " and ") + more; };
  const Vec2& off = registration.shift_mm;
  if (std::abs(off.x()) >= kStill_mm)
    add(fmt::format("{:.2f} mm to the {}", std::abs(off.x()), off.x() > 0 ? "left" : "right"));
  if (std::abs(off.y()) >= kStill_mm)
    add(fmt::format("{:.2f} mm to the {}", std::abs(off.y()), off.y() > 0 ? "bottom" : "top"));
  std::string sentence = words.empty() ? "" : "Move the frame by " + words;
  if (std::abs(registration.turn_deg) >= kStill_deg)
    sentence +=
        fmt::format("{} by {:.2f} degrees {}", words.empty() ? "Turn the frame" : ", and turn it",
                    std::abs(registration.turn_deg),
                    registration.turn_deg > 0 ? "clockwise" : "counter-clockwise");
  return sentence.empty() ? "The film lies in its place." : sentence + ".";
}

std::filesystem::path find_camera(const std::filesystem::path& job_folder) {
  std::error_code ignored;
  for (const std::filesystem::path& file :
       {job_folder / "camera.json", std::filesystem::path("camera.json")})
    if (std::filesystem::exists(file, ignored)) return file;
  return {};
}

}  // namespace hydrodip
