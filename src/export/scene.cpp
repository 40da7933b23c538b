#include "export/scene.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/run_scope.h"
#include "export/packer.h"
#include "export/scene_object.h"
#include "image/resize.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostTriangles = 300000;
constexpr int kTextureSide_px = 2048;
constexpr std::size_t kTexturePixels = 3u << 22;  // of all textures together
constexpr int kJpegQuality = 88;
constexpr std::uint8_t kNothing = 255;  // in a layer

Json place_json(const Packer::Place& place) {
  return {{"offset", place.offset},
          {"count", place.count},
          {"bytes", place.bytes},
          {"delta", place.delta}};
}

// Numbers as 16-bit steps between the smallest and the largest of each component.
class Quantizer {
 public:
  explicit Quantizer(std::size_t components) : low_(components, 1e300), high_(components, -1e300) {}

  template <class Values>
  void widen(const Values& values) {
    for (std::size_t k = 0; k < low_.size(); ++k) {
      low_[k] = std::min(low_[k], double(values[k]));
      high_[k] = std::max(high_[k], double(values[k]));
    }
  }

  std::uint16_t step(std::size_t k, double value) const {
    const double range = high_[k] - low_[k];
    if (!(range > 0)) return 0;
    return std::uint16_t(std::lround(65535 * std::clamp((value - low_[k]) / range, 0.0, 1.0)));
  }

  Json json(const Packer::Place& place) const {
    Json result = place_json(place);
    std::vector<double> steps;
    for (std::size_t k = 0; k < low_.size(); ++k) steps.push_back((high_[k] - low_[k]) / 65535);
    result["low"] = low_;
    result["step"] = steps;
    return result;
  }

 private:
  std::vector<double> low_, high_;
};

// Interleaved components of a list of vertices.
template <class Item, class Get>
Json add_quantized(Packer& packer, const std::vector<Item>& items, std::size_t components,
                   const Get& get) {
  Quantizer quantizer(components);
  for (const Item& item : items) quantizer.widen(get(item));
  if (items.empty()) quantizer.widen(std::vector<double>(components, 0));
  std::vector<std::uint16_t> steps;
  steps.reserve(components * items.size());
  for (const Item& item : items) {
    const auto& values = get(item);
    for (std::size_t k = 0; k < components; ++k)
      steps.push_back(quantizer.step(k, double(values[k])));
  }
  return quantizer.json(packer.add(steps, components));
}

std::vector<std::uint32_t> flat_indices(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> indices;
  for (const Triangle& triangle : triangles) {
    for (const std::int32_t v : triangle) indices.push_back(std::uint32_t(v));
  }
  return indices;
}

// --- Object ---

std::string data_url(const Image& image) {
  const ShownPicture picture = shown_picture(image, kJpegQuality);
  return "data:" + picture.type + ";base64," + base64(picture.bytes);
}

Json textures_json(const Object& object) {
  std::size_t pixels = 0;
  for (const auto& texture : object.textures) {
    const Image& image = *texture;
    pixels += std::min<std::size_t>(std::size_t(kTextureSide_px) * kTextureSide_px,
                                    std::size_t(image.width_px) * std::size_t(image.height_px));
  }
  const double shrink =
      pixels > kTexturePixels ? std::sqrt(double(kTexturePixels) / double(pixels)) : 1;
  Json list = Json::array();
  for (const auto& texture : object.textures) {
    list.push_back(data_url(shrink_to(*texture, std::max(16, int(kTextureSide_px * shrink)))));
  }
  return list;
}

Json materials_json(const Object& object) {
  Json list = Json::array();
  for (const Material& material : object.materials) {
    const LinearColor& c = material.base_color;
    list.push_back({{"color", {c.r, c.g, c.b, c.a}},
                    {"texture", object.uvs.empty() ? -1 : material.texture},
                    {"wrap", {wrap_name(material.wrap_u), wrap_name(material.wrap_v)}}});
  }
  return list;
}

Json object_json(const Object& object, Packer& packer) {
  const ShownObject shown = shown_object(object, kMostTriangles);
  Json json;
  json["simplified"] = shown.simplified;
  json["position"] = add_quantized(
      packer, shown.vertices, 3, [](const ShownVertex& v) -> const auto& { return v.position; });
  json["normal"] = add_quantized(
      packer, shown.vertices, 3, [](const ShownVertex& v) -> const auto& { return v.normal; });
  if (!object.uvs.empty()) {
    json["uv"] = add_quantized(
        packer, shown.vertices, 2, [](const ShownVertex& v) -> const auto& { return v.uv; });
  }
  if (!object.colors.empty()) {
    json["color"] = add_quantized(
        packer, shown.vertices, 4, [](const ShownVertex& v) -> const auto& { return v.color; });
  }
  json["index"] = place_json(packer.add(shown.indices));
  Json groups = Json::array();
  for (const ShownGroup& group : shown.groups) {
    groups.push_back(
        {{"material", group.material}, {"start", group.begin}, {"count", group.count}});
  }
  json["groups"] = groups;
  json["materials"] = materials_json(object);
  json["textures"] = textures_json(object);
  return json;
}

// --- Film ---

// Where the object is in the bath: 4 x 4, column by column.
Json pose_json(const Moment& moment) {
  Json matrix = Json::array();
  for (Eigen::Index c = 0; c < 3; ++c) {
    for (Eigen::Index r = 0; r < 3; ++r) matrix.push_back(moment.turn(r, c));
    matrix.push_back(0);
  }
  matrix.push_back(moment.shift.x());
  matrix.push_back(moment.shift.y());
  matrix.push_back(moment.shift.z() - moment.level_mm);
  matrix.push_back(1);
  return matrix;
}

Json frames_json(const DipHistory& history, Packer& packer) {
  Quantizer quantizer(3);
  for (const DipFrame& frame : history.frames()) {
    for (const auto& p : frame.position) quantizer.widen(p);
  }
  std::vector<std::uint16_t> steps;
  Json levels = Json::array(), poses = Json::array();
  std::size_t values = 1;
  for (const DipFrame& frame : history.frames()) {
    levels.push_back(frame.moment.travelled_mm);
    if (frame.moment.moved) poses.push_back(pose_json(frame.moment));
    values = 3 * frame.position.size();
    for (const auto& p : frame.position) {
      for (std::size_t k = 0; k < 3; ++k) steps.push_back(quantizer.step(k, double(p[k])));
    }
  }
  // Against the frame before: film that is attached stays where it is.
  Json json = quantizer.json(packer.add(steps, values));
  json["levels"] = levels;
  if (!poses.empty()) json["poses"] = poses;
  return json;
}

Json film_json(const SceneSource& source, Packer& packer) {
  const DippedFilm& film = source.film;
  Json json;
  json["u"] = add_quantized(
      packer, film.mesh().u, 2, [](const Vec2& u) -> const auto& { return u; });
  json["index"] = place_json(packer.add(flat_indices(film.mesh().triangles), 3));
  json["position"] = add_quantized(
      packer, film.position, 3, [](const Vec3& p) -> const auto& { return p; });
  json["frames"] = frames_json(source.history, packer);
  json["attached_from"] = place_json(packer.add(source.history.attached_from()));
  std::vector<std::uint8_t> state;
  for (const VertexState s : film.state) state.push_back(std::uint8_t(s));
  json["state"] = place_json(packer.add(state));
  // The page knows whole triangles: those of which most is whole.
  std::vector<std::uint8_t> torn = film.torn;
  for (std::size_t t = 0; t < torn.size(); ++t)
    if (film.lies_on_object(t) && film.whole_part(t).share < 0.5) torn[t] = 1;
  json["torn"] = place_json(packer.add(torn));
  const auto scalar = [](double value) { return std::array<double, 1>{value}; };
  json["stretch"] = add_quantized(packer, film.stretch, 1, scalar);
  json["area_ratio"] = add_quantized(packer, film.area_ratio, 1, scalar);
  return json;
}

Json layer_json(const FilmLayer& layer, Packer& packer) {
  float largest = 0;
  for (const float value : layer.values) {
    if (!std::isnan(value)) largest = std::max(largest, value);
  }
  std::vector<std::uint8_t> cells;
  for (const float value : layer.values) {
    cells.push_back(std::isnan(value) ? kNothing
                    : largest > 0 ? std::uint8_t(std::lround(254 * std::max(0.0f, value) / largest))
                                  : std::uint8_t(0));
  }
  Json json = place_json(packer.add(cells));
  json["key"] = layer.key;
  json["width"] = layer.width;
  json["height"] = layer.height;
  json["extent"] = {layer.extent.min.x(), layer.extent.min.y(), layer.extent.max.x(),
                    layer.extent.max.y()};
  json["largest"] = largest;
  return json;
}

Json layers_json(const SceneSource& source, Packer& packer) {
  Json list = Json::array();
  for (const FilmLayer& layer : source.layers) {
    if (!layer.values.empty()) list.push_back(layer_json(layer, packer));
  }
  return list;
}

Json looks_json(const SceneSource& source, Packer& packer) {
  Json list = Json::array();
  for (const FinishLook& look : source.looks)
    list.push_back({{"key", look.key}, {"object", object_json(look.object, packer)}});
  return list;
}

// --- Sheet ---

// The film image over the bare object's colour: what it leaves on the object, and a sheet to look
// at.
Image over_base(const Image& image, const LinearColor& base) {
  Image result = image;
  CheckEvery check(1 << 14);
  for (std::size_t i = 0; i < result.rgba.size(); i += 4) {
    check();
    std::uint8_t* p = result.rgba.data() + i;
    const float alpha = float(p[3]) / 255;
    const float channels[3] = {base.r, base.g, base.b};
    for (std::size_t c = 0; c < 3; ++c) {
      p[c] = linear_to_srgb8(channels[c] + alpha * (srgb8_to_linear(p[c]) - channels[c]));
    }
    p[3] = 255;
  }
  return result;
}

Json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json sheet_json(const SceneSource& source) {
  Json json = {{"width_mm", source.sheet_width_mm}, {"height_mm", source.sheet_height_mm}};
  if (!source.sheet.empty()) {
    json["picture"] = data_url(over_base(shrink_to(source.sheet, kTextureSide_px), source.base));
  }
  return json;
}

// '<' could end the script element, and only stands in strings.
std::string without_tags(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

}  // namespace

std::string scene_json(const SceneSource& source, const RunContext& context) {
  const RunScope scope(context);
  const std::string activity = "packing the 3D view";
  context.progress(activity, 0);
  Packer packer;
  Json json;
  json["base"] = {source.base.r, source.base.g, source.base.b};
  json["depth_mm"] = source.film.depth_mm;
  json["tear_stretch"] = source.tear_stretch;
  json["cell_mm"] = source.film.mesh().cell_mm;
  json["bath"] = {{"width_mm", source.bath_width_mm}, {"height_mm", source.bath_height_mm}};
  json["sheet"] = sheet_json(source);
  json["standing"] = {{"up", vector_json(source.standing.up)},
                      {"front", vector_json(source.standing.front)}};
  json["first_look"] = vector_json(source.first_look);
  context.progress(activity, 0.3);
  json["object"] = object_json(source.object, packer);
  context.progress(activity, 0.5);
  json["film"] = film_json(source, packer);
  json["looks"] = looks_json(source, packer);
  json["dips"] = source.dips;
  json["layers"] = layers_json(source, packer);
  context.progress(activity, 0.7);
  json["data"] = packer.finish();
  context.progress(activity, 1);
  return without_tags(json.dump(-1, ' ', true, Json::error_handler_t::replace));
}

}  // namespace hydrodip
