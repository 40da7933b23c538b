#include "export/glb_writer.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/json_text.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kVariants = "KHR_materials_variants";
constexpr int kFloat = 5126, kUint32 = 5125;
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963;

}  // namespace

GlbWriter::GlbWriter() {
  json_["asset"] = {{"version", "2.0"}, {"generator", "hydrodip"}};
  json_["scene"] = 0;
  json_["scenes"] = Json::array({{{"name", "Preview"}, {"nodes", Json::array()}}});
  for (const char* part : {"nodes", "meshes", "materials"}) json_[part] = Json::array();
}

int GlbWriter::add_material(const Json& material) { return append("materials", material); }

int GlbWriter::add_texture(const std::vector<std::uint8_t>& file, const std::string& type,
                           const std::string& name, int wrap_u, int wrap_v) {
  const int image =
      append("images", {{"bufferView", add_view(file, 0)}, {"mimeType", type}, {"name", name}});
  constexpr int kLinear = 9729, kLinearMipmapLinear = 9987;
  const int sampler = append("samplers", {{"magFilter", kLinear},
                                          {"minFilter", kLinearMipmapLinear},
                                          {"wrapS", wrap_u},
                                          {"wrapT", wrap_v}});
  return append("textures", {{"sampler", sampler}, {"source", image}});
}

void GlbWriter::add_variants() {
  json_["extensionsUsed"] = Json::array({kVariants});
  json_["extensions"][kVariants]["variants"] =
      Json::array({{{"name", "predicted"}}, {{"name", "wanted"}}});
  has_variants_ = true;
}

void GlbWriter::add_mesh(const std::string& name, const GlbMesh& mesh,
                         const std::vector<GlbPart>& parts) {
  Json attributes;
  attributes["POSITION"] = add_floats(mesh.positions, true);
  attributes["NORMAL"] = add_floats(mesh.normals, false);
  if (!mesh.uvs.empty()) attributes["TEXCOORD_0"] = add_floats(mesh.uvs, false);
  if (!mesh.colors.empty()) attributes["COLOR_0"] = add_floats(mesh.colors, false);
  Json primitives = Json::array();
  for (const GlbPart& part : parts) {
    Json primitive = {{"attributes", attributes},
                      {"indices", add_indices(mesh.indices, part)},
                      {"material", part.predicted}};
    if (has_variants_) {
      primitive["extensions"][kVariants]["mappings"] =
          Json::array({{{"material", part.predicted}, {"variants", {0}}},
                       {{"material", part.wanted}, {"variants", {1}}}});
    }
    primitives.push_back(primitive);
  }
  const int number = append("meshes", {{"name", name}, {"primitives", primitives}});
  const int node = append("nodes", {{"name", name}, {"mesh", number}});
  json_["scenes"][0]["nodes"].push_back(node);
}

std::vector<std::uint8_t> GlbWriter::finish() {
  json_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
  Bytes text;
  // Names come as they are in the model's file.
  text.add(json_line(json_));
  text.pad(' ');
  Bytes file;
  file.add("glTF");
  file.add_u32(2);
  file.add_u32(std::uint32_t(12 + 8 + text.size() + 8 + binary_.size()));
  file.add_u32(std::uint32_t(text.size()));
  file.add("JSON");
  file.add(text.data());
  file.add_u32(std::uint32_t(binary_.size()));
  file.add(std::string("BIN\0", 4));
  file.add(binary_.data());
  return file.data();
}

int GlbWriter::append(const char* list, const Json& entry) {
  json_[list].push_back(entry);
  return int(json_[list].size()) - 1;
}

int GlbWriter::add_view(const std::vector<std::uint8_t>& bytes, int target) {
  Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  binary_.add(bytes);
  binary_.pad(0);
  return append("bufferViews", view);
}

template <std::size_t N>
int GlbWriter::add_floats(const std::vector<std::array<float, N>>& values, bool with_limits) {
  Bytes bytes;
  std::array<float, N> low = values.front();
  std::array<float, N> high = low;
  for (const auto& value : values) {
    for (std::size_t k = 0; k < N; ++k) {
      bytes.add_f32(value[k]);
      low[k] = std::min(low[k], value[k]);
      high[k] = std::max(high[k], value[k]);
    }
  }
  Json accessor = {{"bufferView", add_view(bytes.data(), kVertexBuffer)},
                   {"componentType", kFloat},
                   {"count", values.size()},
                   {"type", fmt::format("VEC{}", N)}};
  if (with_limits) {
    accessor["min"] = low;
    accessor["max"] = high;
  }
  return append("accessors", accessor);
}

int GlbWriter::add_indices(const std::vector<std::uint32_t>& indices, const GlbPart& part) {
  Bytes bytes;
  for (std::size_t i = 0; i < part.count; ++i) bytes.add_u32(indices[part.begin + i]);
  return append("accessors", {{"bufferView", add_view(bytes.data(), kIndexBuffer)},
                              {"componentType", kUint32},
                              {"count", part.count},
                              {"type", "SCALAR"}});
}

}  // namespace hydrodip
