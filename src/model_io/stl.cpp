// STL, as text and binary, with the facet colours of VisCAM and Magics.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "model_io/model_file.h"
#include "model_io/text.h"

namespace hydrodip {

namespace {

constexpr std::size_t kHeader = 84;
constexpr std::size_t kFacet = 50;
constexpr std::uint16_t kFlag = 0x8000;  // of a facet's colour word; five bits per channel follow

std::uint32_t facet_count(const FileBytes& bytes) {
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) count |= std::uint32_t(bytes[80 + i]) << (8 * i);
  return count;
}

double size_of(std::uint32_t facets) { return double(kHeader) + double(kFacet) * facets; }

// Many binary files begin with "solid" too, but no text has a NUL, and numbers have.
bool is_text(const FileBytes& bytes) {
  std::string_view text = without_bom(text_of(bytes));
  return text.substr(0, kHeader + kFacet).find('\0') == std::string_view::npos &&
         lower(take_word(text).substr(0, 10)) == "solid";
}

// ---- text ---------------------------------------------------------------------------------------

ModelFile read_text(const ModelInput& input) {
  std::string_view text = without_bom(text_of(input.bytes));
  if (text.find('\0') != std::string_view::npos)
    refuse_model(input.path, "not STL text, it contains binary data");
  ModelFile file;
  CancelCheck cancel(input.context);
  long number = 0;
  int corners = -1;  // -1: outside a facet
  bool open = false;
  while (!text.empty()) {
    cancel();
    std::string_view line = take_line(text);
    ++number;
    const std::string keyword = lower(take_word(line).substr(0, 40));
    if (keyword == "solid") {
      open = true;
    } else if (keyword == "endsolid") {
      if (corners >= 0) refuse_line(input.path, number, "a facet is not finished");
      open = false;
    } else if (keyword == "facet") {
      if (corners >= 0) refuse_line(input.path, number, "a facet is not finished");
      corners = 0;
    } else if (keyword == "vertex") {
      if (corners < 0) refuse_line(input.path, number, "a vertex outside a facet");
      std::array<float, 3> p{};
      for (float& coordinate : p)
        if (!parse_coordinate(take_word(line), coordinate))
          refuse_line(input.path, number, "a vertex needs three finite numbers");
      file.corners.push_back(std::int32_t(file.positions.size()));
      file.positions.emplace_back(p[0], p[1], p[2]);
      ++corners;
    } else if (keyword == "endfacet") {
      if (corners != 3) refuse_line(input.path, number, "a facet needs three vertices");
      corners = -1;
      file.end_face();
      check_count(input.path, file.corners.size());
    } else if (keyword != "outer" && keyword != "endloop" && !keyword.empty()) {
      refuse_line(input.path, number, "not a line of an STL file");
    }
  }
  if (open || corners >= 0)
    refuse_model(input.path, "the STL file ends too early, without 'endsolid'");
  if (file.face_end.empty()) refuse_model(input.path, "it has no triangles");
  return file;
}

// ---- binary -------------------------------------------------------------------------------------

// "COLOR=" in the header, and four bytes: Magics' colour of the whole object.
std::optional<LinearColor> magics_color(const FileBytes& bytes) {
  const std::string_view header = text_of(bytes).substr(0, 80);
  const std::size_t at = header.find("COLOR=");
  if (at == std::string_view::npos || at + 10 > header.size()) return {};
  const std::uint8_t* rgba = bytes.data() + at + 6;
  return linear_from_srgb(float(rgba[0]) / 255, float(rgba[1]) / 255, float(rgba[2]) / 255, 1);
}

// Whether red comes first, which bit says that a facet has a colour of its own, and what it has if
// it does not.
struct ColorRule {
  bool any = false;
  bool red_first = false;
  bool own_if_set = true;
  LinearColor otherwise{1, 1, 1, 1};
};

// VisCAM: blue first, the flag means a colour. Magics, by its manual: red first, the flag means the
// object's colour. MeshLab and others write Magics files with the flag set on every facet that has
// a colour: then flagged facets differ among themselves, which they never do in Magics' own.
ColorRule color_rule(const FileBytes& bytes, const std::vector<std::uint16_t>& words) {
  ColorRule rule;
  bool flagged = false, plain_color = false, flagged_differ = false;
  std::uint16_t first_flagged = 0;
  for (const std::uint16_t word : words) {
    if (word & kFlag) {
      flagged_differ = flagged_differ || (flagged && word != first_flagged);
      if (!flagged) first_flagged = word;
      flagged = true;
    } else {
      plain_color = plain_color || word != 0;
    }
  }
  const auto object_color = magics_color(bytes);
  if (!object_color) {
    rule.any = flagged;
    return rule;
  }
  rule.any = true;
  rule.red_first = true;
  rule.otherwise = *object_color;
  const std::uint16_t low = first_flagged & 0x7fff;
  const bool own_flagged =
      flagged && (flagged_differ || (!plain_color && low != 0 && low != 0x7fff));
  // Facets without any word at all have the object's colour.
  rule.own_if_set = own_flagged || (!flagged && !plain_color);
  return rule;
}

LinearColor color_of(std::uint16_t word, const ColorRule& rule) {
  if (bool(word & kFlag) != rule.own_if_set) return rule.otherwise;
  const auto channel = [&](int shift) { return float(word >> shift & 31) / 31; };
  return linear_from_srgb(channel(rule.red_first ? 0 : 10), channel(5),
                          channel(rule.red_first ? 10 : 0), 1);
}

// Writers that do not know the number beforehand leave it empty, 0 or the largest; others put
// something of their own behind the triangles. Fewer triangles than are promised is a file cut off.
std::uint32_t checked_count(const ModelInput& input) {
  const FileBytes& bytes = input.bytes;
  const std::uint32_t count = facet_count(bytes);
  const std::size_t held = (bytes.size() - kHeader) / kFacet;
  const bool open =
      (count == 0 || count == 0xffffffff) && held > 0 && bytes.size() == kHeader + kFacet * held;
  if (open) {
    input.context.warn(
        fmt::format("{} does not say how many triangles it has; it holds {}.", input.name, held));
    return std::uint32_t(std::min<std::size_t>(held, 0xffffffff));
  }
  const double more = double(bytes.size()) - size_of(count);
  if (more < 0 || (count == 0 && more > 0))
    refuse_model(input.path,
                 fmt::format("as a binary STL file of {} triangles it should have {:.0f} bytes, "
                             "but it has {}",
                             count, size_of(count), bytes.size()));
  if (more > 0)
    input.context.warn(
        fmt::format("{} has {:.0f} bytes behind its {} triangles, which are not "
                    "read.",
                    input.name, more, count));
  return count;
}

ModelFile read_binary(const ModelInput& input) {
  const FileBytes& bytes = input.bytes;
  if (bytes.size() < kHeader) refuse_model(input.path, "too short for an STL file");
  const std::uint32_t count = checked_count(input);
  if (count == 0) refuse_model(input.path, "it has no triangles");
  check_count(input.path, std::size_t(3) * count);
  ModelFile file;
  file.reserve(count, std::size_t(3) * count);
  file.positions.reserve(std::size_t(3) * count);
  std::vector<std::uint16_t> words;
  words.reserve(count);
  CancelCheck cancel(input.context);
  const std::size_t end = kHeader + kFacet * std::size_t(count);
  for (std::size_t at = kHeader; at < end; at += kFacet) {
    cancel();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      std::array<float, 3> p{};
      std::memcpy(p.data(), &bytes[at + 12 + 12 * corner], sizeof p);
      file.corners.push_back(std::int32_t(file.positions.size()));
      file.positions.emplace_back(p[0], p[1], p[2]);
    }
    file.end_face();
    words.push_back(std::uint16_t(bytes[at + 48] | bytes[at + 49] << 8));
  }
  const ColorRule rule = color_rule(bytes, words);
  if (rule.any) {
    file.colors.reserve(file.corners.size());
    for (const std::uint16_t word : words)
      file.colors.resize(file.colors.size() + 3, color_of(word, rule));
  }
  return file;
}

}  // namespace

ModelFile read_stl(const ModelInput& input) {
  const FileBytes& bytes = input.bytes;
  const bool sized_like_binary =
      bytes.size() >= kHeader && size_of(facet_count(bytes)) == double(bytes.size());
  return !sized_like_binary && is_text(bytes) ? read_text(input) : read_binary(input);
}

}  // namespace hydrodip
