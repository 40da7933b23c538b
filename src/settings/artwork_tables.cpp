#include "settings/artwork_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/parse_double.h"
#include "base/text.h"
#include "settings/hex_color.h"
#include "settings/refuse_value.h"
#include "settings/table_key.h"

namespace hydrodip {
namespace {

constexpr double kLeastSize_mm = 0.01, kLongest_mm = 1e5, kMostAspect = 1000;

using Numbers = std::vector<double>;
using Kind = LayerKey::Kind;

struct Key {
  LayerKey key;
  // False: the value is none that it can have.
  std::function<bool(ArtworkLayer&, const Setting&)> set;
  std::function<std::string(const ArtworkLayer&)> get;
  Wanted wanted = Wanted::kOther;
};

// ---- values ----

std::optional<Numbers> parse_list(const std::string& text) {
  Numbers values;
  for (std::string_view part : split(text, ',')) {
    part = trimmed(part);
    if (part.size() > 1 && part[0] == '+' && part[1] != '-') part.remove_prefix(1);
    double value = 0;
    const auto [rest, error] = parse_double(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || rest != part.data() + part.size()) return {};
    values.push_back(value);
  }
  return values;
}

// Finite ones only.
std::optional<Numbers> numbers_of(const Setting& setting) {
  std::optional<Numbers> values;
  if (const auto* number = std::get_if<double>(&setting.value))
    values = Numbers{*number};
  else if (const auto* list = std::get_if<Numbers>(&setting.value))
    values = *list;
  else if (const auto* text = std::get_if<std::string>(&setting.value); text && !setting.typed)
    values = parse_list(*text);
  if (values)
    for (const double value : *values)
      if (!std::isfinite(value)) return {};
  return values;
}

std::optional<std::string> text_of(const Setting& setting) {
  const auto* text = std::get_if<std::string>(&setting.value);
  if (!text || text->find('\0') != std::string::npos) return {};
  return *text;
}

std::string written(const Vec3& v) { return fmt::format("{},{},{}", v.x(), v.y(), v.z()); }

// ---- kinds of keys ----

Key number(const char* name, const char* unit, double min, double max, double ArtworkLayer::*member,
           const char* help) {
  return {{name, unit, fmt::format("a number from {} to {}", min, max), help, Kind::kNumbers},
          [=](ArtworkLayer& layer, const Setting& setting) {
            const auto values = numbers_of(setting);
            if (!values || values->size() != 1 || !((*values)[0] >= min && (*values)[0] <= max))
              return false;
            layer.*member = (*values)[0] + 0.0;
            return true;
          },
          [=](const ArtworkLayer& layer) { return fmt::format("{}", layer.*member); },
          Wanted::kNumber};
}

Key vector(const char* name, const char* unit, std::optional<Vec3> ArtworkLayer::*member,
           const char* help) {
  return {{name, unit, fmt::format("three numbers X,Y,Z, none beyond {:g}", kLongest_mm), help,
           Kind::kNumbers},
          [=](ArtworkLayer& layer, const Setting& setting) {
            const auto values = numbers_of(setting);
            if (!values || values->size() != 3) return false;
            const Vec3 v((*values)[0] + 0.0, (*values)[1] + 0.0, (*values)[2] + 0.0);
            if (!(v.cwiseAbs().maxCoeff() <= kLongest_mm)) return false;
            layer.*member = v;
            return true;
          },
          [=](const ArtworkLayer& layer) {
            return layer.*member ? written(*(layer.*member)) : std::string();
          }};
}

Key size() {
  return {
      {"size_mm", "mm", fmt::format("W or W,H, each from {:g} to {:g}", kLeastSize_mm, kLongest_mm),
       "width and height on the surface; one figure keeps the picture's shape; default: as "
       "large as fits",
       Kind::kNumbers},
      [](ArtworkLayer& layer, const Setting& setting) {
        const auto values = numbers_of(setting);
        if (!values || values->empty() || values->size() > 2) return false;
        for (const double value : *values)
          if (!(value >= kLeastSize_mm && value <= kLongest_mm)) return false;
        const auto [least, most] = std::minmax(values->front(), values->back());
        if (most > kMostAspect * least)
          throw InputError(fmt::format(
              "{}: {} is longer than {:g} times its width; such a picture shows nothing",
              setting.origin, setting.shown, kMostAspect));
        layer.width_mm = (*values)[0];
        layer.height_mm = values->size() > 1 ? (*values)[1] : 0;
        return true;
      },
      [](const ArtworkLayer& layer) {
        if (!(layer.width_mm > 0)) return std::string();
        return layer.height_mm > 0 ? fmt::format("{},{}", layer.width_mm, layer.height_mm)
                                   : fmt::format("{}", layer.width_mm);
      },
      Wanted::kNumber};
}

template <class Enum>
using Names = std::vector<std::pair<const char*, Enum>>;

template <class Enum>
Key choice(const char* name, Names<Enum> names, Enum ArtworkLayer::*member, const char* help) {
  std::string all;
  for (const auto& [label, value] : names)
    all += (all.empty() ? "one of " : ", ") + std::string(label);
  return {{name, "", all, help, Kind::kText},
          [=](ArtworkLayer& layer, const Setting& setting) {
            const auto text = text_of(setting);
            for (const auto& [label, value] : names)
              if (text && *text == label) {
                layer.*member = value;
                return true;
              }
            return false;
          },
          [=](const ArtworkLayer& layer) {
            for (const auto& [label, value] : names)
              if (layer.*member == value) return std::string(label);
            return std::string();
          }};
}

Key text(const char* name, std::string ArtworkLayer::*member, const char* help) {
  return {{name, "", "text", help, Kind::kText},
          [=](ArtworkLayer& layer, const Setting& setting) {
            const auto value = text_of(setting);
            if (value) layer.*member = *value;
            return value.has_value();
          },
          [=](const ArtworkLayer& layer) { return layer.*member; }};
}

Key image() {
  return {{"image", "", "a file name", "PNG, JPEG, WebP, TIFF, SVG, ...; in a file: beside it",
           Kind::kPath},
          [](ArtworkLayer& layer, const Setting& setting) {
            const auto value = text_of(setting);
            if (value) layer.image = *value;
            return value && !value->empty();
          },
          [](const ArtworkLayer& layer) { return layer.image.string(); }};
}

Key through() {
  return {
      {"through", "", "true or false", "also onto what lies behind the first surface", Kind::kFlag},
      [](ArtworkLayer& layer, const Setting& setting) {
        const auto value = text_of(setting);
        if (!value || (*value != "true" && *value != "false")) return false;
        layer.through = *value == "true";
        return true;
      },
      [](const ArtworkLayer& layer) { return std::string(layer.through ? "true" : "false"); }};
}

Key text_color() {
  return {{"text_color", "", "a colour such as #ffcc00", "of text", Kind::kText},
          [](ArtworkLayer& layer, const Setting& setting) {
            const auto hex = text_of(setting);
            const auto color = hex ? parse_color(*hex) : std::nullopt;
            if (color) layer.text_color = *color;
            return color.has_value();
          },
          [](const ArtworkLayer& layer) { return hex_of(layer.text_color); }};
}

const std::vector<Key>& keys() {
  static const std::vector<Key> all = {
      image(),
      text("text", &ArtworkLayer::text, "instead of an image: what is written"),
      text("font", &ArtworkLayer::font, "of text: a font of this machine, bold, italic"),
      text_color(),
      choice<Projection>(
          "projection",
          {{"planar", Projection::kPlanar},
           {"cylinder", Projection::kCylinder},
           {"sphere", Projection::kSphere},
           {"box", Projection::kBox},
           {"uv", Projection::kUv},
           {"wrap", Projection::kWrap},
           {"film", Projection::kFilm}},
          &ArtworkLayer::projection,
          "planar, cylinder, sphere, box push the picture through space; wrap sticks "
          "it on"),
      vector("at_mm", "mm", &ArtworkLayer::at_mm, "the picture's centre, in the model's frame"),
      vector("toward", "", &ArtworkLayer::toward,
             "the way it is projected; of cylinder and sphere the axis"),
      vector("up", "", &ArtworkLayer::up, "towards the picture's upper edge"),
      size(),
      number("turn_deg", "deg", -3600, 3600, &ArtworkLayer::turn_deg,
             "turn counter-clockwise, as one sees the picture"),
      choice<Repeat>(
          "repeat", {{"once", Repeat::kOnce}, {"tile", Repeat::kTile}, {"mirror", Repeat::kMirror}},
          &ArtworkLayer::repeat, "beyond the picture's edges"),
      through(),
      number("fade_deg", "deg", 0, 90, &ArtworkLayer::fade_deg,
             "fade out from this angle between surface and projection on; 90: nowhere"),
      number("opacity", "", 0, 1, &ArtworkLayer::opacity, "of the whole layer"),
      choice<Blend>("blend", {{"normal", Blend::kNormal}, {"multiply", Blend::kMultiply}},
                    &ArtworkLayer::blend, "how it mixes with what is below"),
  };
  return all;
}

// ---- names ----

constexpr std::string_view kTable = "artwork", kOption = "art.";

// "size_mm" of "artwork[2].size_mm" and "art.size_mm"; "" of others.
std::string key_of(const std::string& name) {
  if (name.starts_with(kOption)) return name.substr(kOption.size());
  const auto at = table_key(kTable, name);
  return at ? at->key : "";
}

bool is_of_kind(const std::string& name, Kind kind) {
  return std::any_of(keys().begin(), keys().end(),
                     [&](const Key& key) { return key.key.name == name && key.key.kind == kind; });
}

const Key& find_key(const std::string& name, const Setting& setting) {
  std::vector<std::string> names;
  for (const Key& key : keys()) {
    if (key.key.name == name) return key;
    names.push_back(key.key.name);
  }
  const std::string hint = did_you_mean(name, names);
  throw InputError(fmt::format("{}: a layer of artwork has no '{}'{}", setting.origin, name,
                               hint.empty() ? "; docs/artwork.md lists what it has" : hint));
}

ArtworkLayer& numbered(std::vector<ArtworkLayer>& layers, std::size_t number,
                       const Setting& setting) {
  if (number > std::min(layers.size() + 1, kMostLayers))
    throw InputError(fmt::format("{}: {}: the job has {} layers of artwork, and at most {}",
                                 setting.origin, setting.name, layers.size(), kMostLayers));
  if (number > layers.size()) layers.emplace_back();
  return layers[number - 1];
}

ArtworkLayer& topmost(std::vector<ArtworkLayer>& layers, const Setting& setting) {
  if (layers.empty())
    throw InputError(setting.origin + " needs artwork: name an image with --art, or --art-text");
  return layers.back();
}

}  // namespace

bool apply_artwork_setting(JobConfig& config, const Setting& setting) {
  const bool is_option = setting.name.starts_with(kOption);
  const auto at = table_key(kTable, setting.name);
  if (!is_option && !at) return false;
  std::vector<ArtworkLayer>& layers = config.object.artwork;
  const Key& key = find_key(key_of(setting.name), setting);
  ArtworkLayer& layer =
      is_option ? topmost(layers, setting) : numbered(layers, at->number, setting);
  if (!key.set(layer, setting)) refuse_value(setting, key.wanted, key.key.range);
  return true;
}

bool is_artwork_path(const std::string& name) { return is_of_kind(key_of(name), Kind::kPath); }
bool is_artwork_switch(const std::string& name) { return is_of_kind(key_of(name), Kind::kFlag); }

const std::vector<LayerKey>& layer_keys() {
  static const std::vector<LayerKey> list = [] {
    std::vector<LayerKey> all;
    for (const Key& key : keys()) all.push_back(key.key);
    return all;
  }();
  return list;
}

std::vector<std::string> layer_values(const ArtworkLayer& layer) {
  std::vector<std::string> values;
  for (const Key& key : keys()) values.push_back(key.get(layer));
  return values;
}

}  // namespace hydrodip
