#include "model_io/load.h"

#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/DefaultIOSystem.h>
#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>

#include "base/error.h"
#include "base/file.h"
#include "image/files.h"
#include "model_io/file_checks.h"
#include "object/polygon.h"

// Debian builds assimp with its assertions on, and they abort the process. They are reached through
// this exported function; the linker prefers ours, so a damaged file becomes an error like others.
namespace Assimp {
void aiAssertViolation(const char* failed_expression, const char* file, int line);
void aiAssertViolation(const char* failed_expression, const char* file, int line) {
  throw std::runtime_error(fmt::format("{} in {}:{}", failed_expression, file, line));
}
}  // namespace Assimp

namespace hydrodip {

namespace {

namespace fs = std::filesystem;

enum class Format { kObj, kPly, kStl, kOff, k3mf, kGltf };

struct FormatName {
  const char* extension;
  Format format;
};

constexpr FormatName kFormats[] = {
    {".obj", Format::kObj},  {".ply", Format::kPly}, {".stl", Format::kStl},
    {".off", Format::kOff},  {".3mf", Format::k3mf}, {".gltf", Format::kGltf},
    {".glb", Format::kGltf},
};

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return extension;
}

Format format_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  for (const FormatName& known : kFormats) {
    if (extension == known.extension) return known.format;
  }
  throw InputError(
      fmt::format("{}: unknown kind of model file '{}'; give OBJ, PLY, STL, OFF, 3MF, glTF or GLB.",
                  path.string(), extension));
}

// ---- units --------------------------------------------------------------------------------------

struct Unit {
  const char* name;
  double mm;
};

constexpr Unit kUnits[] = {{"mm", 1},         {"cm", 10},         {"m", 1000},     {"in", 25.4},
                           {"millimeter", 1}, {"centimeter", 10}, {"meter", 1000}, {"inch", 25.4},
                           {"foot", 304.8},   {"micron", 0.001}};
constexpr std::size_t kUnitsOnCommandLine = 4;

Unit unit_for(const std::string& asked, const std::string& in_file, Format format) {
  if (!asked.empty()) {
    for (std::size_t i = 0; i < kUnitsOnCommandLine; ++i) {
      if (asked == kUnits[i].name) return kUnits[i];
    }
    throw InputError(fmt::format("--units {}: not a known unit; use mm, cm, m or in.", asked));
  }
  for (const Unit& unit : kUnits) {
    if (in_file != unit.name) continue;
    // Short names where there are any: 3MF says "millimeter".
    for (const Unit& brief : kUnits) {
      if (brief.mm == unit.mm) return brief;
    }
  }
  return format == Format::kGltf ? kUnits[2] : kUnits[0];
}

// ---- files --------------------------------------------------------------------------------------

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string percent_decoded(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 &&
                        hex_digit(text[i + 2]) >= 0;
    out += escape ? char(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2])) : text[i];
    if (escape) i += 2;
  }
  return out;
}

// Files named inside a model, found beside it, and remembered for the report.
class ModelFolder : public SideFiles {
 public:
  explicit ModelFolder(const fs::path& model) : folder_(model.parent_path()) {}

  // Empty if there is no such file. Tries the name as it stands, with a Windows exporter's
  // backslashes turned, percent escapes decoded, and last the bare file name beside the model.
  fs::path find(const std::string& name) const {
    std::string forward = name;
    std::replace(forward.begin(), forward.end(), '\\', '/');
    const fs::path plain(forward), decoded(percent_decoded(forward));
    for (const fs::path& candidate : {folder_ / name, folder_ / plain, folder_ / decoded,
                                      folder_ / plain.filename(), folder_ / decoded.filename()}) {
      std::error_code ignored;
      if (candidate.has_filename() && fs::is_regular_file(candidate, ignored)) return candidate;
    }
    return {};
  }

  std::int64_t size(const std::string& name) override {
    const fs::path found = find(name);
    std::error_code error;
    const auto bytes = found.empty() ? 0 : fs::file_size(found, error);
    return found.empty() || error ? -1 : std::int64_t(bytes);
  }

  FileBytes read(const fs::path& path) {
    FileBytes bytes = read_file(path);
    if (std::find(files_.begin(), files_.end(), path) == files_.end()) files_.push_back(path);
    return bytes;
  }

  const std::vector<fs::path>& files() const { return files_; }

 private:
  fs::path folder_;
  std::vector<fs::path> files_;
};

class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(FileBytes bytes) : bytes_(std::move(bytes)) {}

  std::size_t Read(void* out, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    if (whole > 0) std::memcpy(out, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t base = origin == aiOrigin_SET   ? 0
                             : origin == aiOrigin_CUR ? at_
                                                      : bytes_.size();
    // "From the end" counts backwards in assimp.
    const std::size_t target = origin == aiOrigin_END ? base - offset : base + offset;
    if (target > bytes_.size()) return aiReturn_FAILURE;
    at_ = target;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  FileBytes bytes_;
  std::size_t at_ = 0;
};

// Serves the checked model from memory under its own name, and other files from its folder.
class CheckedFiles : public Assimp::IOSystem {
 public:
  CheckedFiles(std::string name, const FileBytes& model, ModelFolder& folder)
      : name_(std::move(name)), model_(model), folder_(folder) {}

  bool Exists(const char* file) const override {
    return name_ == file || !folder_.find(relative(file)).empty();
  }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (std::strchr(mode, 'r') == nullptr) return nullptr;
    if (name_ == file) return new MemoryStream(model_);
    const fs::path found = folder_.find(relative(file));
    if (found.empty()) {
      missing_.push_back(relative(file));
      return nullptr;
    }
    try {
      FileBytes bytes = folder_.read(found);
      return new MemoryStream(lower_extension(name_) == ".obj" ? clean_mtl(bytes)
                                                               : std::move(bytes));
    } catch (const InputError&) {
      missing_.push_back(relative(file));
      return nullptr;
    }
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

  const std::vector<std::string>& missing() const { return missing_; }

 private:
  // assimp asks for "folder of the model/name".
  std::string relative(const std::string& file) const {
    const std::size_t slash = name_.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : name_.substr(0, slash + 1);
    return file.compare(0, folder.size(), folder) == 0 ? file.substr(folder.size()) : file;
  }

  std::string name_;
  const FileBytes& model_;
  ModelFolder& folder_;
  std::vector<std::string> missing_;
};

CheckedFile check(Format format, const std::string& path, FileBytes bytes, ModelFolder& folder) {
  if (bytes.empty()) {
    throw InputError(fmt::format("{}: the file is empty; export the model again.", path));
  }
  switch (format) {
    case Format::kObj:
      return check_obj(path, std::move(bytes));
    case Format::kPly:
      return check_ply(path, std::move(bytes));
    case Format::kStl:
      return check_stl(path, std::move(bytes));
    case Format::kOff:
      return check_off(path, bytes);
    case Format::k3mf:
      return check_3mf(path, std::move(bytes));
    case Format::kGltf:
      break;
  }
  return check_gltf(path, std::move(bytes), folder);
}

// ---- colour -------------------------------------------------------------------------------------

constexpr LinearColor kWhite{1, 1, 1, 1};

float finite_unit(float value) { return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 1; }

LinearColor linear_color(const aiColor4D& color, bool encoded) {
  LinearColor out{finite_unit(color.r), finite_unit(color.g), finite_unit(color.b),
                  finite_unit(color.a)};
  if (encoded) {
    out.r = srgb_to_linear(out.r);
    out.g = srgb_to_linear(out.g);
    out.b = srgb_to_linear(out.b);
  }
  return out;
}

Wrap wrap_of(int mode) {
  switch (mode) {
    case aiTextureMapMode_Clamp:
      return Wrap::kClamp;
    case aiTextureMapMode_Mirror:
      return Wrap::kMirror;
    case aiTextureMapMode_Decal:
      return Wrap::kDecal;
    default:
      return Wrap::kRepeat;
  }
}

// What glTF's alphaMode makes of an image's alpha.
enum class Alpha { kBlend, kOpaque, kMask };

std::shared_ptr<const Image> with_alpha(Image image, Alpha alpha, float cutoff) {
  if (alpha != Alpha::kBlend) {
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
      const bool shown = alpha == Alpha::kOpaque || float(image.rgba[i]) >= cutoff * 255;
      image.rgba[i] = shown ? 255 : 0;
    }
  }
  return std::make_shared<const Image>(std::move(image));
}

// A material and how its texture coordinates are found.
struct LoadedMaterial {
  int index = 0;        // into Object::materials
  int untextured = -1;  // the same without its texture, for meshes without coordinates
  unsigned channel = 0;
  bool transformed = false;
  Eigen::Matrix<float, 2, 3> transform;  // of (u, v, 1) with v up
};

class Materials {
 public:
  Materials(const aiScene& scene, Format format, ModelFolder& folder, bool read_textures,
            Object& object, RunContext& context)
      : scene_(scene),
        format_(format),
        folder_(folder),
        read_textures_(read_textures),
        has_mtl_(folder.files().size() > 1),
        object_(object),
        context_(context) {}

  const LoadedMaterial& get(unsigned index) {
    const auto known = loaded_.find(index);
    if (known != loaded_.end()) return known->second;
    return loaded_[index] = load(index);
  }

  // For triangles whose mesh has no texture coordinates.
  int without_texture(unsigned index) {
    LoadedMaterial& loaded = loaded_.at(index);
    const Material textured = object_.materials[std::size_t(loaded.index)];
    if (textured.texture < 0 && read_textures_) return loaded.index;
    if (loaded.untextured < 0) {
      loaded.untextured = int(object_.materials.size());
      object_.materials.push_back(textured);
      object_.materials.back().texture = -1;
      bare_.push_back(loaded.untextured);
    }
    return loaded.untextured;
  }

  // Materials made by without_texture.
  const std::vector<int>& bare() const { return bare_; }

 private:
  LoadedMaterial load(unsigned index) {
    LoadedMaterial loaded;
    loaded.index = int(object_.materials.size());
    Material material;
    if (index < scene_.mNumMaterials && scene_.mMaterials[index]) {
      fill(*scene_.mMaterials[index], material, loaded);
    }
    object_.materials.push_back(material);
    return loaded;
  }

  void fill(const aiMaterial& source, Material& material, LoadedMaterial& loaded) {
    aiString name;
    if (source.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) material.name = name.C_Str();
    const Alpha alpha = alpha_of(source);
    // STL, PLY and OFF have no materials; assimp makes up a grey one. 3MF's come as face colours.
    const bool made_up = (format_ != Format::kObj && format_ != Format::kGltf) ||
                         material.name == AI_DEFAULT_MATERIAL_NAME ||
                         (format_ == Format::kObj && !has_mtl_);
    if (!made_up) material.base_color = base_color(source, alpha);
    aiString texture;
    if (!read_textures_ ||
        source.GetTexture(aiTextureType_DIFFUSE, 0, &texture) != aiReturn_SUCCESS) {
      return;
    }
    float cutoff = 0.5f;
    source.Get("$mat.gltf.alphaCutoff", 0, 0, cutoff);
    material.texture = texture_index(texture.C_Str(), alpha, finite_unit(cutoff));
    if (material.texture < 0) return;
    if (format_ == Format::kObj) material.base_color = tint_of(material.base_color);
    placement(source, material, loaded);
  }

  Alpha alpha_of(const aiMaterial& source) const {
    if (format_ != Format::kGltf) return Alpha::kBlend;
    aiString mode;
    source.Get("$mat.gltf.alphaMode", 0, 0, mode);
    const std::string text = mode.C_Str();
    return text == "BLEND" ? Alpha::kBlend : text == "MASK" ? Alpha::kMask : Alpha::kOpaque;
  }

  LinearColor base_color(const aiMaterial& source, Alpha alpha) const {
    aiColor4D color(1, 1, 1, 1);
    if (source.Get(AI_MATKEY_BASE_COLOR, color) != aiReturn_SUCCESS) {
      source.Get(AI_MATKEY_COLOR_DIFFUSE, color);
    }
    if (format_ == Format::kObj) {
      color.a = 1;
      source.Get(AI_MATKEY_OPACITY, color.a);
    }
    LinearColor out = linear_color(color, format_ != Format::kGltf);
    if (alpha == Alpha::kOpaque) out.a = 1;
    return out;
  }

  // A grey Kd beside a map_Kd is an exporter's default, not a tint: it would only darken the print.
  static LinearColor tint_of(const LinearColor& kd) {
    if (kd.r == kd.g && kd.g == kd.b) return {1, 1, 1, kd.a};
    return kd;
  }

  void placement(const aiMaterial& source, Material& material, LoadedMaterial& loaded) const {
    int mode = aiTextureMapMode_Wrap;
    if (source.Get(AI_MATKEY_MAPPINGMODE_U(aiTextureType_DIFFUSE, 0), mode) == aiReturn_SUCCESS) {
      material.wrap_u = wrap_of(mode);
    }
    mode = aiTextureMapMode_Wrap;
    if (source.Get(AI_MATKEY_MAPPINGMODE_V(aiTextureType_DIFFUSE, 0), mode) == aiReturn_SUCCESS) {
      material.wrap_v = wrap_of(mode);
    }
    int channel = 0;
    source.Get(AI_MATKEY_UVWSRC(aiTextureType_DIFFUSE, 0), channel);
    loaded.channel = unsigned(std::max(channel, 0));
    aiUVTransform transform;
    if (format_ == Format::kGltf && source.Get(AI_MATKEY_UVTRANSFORM(aiTextureType_DIFFUSE, 0),
                                               transform) == aiReturn_SUCCESS) {
      loaded.transformed = true;
      loaded.transform = gltf_transform(transform);
    }
  }

  // assimp restates glTF's scale, rotation and offset about the picture's centre; this takes that
  // back and returns the map for v up: (u, v) -> glTF's (u, 1 - v) -> transformed -> back.
  static Eigen::Matrix<float, 2, 3> gltf_transform(const aiUVTransform& t) {
    const double angle = -t.mRotation, c = std::cos(angle), s = std::sin(angle);
    const double sx = t.mScaling.x, sy = t.mScaling.y;
    const double ox = t.mTranslation.x - 0.5 * sx * (-c + s + 1);
    const double oy = 0.5 * sy * (s + c - 1) + 1 - sy - t.mTranslation.y;
    // glTF, v down: u' = c sx u + s sy v + ox, v' = -s sx u + c sy v + oy.
    Eigen::Matrix<float, 2, 3> map;
    map << float(c * sx), float(-s * sy), float(s * sy + ox), float(s * sx), float(c * sy),
        float(1 - c * sy - oy);
    return map;
  }

  int texture_index(const std::string& name, Alpha alpha, float cutoff) {
    const auto key = std::make_tuple(name, int(alpha), alpha == Alpha::kMask ? cutoff : 0.0f);
    const auto known = textures_.find(key);
    if (known != textures_.end()) return known->second;
    int index = -1;
    try {
      Image image = read_texture(name);
      index = int(object_.textures.size());
      object_.textures.push_back(with_alpha(std::move(image), alpha, cutoff));
    } catch (const InputError& error) {
      context_.warn(fmt::format("{} The material's base colour is used instead.", error.what()));
    }
    return textures_[key] = index;
  }

  Image read_texture(const std::string& name) {
    const aiTexture* embedded = name.empty() ? nullptr : find_embedded(name);
    if (embedded) return decode_embedded(*embedded);
    const fs::path path = folder_.find(name);
    if (path.empty()) {
      throw InputError(
          fmt::format("The texture {} that the model refers to is missing; put it "
                      "beside the model.",
                      name));
    }
    return decode_image(folder_.read(path), path.string());
  }

  const aiTexture* find_embedded(const std::string& name) const {
    if (name[0] == '*' && name.size() > 1 && name[1] >= '0' && name[1] <= '9') {
      const long index = std::strtol(name.c_str() + 1, nullptr, 10);
      return index < long(scene_.mNumTextures) ? scene_.mTextures[index] : nullptr;
    }
    const std::string wanted = fs::path(name).filename().string();
    for (unsigned i = 0; i < scene_.mNumTextures; ++i) {
      const fs::path stored(scene_.mTextures[i]->mFilename.C_Str());
      if (!wanted.empty() && stored.filename() == wanted) return scene_.mTextures[i];
    }
    return nullptr;
  }

  static Image decode_embedded(const aiTexture& texture) {
    if (texture.mHeight != 0 || !texture.pcData) {
      throw InputError("An embedded texture has no PNG or JPEG data.");
    }
    const auto* data = reinterpret_cast<const std::uint8_t*>(texture.pcData);
    return decode_image(FileBytes(data, data + texture.mWidth), "An embedded texture");
  }

  const aiScene& scene_;
  Format format_;
  ModelFolder& folder_;
  bool read_textures_;
  bool has_mtl_;  // of an OBJ: without it assimp makes up grey materials
  Object& object_;
  RunContext& context_;
  std::map<unsigned, LoadedMaterial> loaded_;
  std::vector<int> bare_;
  std::map<std::tuple<std::string, int, float>, int> textures_;
};

// ---- shape --------------------------------------------------------------------------------------

// 1 / 255 where colours were whole numbers up to 255 (OFF does not say which).
float color_scale(const aiMesh& mesh, Format format) {
  if (format != Format::kOff) return 1;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiColor4D& c = mesh.mColors[0][v];
    if (c.r > 1 || c.g > 1 || c.b > 1) return 1.0f / 255;
  }
  return 1;
}

// Colours of a mesh's vertices. Readers leave alpha at 0 where the file has none.
std::vector<LinearColor> vertex_colors(const aiMesh& mesh, Format format) {
  std::vector<LinearColor> colors(mesh.mNumVertices);
  const float scale = color_scale(mesh, format);
  const bool has_alpha = std::any_of(mesh.mColors[0], mesh.mColors[0] + mesh.mNumVertices,
                                     [](const aiColor4D& color) { return color.a != 0; });
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    aiColor4D color = mesh.mColors[0][v];
    color.r *= scale;
    color.g *= scale;
    color.b *= scale;
    if (!has_alpha) color.a = 1;
    if (color.a > 1) color.a *= scale;
    colors[v] = linear_color(color, format != Format::kGltf);
  }
  return colors;
}

class SceneReader {
 public:
  SceneReader(const std::string& path, const aiScene& scene, Format format,
              const std::vector<std::vector<FaceColors>>& face_colors, Materials& materials,
              Object& object)
      : path_(path),
        scene_(scene),
        format_(format),
        face_colors_(face_colors),
        materials_(materials),
        object_(object) {}

  void read() {
    has_colors_ = !face_colors_.empty();
    for (unsigned m = 0; m < scene_.mNumMeshes; ++m) {
      const aiMesh& mesh = *scene_.mMeshes[m];
      has_uvs_ = has_uvs_ || mesh.HasTextureCoords(0);
      has_colors_ = has_colors_ || mesh.HasVertexColors(0);
    }
    if (scene_.mRootNode) read_node(*scene_.mRootNode, aiMatrix4x4(), 0);
    if (object_.triangles.empty()) {
      throw InputError(fmt::format("{}: it has no triangles; export the model again.", path_));
    }
  }

 private:
  // Transforms are multiplied from the root down, in double.
  void read_node(const aiNode& node, const aiMatrix4x4& parent, int depth) {
    if (depth > 1000) {
      throw InputError(fmt::format("{}: its nodes are nested too deeply.", path_));
    }
    const aiMatrix4x4 world = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] < scene_.mNumMeshes) read_mesh(node.mMeshes[i], world);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      read_node(*node.mChildren[i], world, depth + 1);
    }
  }

  // What the triangles of one mesh share.
  struct MeshContext {
    const aiMesh& mesh;
    std::size_t first_position;
    const LoadedMaterial& material;
    int material_index;
    const aiVector3D* uvs;  // or null
    std::vector<LinearColor> colors;
    const std::vector<FaceColors>* face_colors;  // 3MF's, or null
    bool mirrored;
  };

  void read_mesh(unsigned number, const aiMatrix4x4& world) {
    const aiMesh& mesh = *scene_.mMeshes[number];
    const std::size_t first = object_.positions.size();
    if (first + mesh.mNumVertices > std::size_t(1) << 30) {
      throw InputError(fmt::format("{}: too many vertices; simplify the model.", path_));
    }
    add_positions(mesh, world);
    const LoadedMaterial& material = materials_.get(mesh.mMaterialIndex);
    const unsigned channel = mesh.HasTextureCoords(material.channel) ? material.channel : 0;
    const bool textured = mesh.HasTextureCoords(channel);
    MeshContext context{
        mesh,
        first,
        material,
        textured ? material.index : materials_.without_texture(mesh.mMaterialIndex),
        textured ? mesh.mTextureCoords[channel] : nullptr,
        mesh.HasVertexColors(0) ? vertex_colors(mesh, format_) : std::vector<LinearColor>(),
        number < face_colors_.size() && face_colors_[number].size() == mesh.mNumFaces
            ? &face_colors_[number]
            : nullptr,
        world.Determinant() < 0};
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) read_face(context, f);
  }

  // Points and lines are skipped.
  void read_face(const MeshContext& context, unsigned number) {
    const aiFace& face = context.mesh.mFaces[number];
    if (face.mNumIndices == 3) {
      add_triangle(context, number, {face.mIndices[0], face.mIndices[1], face.mIndices[2]});
    } else if (face.mNumIndices > 3) {
      std::vector<Vec3> corners;
      for (unsigned i = 0; i < face.mNumIndices; ++i) {
        corners.push_back(object_.positions[context.first_position + face.mIndices[i]]);
      }
      for (const auto& cut : triangulate(corners)) {
        add_triangle(context, number,
                     {face.mIndices[cut[0]], face.mIndices[cut[1]], face.mIndices[cut[2]]});
      }
    }
  }

  void add_triangle(const MeshContext& context, unsigned face, std::array<unsigned, 3> corners) {
    if (context.mirrored) std::swap(corners[1], corners[2]);
    object_.triangles.push_back({std::int32_t(context.first_position + corners[0]),
                                 std::int32_t(context.first_position + corners[1]),
                                 std::int32_t(context.first_position + corners[2])});
    object_.material_of.push_back(context.material_index);
    if (has_uvs_) add_uvs(context.uvs, corners, context.material);
    if (has_colors_) add_colors(context, face, corners);
  }

  void add_colors(const MeshContext& context, unsigned face,
                  const std::array<unsigned, 3>& corners) {
    CornerColor colors{kWhite, kWhite, kWhite};
    if (context.face_colors) {
      const FaceColors& rgba = (*context.face_colors)[face];
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t from = context.mirrored && c > 0 ? 3 - c : c;
        colors[c] = {srgb8_to_linear(rgba[from][0]), srgb8_to_linear(rgba[from][1]),
                     srgb8_to_linear(rgba[from][2]), float(rgba[from][3]) / 255};
      }
    } else if (!context.colors.empty()) {
      for (std::size_t c = 0; c < 3; ++c) colors[c] = context.colors[corners[c]];
    }
    object_.colors.push_back(colors);
  }

  void add_positions(const aiMesh& mesh, const aiMatrix4x4& world) {
    Mat3 linear;
    linear << world.a1, world.a2, world.a3, world.b1, world.b2, world.b3, world.c1, world.c2,
        world.c3;
    const Vec3 offset(world.a4, world.b4, world.c4);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      const Vec3 position = linear * Vec3(p.x, p.y, p.z) + offset;
      if (!position.allFinite() || position.cwiseAbs().maxCoeff() > 1e30) {
        throw InputError(fmt::format(
            "{}: vertex {} has a coordinate that is not a finite number; export the model again.",
            path_, v));
      }
      object_.positions.push_back(position);
    }
  }

  void add_uvs(const aiVector3D* coordinates, const std::array<unsigned, 3>& corners,
               const LoadedMaterial& material) {
    CornerUv uvs;
    for (std::size_t c = 0; c < 3; ++c) {
      uvs[c].setZero();
      if (!coordinates) continue;
      Eigen::Vector2f uv(coordinates[corners[c]].x, coordinates[corners[c]].y);
      if (material.transformed) {
        uv = material.transform.leftCols<2>() * uv + material.transform.col(2);
      }
      if (!uv.allFinite()) {
        throw InputError(fmt::format(
            "{}: a texture coordinate is not a finite number; export the model again.", path_));
      }
      uvs[c] = uv;
    }
    object_.uvs.push_back(uvs);
  }

  const std::string& path_;
  const aiScene& scene_;
  Format format_;
  const std::vector<std::vector<FaceColors>>& face_colors_;
  Materials& materials_;
  Object& object_;
  bool has_uvs_ = false;
  bool has_colors_ = false;
};

// What reading it takes for granted.
void check_scene(const std::string& path, const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh* mesh = scene.mMeshes[m];
    const bool whole = mesh && (mesh->mNumVertices == 0 || mesh->mVertices) &&
                       (mesh->mNumFaces == 0 || mesh->mFaces);
    if (!whole) {
      throw InputError(fmt::format("{}: a mesh is incomplete; export the model again.", path));
    }
    for (unsigned f = 0; f < mesh->mNumFaces; ++f) {
      const aiFace& face = mesh->mFaces[f];
      for (unsigned i = 0; i < face.mNumIndices; ++i) {
        if (face.mIndices[i] < mesh->mNumVertices) continue;
        throw InputError(
            fmt::format("{}: a face refers to vertex {}, but there are {}; export the model again.",
                        path, face.mIndices[i], mesh->mNumVertices));
      }
    }
  }
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32; }, ' ');
  return text.substr(0, 300);
}

const aiScene& import(const std::string& path, const std::string& name,
                      Assimp::Importer& importer) {
  const aiScene* scene = nullptr;
  std::string problem;
  try {
    scene = importer.ReadFile(name, 0);
    if (scene) {
      check_scene(path, *scene);
    } else {
      problem = importer.GetErrorString();
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    problem = "not enough memory";
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (!scene) {
    throw InputError(fmt::format("{}: cannot be read as a model ({}); export the model again.",
                                 path, one_line(problem)));
  }
  return *scene;
}

// ---- finishing ----------------------------------------------------------------------------------

// glTF is y-up, right-handed; ours is z-up.
void turn_y_up(Object& object) {
  for (Vec3& p : object.positions) p = Vec3(p.x(), -p.z(), p.y());
}

void scale_to_mm(Object& object, double mm) {
  if (mm == 1) return;
  for (Vec3& p : object.positions) p *= mm;
}

// The given picture alone decides the colour, except on parts without texture coordinates (bare).
void replace_textures(Object& object, const std::vector<int>& bare, const fs::path& model,
                      const fs::path& texture, ModelFolder& folder) {
  if (object.uvs.empty()) {
    throw InputError(fmt::format(
        "{}: the model has no texture coordinates (UVs), so --texture {} cannot be placed; unwrap "
        "it, in Blender for instance, and export it as OBJ or GLB.",
        model.string(), texture.string()));
  }
  const Image image = decode_image(folder.read(texture), texture.string());
  object.textures.assign(1, std::make_shared<const Image>(image));
  object.colors.clear();
  for (std::size_t i = 0; i < object.materials.size(); ++i) {
    if (std::find(bare.begin(), bare.end(), int(i)) != bare.end()) continue;
    object.materials[i].texture = 0;
    object.materials[i].base_color = kWhite;
  }
}

// ---- polygons -----------------------------------------------------------------------------------

// Gathers faces; assimp gives every face vertices of its own.
class PolygonCollector {
 public:
  void add(const aiMesh& mesh) {
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) continue;  // points and lines
      std::vector<std::int32_t> corners;
      for (unsigned i = 0; i < face.mNumIndices; ++i)
        corners.push_back(vertex(mesh.mVertices[face.mIndices[i]]));
      mesh_.faces.push_back(std::move(corners));
    }
  }
  PolygonMesh take() { return std::move(mesh_); }

 private:
  std::int32_t vertex(const aiVector3D& p) {
    const auto [known, is_new] = index_.try_emplace({p.x, p.y, p.z}, int(mesh_.positions.size()));
    if (is_new) mesh_.positions.push_back(Vec3(p.x, p.y, p.z));
    return known->second;
  }
  PolygonMesh mesh_;
  std::map<std::array<float, 3>, std::int32_t> index_;
};

}  // namespace

PolygonMesh load_polygons(const fs::path& path) {
  const Format format = format_of(path);
  if (format != Format::kObj && format != Format::kPly)
    throw InputError(
        fmt::format("{}: quads are read from OBJ and PLY files; export the mesh as "
                    "one of them",
                    path.string()));
  ModelFolder folder(path);
  const CheckedFile checked = check(format, path.string(), folder.read(path), folder);
  const std::string name = path.stem().string() + lower_extension(path);
  Assimp::Importer importer;
  importer.SetIOHandler(new CheckedFiles(name, checked.bytes, folder));  // takes it over
  const aiScene& scene = import(path.string(), name, importer);
  PolygonCollector collector;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) collector.add(*scene.mMeshes[m]);
  return collector.take();
}

LoadedObject load_object(const fs::path& path, const LoadOptions& options, RunContext& context) {
  const Format format = format_of(path);
  const std::string shown = path.string();
  unit_for(options.units, "", format);  // refuses a bad --units before the long part
  ModelFolder folder(path);
  const CheckedFile checked = check(format, shown, folder.read(path), folder);
  for (const std::string& warning : checked.warnings) context.warn(warning);
  context.check_cancelled();

  // assimp picks its reader by extension, in lower case; an OBJ's own name also names its MTL.
  const std::string name = path.stem().string() + lower_extension(path);
  LoadedObject loaded;
  std::vector<int> bare;
  {
    Assimp::Importer importer;
    auto* files = new CheckedFiles(name, checked.bytes, folder);
    importer.SetIOHandler(files);  // takes it over
    const aiScene& scene = import(shown, name, importer);
    for (const std::string& missing : files->missing()) {
      context.warn(fmt::format("The file {} that {} refers to is missing; put it beside the model.",
                               missing, path.filename().string()));
    }
    Materials materials(scene, format, folder, options.texture.empty(), loaded.object, context);
    SceneReader(shown, scene, format, checked.face_colors, materials, loaded.object).read();
    bare = materials.bare();
  }
  context.check_cancelled();

  const Unit unit = unit_for(options.units, checked.units, format);
  if (format == Format::kGltf) turn_y_up(loaded.object);
  scale_to_mm(loaded.object, unit.mm);
  if (!options.texture.empty()) {
    replace_textures(loaded.object, bare, path, options.texture, folder);
  }
  loaded.health = check_and_repair(loaded.object);
  if (loaded.object.triangles.empty()) {
    throw InputError(
        fmt::format("{}: all its triangles are degenerate; export the model again.", shown));
  }
  loaded.units = unit.name;
  loaded.files = folder.files();
  return loaded;
}

}  // namespace hydrodip
