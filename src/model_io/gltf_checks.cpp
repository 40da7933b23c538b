#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "model_io/file_checks.h"

namespace hydrodip {

namespace {

using nlohmann::json;

constexpr int kMaxDepth = 128;            // of nodes and of JSON brackets
constexpr std::int64_t kMaxPlaced = 1e8;  // triangles after instancing
constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;

std::uint32_t little_endian32(const std::uint8_t* p) {
  return std::uint32_t(p[0]) | std::uint32_t(p[1]) << 8 | std::uint32_t(p[2]) << 16 |
         std::uint32_t(p[3]) << 24;
}

void append32(FileBytes& out, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) out.push_back(std::uint8_t(value >> (8 * i)));
}

// The parts of a file, before any meaning.
struct Container {
  bool glb = false;
  std::string text;
  FileBytes bin;
  bool has_bin = false;
};

class GltfCheck {
 public:
  GltfCheck(const std::string& path, SideFiles& side_files)
      : path_(path), side_files_(side_files) {}

  CheckedFile run(const FileBytes& bytes) {
    Container container = open(bytes);
    parse(container.text);
    check_version();
    keep_what_matters();
    check_buffers(container);
    check_views();
    check_accessors(container);
    check_images();
    check_materials();
    check_meshes();
    check_nodes();
    CheckedFile checked;
    checked.bytes = container.glb ? pack(container) : plain();
    checked.warnings = warnings_;
    return checked;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: {}; export the model again.", path_, what));
  }

  // ---- container

  Container open(const FileBytes& bytes) const {
    Container container;
    container.glb = bytes.size() >= 4 && little_endian32(bytes.data()) == kGlbMagic;
    if (!container.glb) {
      container.text.assign(bytes.begin(), bytes.end());
      return container;
    }
    if (bytes.size() < 20) refuse("the GLB file ends too early");
    if (little_endian32(&bytes[4]) != 2) refuse("not version 2 of GLB");
    const std::size_t length = little_endian32(&bytes[8]);
    if (length > bytes.size()) refuse("the GLB file ends too early");
    const std::size_t json_length = little_endian32(&bytes[12]);
    if (little_endian32(&bytes[16]) != kJsonChunk || json_length > length - 20) {
      refuse("the GLB file has no JSON chunk");
    }
    container.text.assign(bytes.begin() + 20, bytes.begin() + 20 + std::ptrdiff_t(json_length));
    const std::size_t at = 20 + json_length;
    if (at + 8 > length) return container;
    const std::size_t bin_length = little_endian32(&bytes[at]);
    if (little_endian32(&bytes[at + 4]) != kBinChunk) return container;
    if (bin_length > length - at - 8) refuse("the GLB file's binary chunk is cut off");
    const auto begin = bytes.begin() + std::ptrdiff_t(at + 8);
    container.bin.assign(begin, begin + std::ptrdiff_t(bin_length));
    container.has_bin = true;
    return container;
  }

  void parse(const std::string& text) {
    // Readers recurse into brackets: a file of nothing but "[" must not exhaust the stack.
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      if (quoted) {
        if (c == '\\') ++i;
        quoted = c != '"';
        continue;
      }
      quoted = c == '"';
      if (c == '[' || c == '{') ++depth;
      if (c == ']' || c == '}') --depth;
      if (depth > kMaxDepth) refuse("its JSON is nested too deeply");
    }
    root_ = json::parse(text, nullptr, false);
    if (root_.is_discarded() || !root_.is_object()) refuse("not glTF, its JSON cannot be parsed");
  }

  void check_version() const {
    const auto asset = root_.find("asset");
    if (asset == root_.end() || !asset->is_object() || !asset->contains("version") ||
        !asset->at("version").is_string() ||
        asset->at("version").get<std::string>().rfind("2.", 0) != 0) {
      refuse("not glTF version 2");
    }
  }

  // ---- reduction to shape and colour

  static void keep(json& object, std::initializer_list<const char*> names) {
    if (!object.is_object()) return;
    for (auto it = object.begin(); it != object.end();) {
      const bool kept = std::any_of(names.begin(), names.end(),
                                    [&](const char* name) { return it.key() == name; });
      it = kept ? std::next(it) : object.erase(it);
    }
  }

  void keep_what_matters() {
    const auto required = root_.find("extensionsRequired");
    if (required != root_.end() && required->is_array()) {
      for (const json& name : *required) {
        if (name != "KHR_texture_transform" && name != "KHR_materials_unlit") {
          refuse(fmt::format("it needs the glTF extension {}, which is not supported",
                             name.is_string() ? name.get<std::string>() : "?"));
        }
      }
    }
    keep(root_, {"scene", "scenes", "nodes", "meshes", "materials", "textures", "images",
                 "samplers", "accessors", "bufferViews", "buffers"});
    for (const char* name : {"scenes", "nodes", "meshes", "materials", "textures", "images",
                             "samplers", "accessors", "bufferViews", "buffers"}) {
      check_table(name);
    }
    root_["asset"] = {{"version", "2.0"}};
    // assimp only looks at extensions that are declared.
    root_["extensionsUsed"] = json::array({"KHR_texture_transform"});
  }

  // Names are dropped: nothing needs them but materials, and odd ones only make trouble.
  void check_table(const char* name) {
    const auto it = root_.find(name);
    if (it == root_.end()) return;
    if (!it->is_array()) refuse(fmt::format("'{}' is not a list", name));
    for (json& entry : *it) {
      if (!entry.is_object()) refuse(fmt::format("an entry of '{}' is not an object", name));
      const bool named = std::strcmp(name, "materials") == 0 && entry.contains("name") &&
                         entry["name"].is_string();
      const json kept_name = named ? entry["name"] : json();
      entry.erase("name");
      entry.erase("extras");
      if (named) entry["name"] = kept_name.get<std::string>().substr(0, 200);
    }
    if (it->empty()) root_.erase(it);
  }

  // ---- access with checks

  std::size_t table_size(const char* name) const {
    const auto it = root_.find(name);
    return it == root_.end() ? 0 : it->size();
  }

  std::int64_t integer(const json& object, const char* name, std::int64_t fallback) const {
    const auto it = object.find(name);
    if (it == object.end()) return fallback;
    const bool whole =
        it->is_number_integer() ||
        (it->is_number_float() && std::floor(it->get<double>()) == it->get<double>());
    if (!whole || std::abs(it->get<double>()) > 9e15) {
      refuse(fmt::format("'{}' is not a whole number", name));
    }
    return it->is_number_integer() ? it->get<std::int64_t>() : std::int64_t(it->get<double>());
  }

  // An index into a table, or -1 if absent and not needed.
  std::int64_t reference(const json& object, const char* name, const char* table,
                         bool needed = false) const {
    const std::int64_t index = integer(object, name, -1);
    if (!object.contains(name) && !needed) return -1;
    if (index < 0 || index >= std::int64_t(table_size(table))) {
      refuse(
          fmt::format("'{}' refers to entry {} of '{}', which does not exist", name, index, table));
    }
    return index;
  }

  void numbers(const json& object, const char* name, std::size_t count) const {
    const auto it = object.find(name);
    if (it == object.end()) return;
    bool good = it->is_array() && it->size() == count;
    for (std::size_t i = 0; good && i < count; ++i) {
      good = (*it)[i].is_number() && std::isfinite((*it)[i].get<float>());
    }
    if (!good) refuse(fmt::format("'{}' is not a list of {} numbers", name, count));
  }

  // ---- buffers

  std::int64_t buffer_bytes(const json& buffer, const Container& container, std::size_t i) {
    if (!buffer.contains("uri")) {
      if (i != 0 || !container.glb || !container.has_bin) refuse("a buffer has no data");
      return std::int64_t(container.bin.size());
    }
    if (!buffer["uri"].is_string()) refuse("a buffer's address is not text");
    const std::string uri = buffer["uri"].get<std::string>();
    if (uri.rfind("data:", 0) == 0) {
      const std::size_t comma = uri.find(',');
      if (comma == std::string::npos || uri.find("base64") > comma) {
        refuse("a buffer's data is not base64");
      }
      return check_base64(uri.substr(comma + 1));
    }
    const std::int64_t size = side_files_.size(uri);
    if (size < 0) {
      throw InputError(fmt::format("{}: its data file {} is missing; put it beside the model.",
                                   path_, uri.substr(0, 200)));
    }
    return size;
  }

  std::int64_t check_base64(const std::string& text) const {
    if (text.size() % 4 != 0) refuse("embedded base64 data is damaged");
    std::size_t padding = 0;
    while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') {
      ++padding;
    }
    for (std::size_t i = 0; i + padding < text.size(); ++i) {
      const unsigned char c = static_cast<unsigned char>(text[i]);
      if (!(std::isalnum(c) || c == '+' || c == '/')) refuse("embedded base64 data is damaged");
    }
    return std::int64_t(text.size() / 4 * 3 - padding);
  }

  void check_buffers(const Container& container) {
    for (std::size_t i = 0; i < table_size("buffers"); ++i) {
      json& buffer = root_["buffers"][i];
      keep(buffer, {"uri", "byteLength"});
      const std::int64_t length = integer(buffer, "byteLength", -1);
      if (length < 1 || length > buffer_bytes(buffer, container, i)) {
        refuse(fmt::format("buffer {} is longer than its data", i));
      }
      buffer_length_.push_back(length);
    }
  }

  void check_views() {
    for (std::size_t i = 0; i < table_size("bufferViews"); ++i) {
      json& view = root_["bufferViews"][i];
      keep(view, {"buffer", "byteOffset", "byteLength", "byteStride"});
      const std::int64_t buffer = reference(view, "buffer", "buffers", true);
      const std::int64_t offset = integer(view, "byteOffset", 0);
      const std::int64_t length = integer(view, "byteLength", -1);
      const std::int64_t stride = integer(view, "byteStride", 0);
      if (offset < 0 || length < 1 || offset > buffer_length_[std::size_t(buffer)] - length ||
          stride < 0 || stride > 252 || (view.contains("byteStride") && stride < 4)) {
        refuse(fmt::format("buffer view {} lies outside its buffer", i));
      }
    }
  }

  static int component_bytes(std::int64_t type) {
    switch (type) {
      case 5120:
      case 5121:
        return 1;
      case 5122:
      case 5123:
        return 2;
      case 5125:
      case 5126:
        return 4;
      default:
        return 0;
    }
  }

  static int components(const json& accessor) {
    const auto it = accessor.find("type");
    if (it == accessor.end() || !it->is_string()) return 0;
    const std::string type = it->get<std::string>();
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
  }

  void check_accessors(const Container& container) {
    for (std::size_t i = 0; i < table_size("accessors"); ++i) {
      json& accessor = root_["accessors"][i];
      const bool sparse = accessor.contains("sparse");
      keep(accessor, {"bufferView", "byteOffset", "componentType", "normalized", "count", "type"});
      Accessor known;
      known.components = components(accessor);
      known.component_type = integer(accessor, "componentType", 0);
      known.count = integer(accessor, "count", 0);
      known.view = reference(accessor, "bufferView", "bufferViews");
      known.offset = integer(accessor, "byteOffset", 0);
      const int size = component_bytes(known.component_type) * known.components;
      known.usable = !sparse && known.view >= 0 && size > 0 && known.count > 0;
      if (accessor.contains("normalized") && !accessor["normalized"].is_boolean()) {
        refuse("'normalized' is neither true nor false");
      }
      if (known.usable) {
        const json& view = root_["bufferViews"][std::size_t(known.view)];
        const std::int64_t length = integer(view, "byteLength", 0);
        known.stride = integer(view, "byteStride", size);
        if (known.stride < size) refuse(fmt::format("accessor {} overlaps itself", i));
        // count is bounded first so that the product cannot overflow.
        if (known.offset < 0 || known.count > length ||
            known.offset + (known.count - 1) * known.stride + size > length) {
          refuse(fmt::format("accessor {} lies outside its buffer view", i));
        }
        read_indices(container, view, known);
      } else {
        // Unused ones (animations, sparse shapes) must not trip the reader.
        accessor = {{"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}};
      }
      accessors_.push_back(known);
    }
  }

  struct Accessor {
    bool usable = false;
    int components = 0;
    std::int64_t component_type = 0;
    std::int64_t count = 0;
    std::int64_t view = -1;
    std::int64_t offset = 0;
    std::int64_t stride = 0;
    std::int64_t highest = -1;  // of a GLB's index list; -1: not read here
  };

  // assimp drops triangles with indices out of range in silence; a GLB's indices are at hand.
  void read_indices(const Container& container, const json& view, Accessor& accessor) const {
    if (accessor.components != 1 || accessor.component_type == 5126) return;
    const json& buffer = root_["buffers"][std::size_t(integer(view, "buffer", 0))];
    if (buffer.contains("uri")) return;
    const int size = component_bytes(accessor.component_type);
    const std::size_t begin = std::size_t(integer(view, "byteOffset", 0) + accessor.offset);
    for (std::int64_t i = 0; i < accessor.count; ++i) {
      std::int64_t value = 0;
      const std::size_t at = begin + std::size_t(i * accessor.stride);
      for (int b = 0; b < size; ++b) {
        value |= std::int64_t(container.bin[at + std::size_t(b)]) << (8 * b);
      }
      accessor.highest = std::max(accessor.highest, value);
    }
  }

  // ---- colour

  void check_images() {
    for (std::size_t i = 0; i < table_size("images"); ++i) {
      json& image = root_["images"][i];
      keep(image, {"uri", "mimeType", "bufferView"});
      reference(image, "bufferView", "bufferViews");
      if (image.contains("uri") && !image["uri"].is_string()) refuse("an image has no address");
      if (!image.contains("uri") && !image.contains("bufferView")) refuse("an image has no data");
      if (image.contains("uri") && image["uri"].get<std::string>().rfind("data:", 0) == 0) {
        const std::string uri = image["uri"].get<std::string>();
        const std::size_t comma = uri.find(',');
        if (comma == std::string::npos || uri.find("base64") > comma) {
          refuse("an embedded image is not base64");
        }
        check_base64(uri.substr(comma + 1));
      }
      if (!image.contains("mimeType") || !image["mimeType"].is_string()) image.erase("mimeType");
    }
    for (std::size_t i = 0; i < table_size("samplers"); ++i) {
      json& sampler = root_["samplers"][i];
      keep(sampler, {"wrapS", "wrapT"});
      for (const char* name : {"wrapS", "wrapT"}) {
        const std::int64_t wrap = integer(sampler, name, 10497);
        if (wrap != 10497 && wrap != 33071 && wrap != 33648) refuse("a texture wraps oddly");
      }
    }
    for (std::size_t i = 0; i < table_size("textures"); ++i) {
      json& texture = root_["textures"][i];
      keep(texture, {"sampler", "source"});
      reference(texture, "sampler", "samplers");
      if (reference(texture, "source", "images") < 0) {
        warn("A texture of the model has no PNG or JPEG image; its base colour is used.");
      }
    }
  }

  void check_materials() {
    for (std::size_t i = 0; i < table_size("materials"); ++i) {
      json& material = root_["materials"][i];
      keep(material, {"name", "pbrMetallicRoughness", "alphaMode", "alphaCutoff"});
      if (material.contains("alphaMode") && !material["alphaMode"].is_string()) {
        refuse("a material's alphaMode is not text");
      }
      if (material.contains("alphaCutoff") && !material["alphaCutoff"].is_number()) {
        refuse("a material's alphaCutoff is not a number");
      }
      const auto pbr = material.find("pbrMetallicRoughness");
      if (pbr == material.end()) continue;
      if (!pbr->is_object()) refuse("a material is damaged");
      keep(*pbr, {"baseColorFactor", "baseColorTexture"});
      numbers(*pbr, "baseColorFactor", 4);
      const auto texture = pbr->find("baseColorTexture");
      if (texture != pbr->end()) check_texture_use(*texture);
    }
  }

  void check_texture_use(json& use) {
    if (!use.is_object()) refuse("a material's texture is damaged");
    keep(use, {"index", "texCoord", "extensions"});
    reference(use, "index", "textures", true);
    const std::int64_t channel = integer(use, "texCoord", 0);
    if (channel < 0 || channel > 7) refuse("a texture uses an unknown set of coordinates");
    const auto extensions = use.find("extensions");
    if (extensions == use.end()) return;
    keep(*extensions, {"KHR_texture_transform"});
    const auto transform = extensions->find("KHR_texture_transform");
    if (!extensions->is_object() || transform == extensions->end() || !transform->is_object()) {
      use.erase("extensions");
      return;
    }
    keep(*transform, {"offset", "rotation", "scale", "texCoord"});
    numbers(*transform, "offset", 2);
    numbers(*transform, "scale", 2);
    if (transform->contains("rotation") && !(*transform)["rotation"].is_number()) {
      refuse("a texture's rotation is not a number");
    }
    const std::int64_t other = integer(*transform, "texCoord", channel);
    if (other < 0 || other > 7) refuse("a texture uses an unknown set of coordinates");
    use["texCoord"] = other;
    transform->erase("texCoord");
  }

  // ---- shape

  const Accessor& attribute(const json& attributes, const char* name) const {
    const Accessor& accessor =
        accessors_[std::size_t(reference(attributes, name, "accessors", true))];
    if (!accessor.usable) refuse(fmt::format("a mesh's {} data is sparse or missing", name));
    return accessor;
  }

  void check_meshes() {
    for (std::size_t i = 0; i < table_size("meshes"); ++i) {
      json& mesh = root_["meshes"][i];
      keep(mesh, {"primitives"});
      if (!mesh.contains("primitives") || !mesh["primitives"].is_array()) {
        refuse("a mesh has no primitives");
      }
      std::int64_t corners = 0;
      for (json& primitive : mesh["primitives"]) corners += check_primitive(primitive);
      mesh_triangles_.push_back(corners);
    }
  }

  // Returns an upper bound on its triangles.
  std::int64_t check_primitive(json& primitive) {
    if (!primitive.is_object()) refuse("a primitive is damaged");
    keep(primitive, {"attributes", "indices", "material", "mode"});
    reference(primitive, "material", "materials");
    const std::int64_t mode = integer(primitive, "mode", 4);
    if (mode < 0 || mode > 6) refuse("a primitive has an unknown mode");
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object()) {
      refuse("a primitive has no attributes");
    }
    keep(*attributes,
         {"POSITION", "COLOR_0", "TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"});
    if (!attributes->contains("POSITION")) refuse("a primitive has no positions");
    const Accessor& position = attribute(*attributes, "POSITION");
    if (position.components != 3) refuse("a primitive's positions are not points");
    for (const auto& [name, index] : attributes->items()) {
      const Accessor& accessor = attribute(*attributes, name.c_str());
      const bool fits = name == "POSITION"          ? true
                        : name.rfind("TEX", 0) == 0 ? accessor.components == 2
                                                    : accessor.components >= 3;
      // assimp takes quantised data for floats.
      if (name[0] != 'C' && accessor.component_type != 5126) {
        refuse(fmt::format("a mesh's {} data is quantised, which is not supported", name));
      }
      if (accessor.count != position.count || !fits) {
        refuse(fmt::format("a mesh's {} data does not match its positions", name));
      }
    }
    if (!primitive.contains("indices")) return position.count;
    const Accessor& indices = attribute(primitive, "indices");
    if (indices.components != 1 ||
        (indices.component_type != 5121 && indices.component_type != 5123 &&
         indices.component_type != 5125)) {
      refuse("a mesh's indices are not whole numbers");
    }
    if (indices.highest >= position.count) {
      refuse(fmt::format("a face refers to vertex {}, but the mesh has vertices 0 to {}",
                         indices.highest, position.count - 1));
    }
    return indices.count;
  }

  void check_nodes() {
    const std::size_t count = table_size("nodes");
    for (std::size_t i = 0; i < count; ++i) {
      json& node = root_["nodes"][i];
      keep(node, {"children", "mesh", "matrix", "translation", "rotation", "scale"});
      reference(node, "mesh", "meshes");
      numbers(node, "matrix", 16);
      numbers(node, "translation", 3);
      numbers(node, "rotation", 4);
      numbers(node, "scale", 3);
      check_list(node, "children");
    }
    for (std::size_t i = 0; i < table_size("scenes"); ++i) {
      keep(root_["scenes"][i], {"nodes"});
      check_list(root_["scenes"][i], "nodes");
    }
    reference(root_, "scene", "scenes");
    if (table_size("scenes") == 0) refuse("it has no scene");
    const json& scene =
        root_["scenes"][std::size_t(std::max<std::int64_t>(integer(root_, "scene", 0), 0))];
    if (!scene.contains("nodes")) refuse("its scene is empty");
    std::int64_t placed = 0, visits = 0;
    for (const json& node : scene["nodes"]) visit(node.get<std::size_t>(), 0, visits, placed);
    // The other scenes are not shown, but must not trap the reader either.
    root_["scenes"] = json::array({scene});
    root_["scene"] = 0;
  }

  void check_list(json& owner, const char* name) const {
    const auto it = owner.find(name);
    if (it == owner.end()) return;
    if (!it->is_array()) refuse(fmt::format("'{}' is not a list", name));
    for (const json& index : *it) {
      if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= table_size("nodes")) {
        refuse(fmt::format("'{}' refers to a node that does not exist", name));
      }
    }
    if (it->empty()) owner.erase(it);
  }

  // Nodes form trees: a cycle or a fan of shared children would never end.
  void visit(std::size_t index, int depth, std::int64_t& visits, std::int64_t& placed) const {
    if (depth > kMaxDepth || ++visits > std::int64_t(table_size("nodes"))) {
      refuse("its nodes form a loop");
    }
    const json& node = root_["nodes"][index];
    if (node.contains("mesh")) placed += mesh_triangles_[node["mesh"].get<std::size_t>()];
    if (placed > kMaxPlaced) refuse("it has too many triangles");
    if (!node.contains("children")) return;
    for (const json& child : node["children"]) {
      visit(child.get<std::size_t>(), depth + 1, visits, placed);
    }
  }

  void warn(const std::string& sentence) { warnings_.push_back(sentence); }

  // ---- writing

  FileBytes plain() const {
    const std::string text = root_.dump(-1, ' ', true, json::error_handler_t::replace);
    return {text.begin(), text.end()};
  }

  FileBytes pack(Container& container) const {
    FileBytes text = plain();
    while (text.size() % 4 != 0) text.push_back(' ');
    while (container.bin.size() % 4 != 0) container.bin.push_back(0);
    FileBytes out;
    const std::size_t bin_size = container.has_bin ? 8 + container.bin.size() : 0;
    append32(out, kGlbMagic);
    append32(out, 2);
    append32(out, std::uint32_t(20 + text.size() + bin_size));
    append32(out, std::uint32_t(text.size()));
    append32(out, kJsonChunk);
    out.insert(out.end(), text.begin(), text.end());
    if (container.has_bin) {
      append32(out, std::uint32_t(container.bin.size()));
      append32(out, kBinChunk);
      out.insert(out.end(), container.bin.begin(), container.bin.end());
    }
    return out;
  }

  const std::string& path_;
  SideFiles& side_files_;
  json root_;
  std::vector<std::int64_t> buffer_length_;
  std::vector<Accessor> accessors_;
  std::vector<std::int64_t> mesh_triangles_;
  std::vector<std::string> warnings_;
};

}  // namespace

CheckedFile check_gltf(const std::string& path, FileBytes bytes, SideFiles& side_files) {
  return GltfCheck(path, side_files).run(bytes);
}

}  // namespace hydrodip
