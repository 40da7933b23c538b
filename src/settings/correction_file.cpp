#include "settings/correction_file.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/json_nesting.h"

namespace hydrodip {
namespace {

using Json = nlohmann::json;

constexpr double kFarthest_mm = 50;  // that a correction moves anything
constexpr int kMostPoints = 1000000;

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw InputError(fmt::format(
      "{}: this is not a correction; name the correction.json that 'hydrodip correct' wrote",
      file.string()));
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file) {}

  const Json& member(const Json& json, const char* name) const {
    if (!json.is_object() || !json.contains(name)) refuse(file_);
    return json[name];
  }
  double number(const Json& json, double least, double most) const {
    if (!json.is_number()) refuse(file_);
    const double value = json.get<double>();
    if (!(value >= least && value <= most)) refuse(file_);
    return value;
  }
  Vec2 pair(const Json& json, double most) const {
    if (!json.is_array() || json.size() != 2) refuse(file_);
    return {number(json[0], -most, most), number(json[1], -most, most)};
  }
  const Json& list(const Json& json) const {
    if (!json.is_array()) refuse(file_);
    return json;
  }

 private:
  const std::filesystem::path& file_;
};

}  // namespace

CorrectionFile read_correction(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_file(file);
  const Json json = parsed_json<Json>(bytes);
  const Reader read(file);
  const Json& grid = read.member(json, "grid");
  CorrectionFile result;
  FilmCorrection& field = result.field;
  field.first = read.pair(read.member(grid, "first_mm"), 1e4);
  field.pitch_mm = read.number(read.member(grid, "pitch_mm"), 0.1, 1e3);
  field.nx = int(read.number(read.member(grid, "nx"), 2, kMostPoints));
  field.ny = int(read.number(read.member(grid, "ny"), 2, kMostPoints));
  for (const Json& move : read.list(read.member(grid, "move_mm")))
    field.move.push_back(read.pair(move, kFarthest_mm));
  if (double(field.move.size()) != double(field.nx) * double(field.ny)) refuse(file);
  for (const Json& sample : read.list(read.member(json, "samples")))
    result.samples.push_back({read.pair(read.member(sample, "model_mm"), 1e4),
                              read.pair(read.member(sample, "move_mm"), kFarthest_mm)});
  return result;
}

}  // namespace hydrodip
