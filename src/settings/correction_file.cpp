#include "settings/correction_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_nesting.h"
#include "base/schema_version.h"
#include "base/small_file.h"

namespace hydrodip {
namespace {

using Json = nlohmann::json;

constexpr int kMostPoints = 1000000;
constexpr std::uintmax_t kLargestFile = 256 << 20;  // a million points and as many samples
constexpr double kMostLength_mm = 1e5;

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
  [[noreturn]] void damaged() const { refuse(file_); }
  std::string text(const Json& json) const {
    if (!json.is_string()) refuse(file_);
    return json.get<std::string>();
  }

 private:
  const std::filesystem::path& file_;
};

CorrectedDip read_dip(const Json& json, const Reader& read) {
  CorrectedDip dip;
  const Json& model = read.member(json, "model");
  dip.model = read.text(read.member(model, "path"));
  dip.model_sha256 = read.text(read.member(model, "sha256"));
  dip.shape_sha256 = read.text(read.member(model, "shape_sha256"));
  const Json& rows = read.list(read.member(json, "to_posed"));
  if (rows.size() != 3) read.damaged();
  for (int i = 0; i < 3; ++i) {
    const Json& row = read.list(rows[std::size_t(i)]);
    if (row.size() != 3) read.damaged();
    for (int j = 0; j < 3; ++j) dip.to_posed(i, j) = read.number(row[std::size_t(j)], -1e9, 1e9);
  }
  const Json& size = read.list(read.member(json, "size_mm"));
  if (size.size() != 3) read.damaged();
  for (int k = 0; k < 3; ++k) dip.size_mm[k] = read.number(size[std::size_t(k)], 0, kMostLength_mm);
  dip.depth_mm = read.number(read.member(json, "depth_mm"), 0, kMostLength_mm);
  const auto value = [&](const char* group, const char* name, double most) {
    return read.number(read.member(read.member(json, group), name), 0, most);
  };
  dip.film_mm = {value("film", "width_mm", kMostLength_mm),
                 value("film", "height_mm", kMostLength_mm)};
  dip.margin_mm = value("film", "margin_mm", kMostLength_mm);
  dip.swelling = {value("film", "swelling_x", 10), value("film", "swelling_y", 10)};
  dip.z_stretch = value("material", "z_stretch", 1e3);
  dip.poisson = read.number(read.member(read.member(json, "material"), "poisson"), -1, 1);
  dip.ink_stiffness_ratio = value("material", "ink_stiffness_ratio", 1e9);
  if (json.contains("way")) dip.way = read.text(json["way"]);
  return dip;
}

}  // namespace

CorrectionFile read_correction(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_small_file(file, kLargestFile, "a correction");
  const Json json = parsed_json<Json>(bytes);
  const Reader read(file);
  const Json& grid = read.member(json, "grid");
  read.number(read.member(json, "schema_version"), 1, 1e6);
  require_known_schema(json, kCorrectionSchemaVersion, file, "this correction");
  if (!json.contains("of"))
    throw InputError(fmt::format(
        "{}: does not say of which dip it is; run 'hydrodip correct' again", file.string()));
  CorrectionFile result;
  result.of = read_dip(json["of"], read);
  FilmCorrection& field = result.field;
  field.first = read.pair(read.member(grid, "first_mm"), 1e4);
  field.pitch_mm = read.number(read.member(grid, "pitch_mm"), 0.1, 1e3);
  field.nx = int(read.number(read.member(grid, "nx"), 2, kMostPoints));
  field.ny = int(read.number(read.member(grid, "ny"), 2, kMostPoints));
  for (const Json& move : read.list(read.member(grid, "move_mm")))
    field.move.push_back(read.pair(move, kMostLength_mm));
  if (field.farthest_mm() > kFarthestCorrection_mm)
    throw InputError(fmt::format(
        "{}: moves the print by {:.0f} mm, which is no correction: its places are not those of "
        "this sheet; see how they were read, and run 'hydrodip correct' again",
        file.string(), field.farthest_mm()));
  if (double(field.move.size()) != double(field.nx) * double(field.ny)) refuse(file);
  for (const Json& sample : read.list(read.member(json, "samples")))
    result.samples.push_back({read.pair(read.member(sample, "model_mm"), 1e4),
                              read.pair(read.member(sample, "move_mm"), kMostLength_mm)});
  return result;
}

std::shared_ptr<const FilmCorrection> read_correction_field(const std::filesystem::path& file) {
  return std::make_shared<const FilmCorrection>(read_correction(file).field);
}

}  // namespace hydrodip
