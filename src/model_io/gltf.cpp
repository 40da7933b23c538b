// glTF 2.0 and GLB: shapes and base colours; animations, skins and lights are left out.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "model_io/draco_mesh.h"
#include "model_io/gltf_data.h"
#include "model_io/model_file.h"

namespace hydrodip {

namespace {

using Eigen::Matrix4f;
using nlohmann::json;

constexpr int kMaxDepth = 128;  // of nodes

// Extensions that a file may require: those that are read, and those that change neither shape nor
// base colour.
bool tolerated(const std::string& name) {
  static constexpr const char* kNames[] = {"KHR_texture_transform",
                                           "KHR_mesh_quantization",
                                           "KHR_draco_mesh_compression",
                                           "EXT_meshopt_compression",
                                           "KHR_meshopt_compression",
                                           "EXT_texture_webp",
                                           "EXT_mesh_gpu_instancing",
                                           "KHR_texture_basisu",
                                           "KHR_lights_punctual",
                                           "EXT_lights_image_based",
                                           "EXT_lights_ies",
                                           "KHR_animation_pointer",
                                           "KHR_xmp",
                                           "KHR_xmp_json_ld",
                                           "KHR_audio_emitter",
                                           "MSFT_texture_dds",
                                           "EXT_texture_avif",
                                           "EXT_mesh_features",
                                           "EXT_structural_metadata",
                                           "EXT_instance_features",
                                           "KHR_node_visibility",
                                           "KHR_node_hoverability",
                                           "KHR_node_selectability",
                                           "KHR_interactivity",
                                           "CESIUM_RTC",
                                           "CESIUM_primitive_outline",
                                           "EXT_primitive_voxels",
                                           "FB_geometry_metadata",
                                           "AGI_articulations",
                                           "AGI_stk_metadata"};
  return name.starts_with("KHR_materials_") || name.starts_with("EXT_materials_") ||
         name.starts_with("ADOBE_materials_") ||
         std::any_of(std::begin(kNames), std::end(kNames),
                     [&](const char* known) { return name == known; });
}

float unit(float value) { return std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 1; }

// The numbers of a mesh's part, whichever way they are stored.
class Attribute {
 public:
  Attribute() = default;
  explicit Attribute(GltfNumbers numbers)
      : count_(numbers.count), components_(numbers.components), numbers_(std::move(numbers)) {}
  Attribute(const DracoMesh::Attribute& values, std::int64_t count)
      : count_(count), components_(values.components), values_(&values) {}

  explicit operator bool() const { return count_ > 0; }
  std::int64_t count() const { return count_; }
  int components() const { return components_; }
  void get(std::int64_t i, float* out) const {
    if (values_) {
      std::copy_n(values_->values.begin() + i * components_, components_, out);
    } else {
      numbers_.get(i, out);
    }
  }

 private:
  std::int64_t count_ = 0;
  int components_ = 0;
  GltfNumbers numbers_;
  const DracoMesh::Attribute* values_ = nullptr;
};

class GltfReader {
 public:
  explicit GltfReader(const ModelInput& input)
      : input_(input), data_(input), cancel_(input.context) {}

  ModelFile run() {
    check_extensions();
    file_.y_up = true;
    file_.units = "meter";
    read_materials();
    corners_left_ = most_corners();
    visits_left_ = std::int64_t(data_.table_size("nodes"));
    for (const std::int64_t root : roots()) visit(root, Matrix4f::Identity(), 0);
    if (file_.face_end.empty()) data_.refuse("it has no triangles");
    tell_of_poses();
    return std::move(file_);
  }

 private:
  // Copies of a mesh cost a few bytes each. A byte of a strip stands for three corners, one of
  // compressed data for many.
  std::int64_t most_corners() const {
    constexpr std::int64_t kAlways = 1'500'000;
    return kAlways + (data_.is_compressed() ? 30 : 3) * std::int64_t(data_.buffer_bytes());
  }

  void check_extensions() const {
    const auto required = data_.root().find("extensionsRequired");
    if (required == data_.root().end() || !required->is_array()) return;
    for (const json& name : *required) {
      const std::string text = name.is_string() ? name.get<std::string>() : "?";
      if (!tolerated(text))
        data_.refuse(
            fmt::format("it needs the glTF extension {}, which is not supported", shown(text)));
    }
  }

  // ---- colour

  void read_materials() {
    for (std::size_t i = 0; i < data_.table_size("materials"); ++i) {
      cancel_();
      read_material(data_.entry("materials", std::int64_t(i)));
    }
  }

  void read_material(const json& source) {
    FileMaterial material;
    const auto name = source.find("name");
    if (name != source.end() && name->is_string())
      material.name = name->get<std::string>().substr(0, 200);
    read_alpha(source, material);
    const json* old = data_.extension(source, "KHR_materials_pbrSpecularGlossiness");
    const json* base = old ? old : data_.object(source, "pbrMetallicRoughness");
    int channel = 0;
    if (base) {
      std::array<float, 4> factor{1, 1, 1, 1};
      data_.numbers(*base, old ? "diffuseFactor" : "baseColorFactor", factor);
      material.base_color = {unit(factor[0]), unit(factor[1]), unit(factor[2]), unit(factor[3])};
      if (material.alpha == Alpha::kOpaque) material.base_color.a = 1;
      material.texture_tint = material.base_color;
      const json* texture = data_.object(*base, old ? "diffuseTexture" : "baseColorTexture");
      if (texture) channel = read_texture(*texture, material);
    }
    if (material.alpha == Alpha::kMask) decide_alpha(material);
    channels_.push_back(channel);
    file_.materials.push_back(std::move(material));
  }

  // Factor times picture is compared with the cutoff, and then shown in full or not at all.
  static void decide_alpha(FileMaterial& material) {
    constexpr float kNever = 2;
    const float factor = material.base_color.a, cutoff = material.alpha_cutoff;
    material.base_color.a = factor >= cutoff ? 1.0F : 0.0F;
    material.texture_tint.a = 1;
    if (cutoff > 0) material.alpha_cutoff = factor > 0 ? cutoff / factor : kNever;
  }

  void read_alpha(const json& source, FileMaterial& material) const {
    const auto mode = source.find("alphaMode");
    if (mode != source.end() && !mode->is_string())
      data_.refuse("a material's alphaMode is not text");
    const std::string text = mode == source.end() ? "OPAQUE" : mode->get<std::string>();
    material.alpha = text == "BLEND"  ? Alpha::kBlend
                     : text == "MASK" ? Alpha::kMask
                                      : Alpha::kOpaque;
    const auto cutoff = source.find("alphaCutoff");
    if (cutoff == source.end()) return;
    if (!cutoff->is_number()) data_.refuse("a material's alphaCutoff is not a number");
    material.alpha_cutoff = unit(cutoff->get<float>());
  }

  // Returns the set of coordinates.
  int read_texture(const json& use, FileMaterial& material) {
    const std::int64_t index = data_.reference(use, "index", "textures");
    if (index < 0) data_.refuse("a material's texture is damaged");
    const json& texture = data_.entry("textures", index);
    material.picture = picture_of(texture);
    const std::int64_t sampler = data_.reference(texture, "sampler", "samplers");
    if (sampler >= 0) {
      material.wrap_u = wrap(data_.entry("samplers", sampler), "wrapS");
      material.wrap_v = wrap(data_.entry("samplers", sampler), "wrapT");
    }
    std::int64_t channel = data_.integer(use, "texCoord", 0);
    if (const json* transform = data_.extension(use, "KHR_texture_transform")) {
      channel = data_.integer(*transform, "texCoord", channel);
      read_transform(*transform, material);
    }
    if (channel < 0 || channel > 7) data_.refuse("a texture uses an unknown set of coordinates");
    return int(channel);
  }

  Wrap wrap(const json& sampler, const char* name) const {
    switch (data_.integer(sampler, name, 10497)) {
      case 10497:
        return Wrap::kRepeat;
      case 33071:
        return Wrap::kClamp;
      case 33648:
        return Wrap::kMirror;
      default:
        data_.refuse("a texture wraps oddly");
    }
  }

  // For v up: (u, v) -> glTF's (u, 1 - v) -> scaled, turned, moved -> back.
  void read_transform(const json& source, FileMaterial& material) const {
    std::array<float, 2> offset{0, 0}, scale{1, 1};
    data_.numbers(source, "offset", offset);
    data_.numbers(source, "scale", scale);
    const auto rotation = source.find("rotation");
    if (rotation != source.end() && !rotation->is_number())
      data_.refuse("a texture's rotation is not a number");
    const double angle = rotation == source.end() ? 0 : rotation->get<double>();
    if (!std::isfinite(angle)) data_.refuse("a texture's rotation is not a number");
    const double c = std::cos(angle), s = std::sin(angle);
    const double sx = scale[0], sy = scale[1], ox = offset[0], oy = offset[1];
    // glTF, v down: u' = c sx u + s sy v + ox, v' = -s sx u + c sy v + oy.
    material.transformed = true;
    material.transform << float(c * sx), float(-s * sy), float(s * sy + ox), float(s * sx),
        float(c * sy), float(1 - c * sy - oy);
  }

  // WebP where there is one; what cannot be read only if there is nothing else.
  std::int32_t picture_of(const json& texture) {
    if (const json* webp = data_.extension(texture, "EXT_texture_webp"))
      return picture(data_.reference(*webp, "source", "images"));
    const std::int64_t source = data_.reference(texture, "source", "images");
    if (source >= 0) return picture(source);
    for (const auto& [name, kind] : {std::pair{"KHR_texture_basisu", "KTX2 (Basis Universal)"},
                                     {"EXT_texture_avif", "AVIF"},
                                     {"MSFT_texture_dds", "DDS"}}) {
      if (!data_.extension(texture, name)) continue;
      throw InputError(fmt::format(
          "{}: its textures are {} pictures, which are not read; export the model with PNG, JPEG "
          "or WebP textures (without texture compression).",
          input_.path, kind));
    }
    FilePicture none;
    none.embedded = true;
    none.problem = fmt::format("A texture of {} names no picture.", input_.name);
    file_.pictures.push_back(none);
    return std::int32_t(file_.pictures.size()) - 1;
  }

  std::int32_t picture(std::int64_t index) {
    if (index < 0) data_.refuse("a texture has no image");
    picture_index_.resize(data_.table_size("images"), -1);
    std::int32_t& known = picture_index_[std::size_t(index)];
    if (known >= 0) return known;
    const json& image = data_.entry("images", index);
    FilePicture out;
    out.asked_by = input_.name;
    const std::int64_t view = data_.reference(image, "bufferView", "bufferViews");
    const auto uri = image.find("uri");
    if (uri != image.end() && !uri->is_string()) data_.refuse("an image has no address");
    if (view < 0 && uri == image.end()) data_.refuse("an image has no data");
    out.embedded = view >= 0 || uri->get_ref<const std::string&>().starts_with("data:");
    if (view >= 0) {
      const auto bytes = data_.view(view);
      out.bytes.assign(bytes.begin(), bytes.end());
    } else if (out.embedded) {
      out.bytes = data_.data_uri(uri->get_ref<const std::string&>());
    } else {
      out.name = uri->get<std::string>();
    }
    if (out.embedded) out.name = fmt::format("{}, embedded texture {}", input_.name, index);
    file_.pictures.push_back(std::move(out));
    return known = std::int32_t(file_.pictures.size()) - 1;
  }

  // ---- nodes

  // The scene's nodes; without any scene, those that are nobody's children.
  std::vector<std::int64_t> roots() const {
    const std::int64_t scene = data_.reference(data_.root(), "scene", "scenes");
    if (data_.table_size("scenes") > 0)
      return list(data_.entry("scenes", std::max<std::int64_t>(scene, 0)), "nodes");
    std::vector<char> is_child(data_.table_size("nodes"), 0);
    for (std::size_t i = 0; i < is_child.size(); ++i)
      for (const std::int64_t child : list(data_.entry("nodes", std::int64_t(i)), "children"))
        is_child[std::size_t(child)] = 1;
    std::vector<std::int64_t> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) roots.push_back(std::int64_t(i));
    return roots;
  }

  std::vector<std::int64_t> list(const json& owner, const char* name) const {
    std::vector<std::int64_t> out;
    const auto it = owner.find(name);
    if (it == owner.end()) return out;
    if (!it->is_array()) data_.refuse(fmt::format("'{}' is not a list", name));
    for (const json& index : *it) {
      if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= data_.table_size("nodes"))
        data_.refuse(fmt::format("'{}' refers to a node that does not exist", name));
      out.push_back(index.get<std::int64_t>());
    }
    return out;
  }

  // Nodes form trees: a cycle or a fan of shared children would never end.
  void visit(std::int64_t index, const Matrix4f& parent, int depth) {
    if (depth > kMaxDepth || --visits_left_ < 0) data_.refuse("its nodes form a loop");
    cancel_();
    const json& node = data_.entry("nodes", index);
    const Matrix4f world = parent * local(node);
    const std::int64_t mesh = data_.reference(node, "mesh", "meshes");
    if (mesh >= 0) {
      has_skin_ = has_skin_ || node.contains("skin");
      has_morphs_ = has_morphs_ || morphs(node) || morphs(data_.entry("meshes", mesh));
      for (const Matrix4f& instance : instances(node)) {
        spend_triangle();
        add_mesh(mesh, world * instance);
      }
    }
    for (const std::int64_t child : list(node, "children")) visit(child, world, depth + 1);
  }

  // Whether a node or a mesh is shown with some of its other shapes mixed in.
  static bool morphs(const json& owner) {
    const auto weights = owner.find("weights");
    return weights != owner.end() && weights->is_array() &&
           std::any_of(weights->begin(), weights->end(), [](const json& weight) {
             return weight.is_number() && weight.get<double>() != 0;
           });
  }

  void tell_of_poses() const {
    if (!has_skin_ && !has_morphs_) return;
    input_.context.warn(fmt::format(
        "{} poses its mesh by {}, which is not read: the mesh is taken as it is stored. To dip it "
        "as it is posed, apply that in the program that made it and export it again.",
        input_.name,
        !has_morphs_ ? "a skeleton"
        : !has_skin_ ? "shape keys (morph targets)"
                     : "a skeleton and shape keys (morph targets)"));
  }

  Matrix4f local(const json& node) const {
    std::array<float, 16> m{};
    if (data_.numbers(node, "matrix", m)) return Eigen::Map<const Matrix4f>(m.data());
    std::array<float, 3> translation{0, 0, 0}, scale{1, 1, 1};
    std::array<float, 4> rotation{0, 0, 0, 1};
    data_.numbers(node, "translation", translation);
    data_.numbers(node, "rotation", rotation);
    data_.numbers(node, "scale", scale);
    return placed(translation, rotation, scale);
  }

  static Matrix4f placed(const std::array<float, 3>& t, const std::array<float, 4>& q,
                         const std::array<float, 3>& s) {
    const float x = q[0], y = q[1], z = q[2], w = q[3];
    Matrix4f m = Matrix4f::Identity();
    m(0, 0) = 1 - 2 * (y * y + z * z);
    m(0, 1) = 2 * (x * y - z * w);
    m(0, 2) = 2 * (x * z + y * w);
    m(1, 0) = 2 * (x * y + z * w);
    m(1, 1) = 1 - 2 * (x * x + z * z);
    m(1, 2) = 2 * (y * z - x * w);
    m(2, 0) = 2 * (x * z - y * w);
    m(2, 1) = 2 * (y * z + x * w);
    m(2, 2) = 1 - 2 * (x * x + y * y);
    for (int c = 0; c < 3; ++c) {
      m.col(c) *= s[std::size_t(c)];
      m(c, 3) = t[std::size_t(c)];
    }
    return m;
  }

  // Copies of the node's mesh, each placed; one in its own place for most.
  std::vector<Matrix4f> instances(const json& node) {
    const json* instancing = data_.extension(node, "EXT_mesh_gpu_instancing");
    const json* attributes = instancing ? data_.object(*instancing, "attributes") : nullptr;
    if (!attributes) return {Matrix4f::Identity()};
    std::int64_t count = -1;
    const auto part = [&](const char* name, int components) -> std::optional<GltfNumbers> {
      const std::int64_t index = data_.reference(*attributes, name, "accessors");
      if (index < 0) return {};
      GltfNumbers numbers = data_.accessor(index);
      if (numbers.components != components || (count >= 0 && numbers.count != count) ||
          numbers.count > std::int64_t(data_.buffer_bytes()))
        data_.refuse("a mesh's copies are damaged");
      count = numbers.count;
      return numbers;
    };
    const auto translations = part("TRANSLATION", 3), rotations = part("ROTATION", 4),
               scales = part("SCALE", 3);
    std::vector<Matrix4f> out;
    for (std::int64_t i = 0; i < count; ++i) {
      cancel_();
      std::array<float, 3> t{0, 0, 0}, s{1, 1, 1};
      std::array<float, 4> q{0, 0, 0, 1};
      if (translations) translations->get(i, t.data());
      if (rotations) rotations->get(i, q.data());
      if (scales) scales->get(i, s.data());
      out.push_back(placed(t, q, s));
    }
    if (count < 0) out.push_back(Matrix4f::Identity());
    return out;
  }

  // ---- shape

  void add_mesh(std::int64_t index, const Matrix4f& world) {
    const json& mesh = data_.entry("meshes", index);
    const auto primitives = mesh.find("primitives");
    if (primitives == mesh.end() || !primitives->is_array())
      data_.refuse("a mesh has no primitives");
    for (const json& primitive : *primitives) {
      if (!primitive.is_object()) data_.refuse("a primitive is damaged");
      spend_triangle();
      add_primitive(primitive, world);
    }
  }

  struct Part {
    Attribute positions, uvs, colors;
    std::int32_t material = -1;
    bool opaque = true;  // vertices' alpha does not count
    bool mirrored = false;
    Mat3 linear;
    Vec3 offset;
  };

  void add_primitive(const json& primitive, const Matrix4f& world) {
    const std::int64_t mode = data_.integer(primitive, "mode", 4);
    if (mode < 0 || mode > 6) data_.refuse("a primitive has an unknown mode");
    if (mode < 4) return;  // points and lines
    const json* attributes = data_.object(primitive, "attributes");
    if (!attributes || !attributes->contains("POSITION"))
      data_.refuse("a primitive has no positions");
    Part part;
    part.material = std::int32_t(data_.reference(primitive, "material", "materials"));
    int channel = 0;
    if (part.material >= 0) {
      part.opaque = file_.materials[std::size_t(part.material)].alpha == Alpha::kOpaque;
      channel = channels_[std::size_t(part.material)];
    }
    std::string set = fmt::format("TEXCOORD_{}", channel);
    if (!attributes->contains(set)) set = "TEXCOORD_0";
    part.linear = world.topLeftCorner<3, 3>().cast<double>();
    part.offset = world.topRightCorner<3, 1>().cast<double>();
    part.mirrored = world.determinant() < 0;
    ++stamp_;
    const json* compressed = data_.extension(primitive, "KHR_draco_mesh_compression");
    if (compressed) {
      add_draco(*compressed, *attributes, set, part);
    } else {
      part.positions = attribute(*attributes, "POSITION");
      part.uvs = attribute(*attributes, set.c_str());
      part.colors = attribute(*attributes, "COLOR_0");
      check(part);
      add_plain(primitive, mode, part);
    }
  }

  Attribute attribute(const json& attributes, const char* name) {
    const std::int64_t index = data_.reference(attributes, name, "accessors");
    return index < 0 ? Attribute() : Attribute(data_.accessor(index));
  }

  void check(const Part& part) const {
    const auto fits = [&](const Attribute& attribute, int least, int most) {
      return !attribute || (attribute.count() == part.positions.count() &&
                            attribute.components() >= least && attribute.components() <= most);
    };
    if (!part.positions || !fits(part.positions, 3, 3))
      data_.refuse("a primitive's positions are not points");
    if (!fits(part.uvs, 2, 2) || !fits(part.colors, 3, 4))
      data_.refuse("a mesh's texture coordinates or colours do not match its positions");
  }

  void add_plain(const json& primitive, std::int64_t mode, const Part& part) {
    const std::int64_t index = data_.reference(primitive, "indices", "accessors");
    const std::int64_t vertices = part.positions.count();
    std::optional<GltfNumbers> indices;
    if (index >= 0) {
      indices = data_.accessor(index);
      if (indices->components != 1 || indices->floating)
        data_.refuse("a mesh's indices are not whole numbers");
    }
    const std::int64_t count = indices ? indices->count : vertices;
    const auto at = [&](std::int64_t i) {
      const std::int64_t vertex = indices ? std::int64_t(indices->index(i)) : i;
      if (vertex < vertices) return vertex;
      data_.refuse(fmt::format("a face refers to vertex {}, but the mesh has vertices 0 to {}",
                               vertex, vertices - 1));
    };
    if (mode == 4) {
      for (std::int64_t i = 0; i + 2 < count; i += 3)
        add_triangle(part, {at(i), at(i + 1), at(i + 2)});
    } else {
      const bool fan = mode == 6;
      for (std::int64_t i = 0; i + 2 < count; ++i) {
        const std::int64_t odd = fan ? 0 : i % 2;
        add_triangle(part, {at(fan ? 0 : i), at(i + 1 + odd), at(i + 2 - odd)});
      }
    }
  }

  void add_draco(const json& compressed, const json& attributes, const std::string& set,
                 Part& part) {
    // Copies of a mesh ask again.
    const auto [known, is_new] = decoded_.try_emplace({&compressed, set});
    if (is_new) known->second = decoded(compressed, attributes, set);
    const DracoMesh& mesh = known->second;
    const auto attribute = [&](std::size_t i) {
      const DracoMesh::Attribute& values = mesh.attributes[i];
      return values.values.empty() ? Attribute() : Attribute(values, mesh.points);
    };
    part.positions = attribute(0);
    part.uvs = attribute(1);
    part.colors = attribute(2);
    check(part);
    for (const auto& face : mesh.faces) add_triangle(part, {face[0], face[1], face[2]});
  }

  bool is_normalized(const json& attributes, const char* name) const {
    const std::int64_t index = data_.reference(attributes, name, "accessors");
    if (index < 0) return false;
    const json& accessor = data_.entry("accessors", index);
    const auto flag = accessor.find("normalized");
    return flag != accessor.end() && flag->is_boolean() && flag->get<bool>();
  }

  DracoMesh decoded(const json& compressed, const json& attributes, const std::string& set) {
    const json* ids = data_.object(compressed, "attributes");
    const std::int64_t view = data_.reference(compressed, "bufferView", "bufferViews");
    if (!ids || view < 0) data_.refuse("a mesh compressed by Draco is damaged");
    std::vector<DracoWanted> wanted;
    for (const char* name : {"POSITION", set.c_str(), "COLOR_0"})
      wanted.push_back({std::uint32_t(std::clamp<std::int64_t>(
                            data_.integer(*ids, name, 0xffffffff), 0, 0xffffffff)),
                        is_normalized(attributes, name)});
    try {
      return decode_draco(data_.view(view), wanted);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      throw InputError(fmt::format(
          "{}: a mesh compressed by Draco cannot be read ({}); export it without compression.",
          input_.path, error.what()));
    }
  }

  // Parts and copies without any cost as much as a triangle, or a small file could ask for
  // billions.
  void spend_triangle() {
    cancel_();
    if ((corners_left_ -= 3) < 0)
      throw InputError(fmt::format(
          "{}: its parts and their copies come to too many triangles; simplify the model.",
          input_.path));
  }

  void add_triangle(const Part& part, std::array<std::int64_t, 3> corners) {
    spend_triangle();
    if (part.mirrored) std::swap(corners[1], corners[2]);
    for (const std::int64_t corner : corners) {
      file_.corners.push_back(vertex(part, corner));
      add_uv(part, corner);
      add_color(part, corner);
    }
    check_count(input_.path, file_.corners.size());
    file_.end_face(part.material);
  }

  // A part's vertex among the file's: those that no triangle uses take no place.
  std::int32_t vertex(const Part& part, std::int64_t number) {
    const auto at = std::size_t(number);
    if (at >= used_.size()) used_.resize(std::max(at + 1, 2 * used_.size()));
    if (used_[at].stamp != stamp_) {
      std::array<float, 4> p{};
      part.positions.get(number, p.data());
      used_[at] = {stamp_, std::int32_t(file_.positions.size())};
      file_.positions.push_back(part.linear * Vec3(p[0], p[1], p[2]) + part.offset);
    }
    return used_[at].index;
  }

  // From the first part on that has any.
  void add_uv(const Part& part, std::int64_t corner) {
    if (part.uvs) has_uvs_ = true;
    if (!has_uvs_) return;
    file_.uvs.resize(file_.corners.size() - 1, {ModelFile::kNoUv, 0});
    std::array<float, 4> uv{ModelFile::kNoUv, 0};
    if (part.uvs) {
      part.uvs.get(corner, uv.data());
      uv[1] = 1 - uv[1];
    }
    file_.uvs.emplace_back(uv[0], uv[1]);
  }

  // From the first part on that has any. Linear already. An opaque material's alpha is 1, whatever
  // its vertices say.
  void add_color(const Part& part, std::int64_t corner) {
    if (part.colors) has_colors_ = true;
    if (!has_colors_) return;
    file_.colors.resize(file_.corners.size() - 1, {1, 1, 1, 1});
    std::array<float, 4> c{1, 1, 1, 1};
    if (part.colors) part.colors.get(corner, c.data());
    file_.colors.push_back({unit(c[0]), unit(c[1]), unit(c[2]), part.opaque ? 1 : unit(c[3])});
  }

  struct Used {
    std::uint32_t stamp = 0;
    std::int32_t index = 0;
  };

  const ModelInput& input_;
  std::map<std::pair<const json*, std::string>, DracoMesh> decoded_;
  GltfData data_;
  CancelCheck cancel_;
  ModelFile file_;
  std::vector<int> channels_;  // per material
  std::vector<std::int32_t> picture_index_;
  std::int64_t corners_left_ = 0, visits_left_ = 0;
  std::vector<Used> used_;
  std::uint32_t stamp_ = 0;
  bool has_uvs_ = false, has_colors_ = false;
  bool has_skin_ = false, has_morphs_ = false;
};

}  // namespace

ModelFile read_gltf(const ModelInput& input) { return GltfReader(input).run(); }

}  // namespace hydrodip
