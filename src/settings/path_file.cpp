#include "settings/path_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "base/parse_double.h"
#include "base/small_file.h"
#include "base/table_rows.h"
#include "base/text.h"
#include "base/unicode.h"
#include "model_io/model_file.h"

namespace hydrodip {
namespace {

constexpr std::string_view kHeader =
    "lower_mm,shift_x_mm,shift_y_mm,turn_x_deg,turn_y_deg,turn_z_deg";
constexpr std::size_t kMostKeyframes = 10000;
constexpr std::uintmax_t kLargestFile = 1 << 21;
constexpr double kFurthest_mm = 5000, kMostTurn_deg = 3600;

std::vector<std::string_view> trimmed_parts(std::string_view text, char at) {
  std::vector<std::string_view> parts = split(text, at);
  for (std::string_view& part : parts) part = trimmed(part);
  return parts;
}

double number(std::string_view text, const std::string& origin) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = parse_double(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw InputError(fmt::format("{}: '{}' is not a number", origin, text.substr(0, 40)));
  return value;
}

template <class Text>
Keyframe keyframe_of(const std::vector<Text>& cells, const std::string& origin) {
  if (cells.size() != 6)
    throw InputError(fmt::format("{}: a keyframe has 6 numbers, not {}", origin, cells.size()));
  std::array<double, 6> v{};
  for (std::size_t n = 0; n < 6; ++n) v[n] = number(cells[n], origin);
  return {v[0], v[1], v[2], v[3], v[4], v[5]};
}

}  // namespace

bool is_path_file(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = in_utf8(read_file(file));
  TableRows rows(text_of(bytes));
  return rows.next() && rows.is(kHeader);
}

std::vector<Keyframe> path_of_rows(const std::string& text, const std::string& origin) {
  std::vector<Keyframe> keyframes;
  for (const std::string_view row : trimmed_parts(text, ';'))
    if (!row.empty()) keyframes.push_back(keyframe_of(trimmed_parts(row, ','), origin));
  check_path(keyframes, origin);
  return keyframes;
}

std::string rows_of(const std::vector<Keyframe>& keyframes) {
  std::string rows;
  for (const Keyframe& k : keyframes)
    rows += fmt::format("{}{},{},{},{},{},{}", rows.empty() ? "" : "; ", k.lower_mm, k.shift_x_mm,
                        k.shift_y_mm, k.turn_x_deg, k.turn_y_deg, k.turn_z_deg);
  return rows;
}

void check_path(const std::vector<Keyframe>& keyframes, const std::string& origin) {
  if (keyframes.size() < 2)
    throw InputError(fmt::format(
        "{}: a path needs two keyframes at least: where it begins and where it ends", origin));
  if (keyframes.size() > kMostKeyframes)
    throw InputError(fmt::format("{}: a path has {} keyframes at most", origin, kMostKeyframes));
  for (std::size_t n = 0; n < keyframes.size(); ++n) {
    const Keyframe& k = keyframes[n];
    const bool near = std::abs(k.lower_mm) <= kFurthest_mm &&
                      std::abs(k.shift_x_mm) <= kFurthest_mm &&
                      std::abs(k.shift_y_mm) <= kFurthest_mm;
    const bool turns = std::abs(k.turn_x_deg) <= kMostTurn_deg &&
                       std::abs(k.turn_y_deg) <= kMostTurn_deg &&
                       std::abs(k.turn_z_deg) <= kMostTurn_deg;
    if (!near || !turns)
      throw InputError(fmt::format(
          "{}: keyframe {} of the path is out of any bath: lengths are at most {} mm, turns {} "
          "degrees",
          origin, n + 1, kFurthest_mm, kMostTurn_deg));
  }
}

std::vector<Keyframe> read_path(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = in_utf8(read_small_file(file, kLargestFile, "a path"));
  TableRows rows(text_of(bytes));
  const auto origin = [&] { return fmt::format("{}:{}", file.string(), rows.line()); };
  const bool any = rows.next();
  if (!any || !rows.is(kHeader))
    throw InputError(
        fmt::format("{}: a path begins with the line {}", any ? origin() : file.string(), kHeader));
  std::vector<Keyframe> keyframes;
  while (rows.next()) keyframes.push_back(keyframe_of(rows.cells(), origin()));
  check_path(keyframes, file.string());
  return keyframes;
}

}  // namespace hydrodip
