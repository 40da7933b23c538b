#include "model_io/mtl.h"

#include <fmt/format.h>

#include <array>

#include "model_io/text.h"

namespace hydrodip {

namespace {

// What a material's lines say, before it is known what they mean together.
struct MtlLines {
  std::string name;
  std::array<float, 3> kd{0.6F, 0.6F, 0.6F};  // the format's default
  bool has_kd = false;
  float dissolve = 1;  // d
  float inverse = 0;   // Tr
  bool has_dissolve = false;
  std::string picture, mask;  // map_Kd, map_d
  bool clamp = false;
  std::array<float, 2> scale{1, 1}, offset{0, 0}, range{0, 1};
};

// As many numbers as `values` holds, or nothing.
template <std::size_t N>
bool take_numbers(std::string_view line, std::array<float, N>& values) {
  std::array<float, N> read{};
  for (float& value : read) {
    double number = 0;
    if (!parse_number(take_word(line), number)) return false;
    value = float(number);
  }
  values = read;
  return true;
}

// Up to `most` numbers that follow an option; the last two need not be there.
int take_option_numbers(std::string_view& line, float* values, int most) {
  int count = 0;
  while (count < most) {
    std::string_view probe = line;
    double number = 0;
    if (!parse_number(take_word(probe), number)) break;
    // The file's name may be a number too: something has to be left of the line.
    if (count > 0 && trimmed(probe).empty()) break;
    values[count++] = float(number);
    line = probe;
  }
  return count;
}

// "[-s u [v [w]]] [-o u [v [w]]] [-mm base gain] [-clamp on] [-other word] name"
void read_map(std::string_view line, MtlLines& material) {
  for (;;) {
    std::string_view rest = line;
    const std::string option = lower(take_word(rest));
    if (option.size() < 2 || option[0] != '-' || !(option[1] >= 'a' && option[1] <= 'z')) break;
    line = rest;
    std::array<float, 3> numbers{};
    if (option == "-s" || option == "-o" || option == "-t") {
      const int count = take_option_numbers(line, numbers.data(), 3);
      if (option == "-s" && count > 0) material.scale = {numbers[0], count > 1 ? numbers[1] : 1};
      if (option == "-o" && count > 0) material.offset = {numbers[0], count > 1 ? numbers[1] : 0};
    } else if (option == "-mm") {
      if (take_option_numbers(line, numbers.data(), 2) == 2)
        material.range = {numbers[0], numbers[1]};
    } else {
      const std::string value = lower(take_word(line));
      if (option == "-clamp") material.clamp = value == "on";
    }
  }
  material.picture = std::string(unquoted(trimmed(line).substr(0, 900)));
}

void read_line(std::string_view line, MtlLines& material) {
  const std::string key = lower(take_word(line));
  if (key == "kd") {
    material.has_kd = take_numbers(line, material.kd) || material.has_kd;
  } else if (key == "d") {
    std::string_view rest = line;
    if (take_word(rest) == "-halo") line = rest;
    std::array<float, 1> value{};
    if (!take_numbers(line, value)) return;
    material.dissolve = value[0];
    material.has_dissolve = true;
  } else if (key == "tr") {
    std::array<float, 1> value{};
    if (take_numbers(line, value)) material.inverse = value[0];
  } else if (key == "map_kd") {
    read_map(line, material);
  } else if (key == "map_d") {
    MtlLines mask;
    read_map(line, mask);
    material.mask = mask.picture;
  }
}

// A few names for a sentence, and how many there were.
struct Names {
  std::string some;
  int count = 0;
  void add(const std::string& name) {
    if (++count <= 3) some += (some.empty() ? "" : ", ") + shown(name);
    if (count == 4) some += ", ...";
  }
};

// Materials whose transparency is taken differently from how it stands there, or is likely wrong.
struct Oddities {
  Names invisible, inverted, masked;

  void tell(const std::string& library, const RunContext& context) const {
    if (invisible.count > 0)
      context.warn(fmt::format(
          "{} makes {} wholly transparent (d 0: {}), so nothing of it is printed; write d 1 where "
          "it is meant to be seen.",
          library, counted(invisible), invisible.some));
    if (inverted.count > 0)
      context.warn(fmt::format(
          "{} says Tr 1 for {} ({}), which means invisible; it is taken as opaque, as MeshLab "
          "means it. Write d 0 if nothing of it should be printed.",
          library, counted(inverted), inverted.some));
    if (masked.count > 0)
      context.warn(fmt::format(
          "{} gives {} a picture of its transparency (map_d: {}), which is not read; put it into "
          "the alpha of map_Kd's picture.",
          library, counted(masked), masked.some));
  }

 private:
  static std::string counted(const Names& names) {
    return names.count == 1 ? "a material" : fmt::format("{} materials", names.count);
  }
};

// MeshLab and others write "Tr 1" where they mean opaque; by the format's own word it is invisible.
float alpha_of(const MtlLines& lines, Oddities& odd) {
  if (lines.has_dissolve) {
    if (lines.dissolve <= 0) odd.invisible.add(lines.name);
    return lines.dissolve;
  }
  if (lines.inverse < 1) return 1 - lines.inverse;
  odd.inverted.add(lines.name);
  return 1;
}

MtlMaterial meaning_of(const MtlLines& lines, Oddities& odd) {
  MtlMaterial out;
  FileMaterial& material = out.material;
  material.name = lines.name;
  material.color_is_default = !lines.has_kd;
  material.base_color =
      linear_from_srgb(lines.kd[0], lines.kd[1], lines.kd[2], alpha_of(lines, odd));
  out.picture = lines.picture;
  // Exporters name the picture of map_Kd again where its own alpha counts, which it does.
  if (!lines.mask.empty() && lines.mask != lines.picture) odd.masked.add(lines.name);
  // A grey Kd beside a map_Kd is an exporter's default, not a tint: it would only darken the print.
  const LinearColor& kd = material.base_color;
  const bool grey = kd.r == kd.g && kd.g == kd.b;
  material.texture_tint = grey ? LinearColor{1, 1, 1, kd.a} : kd;
  if (lines.clamp) material.wrap_u = material.wrap_v = Wrap::kClamp;
  material.picture_base = lines.range[0];
  material.picture_gain = lines.range[1];
  material.transformed =
      lines.scale != std::array<float, 2>{1, 1} || lines.offset != std::array<float, 2>{0, 0};
  material.transform << lines.scale[0], 0, lines.offset[0], 0, lines.scale[1], lines.offset[1];
  return out;
}

}  // namespace

std::vector<MtlMaterial> read_mtl(const std::string& name, const FileBytes& bytes,
                                  const RunContext& context) {
  std::vector<MtlMaterial> materials;
  MtlLines lines;
  Oddities odd;
  CancelCheck cancel(context);
  const auto finish = [&] {
    if (!lines.name.empty()) materials.push_back(meaning_of(lines, odd));
    lines = {};
  };
  std::string_view rest = without_bom(text_of(bytes));
  while (!rest.empty()) {
    cancel();
    std::string_view line = take_line(rest);
    line = line.substr(0, line.find('\0'));
    std::string_view words = line;
    if (lower(take_word(words)) == "newmtl" && !trimmed(words).empty()) {
      finish();
      lines.name = std::string(trimmed(words).substr(0, 900));
    } else if (!lines.name.empty()) {
      read_line(line, lines);
    }
  }
  finish();
  odd.tell(name, context);
  return materials;
}

}  // namespace hydrodip
