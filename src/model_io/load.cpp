#include "model_io/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/begun.h"
#include "base/error.h"
#include "base/run_scope.h"
#include "base/unicode.h"
#include "image/files.h"
#include "image/picture_file.h"
#include "model_io/model_file.h"
#include "model_io/model_folder.h"
#include "model_io/model_pictures.h"
#include "model_io/text.h"
#include "object/polygon.h"

namespace hydrodip {

namespace {

namespace fs = std::filesystem;

constexpr LinearColor kWhite{1, 1, 1, 1};

struct Format {
  const char* extension;
  ModelFile (*read)(const ModelInput& input);
  bool keeps_polygons = false;  // quads stay quads
  const char* unit = "";        // where neither the user nor the file says; "": mm is a guess
};

constexpr Format kFormats[] = {
    {".obj", read_obj, true},
    {".ply", read_ply, true},
    {".stl", read_stl},
    {".off", read_off},
    {".3mf", read_3mf},
    {".gltf", read_gltf, false, "m"},
    {".glb", read_gltf, false, "m"},
};

const Format& format_of(const fs::path& path) {
  if (path.empty()) throw InputError("no model is named: give the file of one.");
  const std::string extension = lower(path.extension().string());
  for (const Format& known : kFormats)
    if (extension == known.extension) return known;
  std::error_code none;
  if (fs::is_directory(path, none))
    throw InputError(fmt::format("{}: it is a folder; name the model file in it.", path.string()));
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

Unit unit_for(const std::string& asked, const std::string& in_file, const Format& format) {
  if (!asked.empty()) {
    for (std::size_t i = 0; i < kUnitsOnCommandLine; ++i)
      if (asked == kUnits[i].name) return kUnits[i];
    throw InputError(fmt::format("--units {}: not a known unit; use mm, cm, m or in.", asked));
  }
  const std::string& name = in_file.empty() ? format.unit : in_file;
  for (const Unit& unit : kUnits) {
    if (name != unit.name) continue;
    // Short names where there are any: 3MF says "millimeter".
    for (const Unit& brief : kUnits)
      if (brief.mm == unit.mm) return brief;
  }
  return kUnits[0];
}

// ---- reading ------------------------------------------------------------------------------------

ModelFile read_model(const fs::path& path, const Format& format, ModelFolder& folder,
                     ExpectedPictures* expected, const RunContext& context) {
  const std::string shown = path.string(), name = path.filename().string();
  const FileBytes bytes = in_utf8(folder.read_path(path));
  if (bytes.empty())
    throw InputError(fmt::format("{}: the file is empty; export the model again.", shown));
  try {
    ModelFile file = format.read({shown, name, bytes, folder, expected, context});
    for (std::size_t v = 0; v < file.positions.size(); ++v) {
      const Vec3& p = file.positions[v];
      if (p.allFinite() && p.cwiseAbs().maxCoeff() <= 1e30) continue;
      throw InputError(fmt::format(
          "{}: vertex {} has a coordinate that is not a finite number; export the model again.",
          shown, v));
    }
    return file;
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: not enough memory for this model of {:.0f} MB; simplify it.",
                                 shown, std::ceil(double(bytes.size()) / 1e6)));
  }
}

// ---- the object ---------------------------------------------------------------------------------

// Materials as they are used first, and each once more without its picture where faces have no
// texture coordinates.
class Materials {
 public:
  // `only_texture`: one picture decides the colour alone (--texture).
  Materials(const ModelFile& file, ModelPictures& pictures, bool only_texture, Object& object)
      : file_(file),
        pictures_(pictures),
        only_texture_(only_texture),
        object_(object),
        with_picture_(file.materials.size() + 1, -1),
        without_(file.materials.size() + 1, -1) {}

  int get(std::int32_t number, bool has_uvs) {
    int& index = with_picture_[std::size_t(number + 1)];
    if (index < 0) index = add(number, true);
    if (has_uvs || !has_picture(index)) return index;
    int& bare = without_[std::size_t(number + 1)];
    if (bare < 0) bare = add(number, false);
    return bare;
  }

  // Waits for the picture: whether it can be had.
  bool has_picture(int index) {
    if (only_texture_) return object_.materials[std::size_t(index)].texture >= 0;
    const int picture = picture_of_[std::size_t(index)];
    return picture >= 0 && pictures_.can_be_had(picture);
  }

  // texture_of[n]: where the picture of number n is among the object's textures, -1: not there.
  void show(const std::vector<int>& texture_of) {
    for (std::size_t m = 0; m < picture_of_.size(); ++m) {
      if (picture_of_[m] < 0) continue;
      Material& material = object_.materials[m];
      material.texture = texture_of[std::size_t(picture_of_[m])];
      if (material.texture < 0) continue;
      const Shown& shown = shown_[m];
      material.base_color = shown.tint;
      material.wrap_u = shown.wrap_u;
      material.wrap_v = shown.wrap_v;
    }
  }

 private:
  // Of a material whose picture can be had.
  struct Shown {
    LinearColor tint;
    Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  };

  int add(std::int32_t number, bool with_picture) {
    const FileMaterial* source = number < 0 ? nullptr : &file_.materials[std::size_t(number)];
    Material material;
    if (source) {
      material.name = source->name;
      material.base_color = source->base_color;
      material.color_is_default = source->color_is_default;
    }
    int picture = -1;
    Shown shown;
    if (with_picture && only_texture_) {
      material.texture = 0;
      material.base_color = kWhite;
    } else if (with_picture && source && source->picture >= 0) {
      picture = pictures_.show(*source);
      shown = {source->texture_tint, source->wrap_u, source->wrap_v};
    }
    object_.materials.push_back(material);
    picture_of_.push_back(picture);
    shown_.push_back(shown);
    return int(object_.materials.size()) - 1;
  }

  const ModelFile& file_;
  ModelPictures& pictures_;
  const bool only_texture_;
  Object& object_;
  std::vector<int> with_picture_, without_;
  // Per material of the object: its picture's number among those shown, -1: none.
  std::vector<int> picture_of_;
  std::vector<Shown> shown_;
};

// Cuts the file's polygons into the object's triangles.
class ObjectMaker {
 public:
  ObjectMaker(const std::string& path, ModelFile& file, Materials& materials, bool only_texture,
              Object& object, const RunContext& context)
      : path_(path),
        file_(file),
        materials_(materials),
        only_texture_(only_texture),
        object_(object),
        cancel_(context) {}

  void make() {
    std::size_t triangles = 0, begin = 0;
    for (const std::uint32_t end : file_.face_end) {
      triangles += end - begin - 2;
      begin = end;
    }
    object_.triangles.reserve(triangles);
    object_.material_of.reserve(triangles);
    if (!file_.uvs.empty()) object_.uvs.reserve(triangles);
    if (!file_.colors.empty()) object_.colors.reserve(triangles);
    begin = 0;
    for (std::size_t f = 0; f < file_.face_end.size(); ++f) {
      cancel_();
      make_face(f, begin, file_.face_end[f]);
      begin = file_.face_end[f];
    }
    object_.positions = std::move(file_.positions);
  }

 private:
  void make_face(std::size_t face, std::size_t begin, std::size_t end) {
    bool has_uvs = !file_.uvs.empty();
    for (std::size_t c = begin; has_uvs && c < end; ++c)
      has_uvs = file_.uvs[c].x() != ModelFile::kNoUv;
    const std::int32_t source = file_.material_of[face];
    const int material = materials_.get(source, has_uvs);
    const bool transformed = !only_texture_ && source >= 0 && has_uvs &&
                             file_.materials[std::size_t(source)].transformed &&
                             materials_.has_picture(material);
    const FileMaterial* moved = transformed ? &file_.materials[std::size_t(source)] : nullptr;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      object_.triangles.push_back({file_.corners[a], file_.corners[b], file_.corners[c]});
      object_.material_of.push_back(material);
      if (!file_.uvs.empty())
        object_.uvs.push_back(
            {uv(a, has_uvs, moved), uv(b, has_uvs, moved), uv(c, has_uvs, moved)});
      if (!file_.colors.empty())
        object_.colors.push_back({file_.colors[a], file_.colors[b], file_.colors[c]});
    };
    if (end - begin == 3) {
      add(begin, begin + 1, begin + 2);
      return;
    }
    std::vector<Vec3> corners;
    corners.reserve(end - begin);
    for (std::size_t c = begin; c < end; ++c)
      corners.push_back(file_.positions[std::size_t(file_.corners[c])]);
    for (const auto& cut : triangulate(corners))
      add(begin + std::size_t(cut[0]), begin + std::size_t(cut[1]), begin + std::size_t(cut[2]));
  }

  Eigen::Vector2f uv(std::size_t corner, bool has_uvs, const FileMaterial* moved) const {
    if (!has_uvs) return Eigen::Vector2f::Zero();
    Eigen::Vector2f uv = file_.uvs[corner];
    if (moved) uv = moved->transform.leftCols<2>() * uv + moved->transform.col(2);
    constexpr float kLargest = 1e30F;
    if (!uv.allFinite() || uv.cwiseAbs().maxCoeff() > kLargest)
      throw InputError(fmt::format(
          "{}: a texture coordinate is not a finite number; export the model again.", path_));
    return uv;
  }

  const std::string& path_;
  ModelFile& file_;
  Materials& materials_;
  bool only_texture_;
  Object& object_;
  CancelCheck cancel_;
};

// glTF is y-up, right-handed; ours is z-up.
void turn_y_up(Object& object) {
  for (Vec3& p : object.positions) p = Vec3(p.x(), -p.z(), p.y());
}

void scale_to_mm(Object& object, double mm) {
  if (mm == 1) return;
  for (Vec3& p : object.positions) p *= mm;
}

// The given picture alone decides the colour; vertex colours do not.
void forget_colors(const ModelFile& file, const fs::path& model, const fs::path& texture,
                   Object& object) {
  if (file.uvs.empty())
    throw InputError(fmt::format(
        "{1}: the model has no texture coordinates (UVs), so --texture {0} cannot be placed; put "
        "it on with --art {0}, which needs none.",
        texture.string(), model.string()));
  object.colors.clear();
}

void warn_of_one_color(const Object& object, const RunContext& context) {
  const auto color = object.one_color();
  if (!color || object.uvs.empty() || !object.has_appearance()) return;
  context.warn(fmt::format(
      "The model has one plain colour, #{:02x}{:02x}{:02x}, and no picture; name one with "
      "--texture if it should have one.",
      linear_to_srgb8(color->r), linear_to_srgb8(color->g), linear_to_srgb8(color->b)));
}

}  // namespace

void require_model_file(const fs::path& path) { format_of(path); }

PolygonMesh load_polygons(const fs::path& path, const RunContext& context) {
  const RunScope scope(context);
  const Format& format = format_of(path);
  if (!format.keeps_polygons)
    throw InputError(
        fmt::format("{}: quads are read from OBJ and PLY files; export the mesh as one of them",
                    path.string()));
  ModelFolder folder(path);
  const ModelFile file = read_model(path, format, folder, nullptr, context.quiet());
  context.check_cancelled();
  PolygonMesh mesh;
  std::map<std::array<double, 3>, std::int32_t> index;
  std::size_t begin = 0;
  CheckEvery check(1 << 12);
  for (const std::uint32_t end : file.face_end) {
    check();
    std::vector<std::int32_t> corners;
    for (; begin < end; ++begin) {
      const Vec3& p = file.positions[std::size_t(file.corners[begin])];
      const auto [known, is_new] =
          index.try_emplace({p.x(), p.y(), p.z()}, std::int32_t(mesh.positions.size()));
      if (is_new) mesh.positions.push_back(p);
      corners.push_back(known->second);
    }
    mesh.faces.push_back(std::move(corners));
  }
  return mesh;
}

LoadedObject load_object(const fs::path& path, const LoadOptions& options,
                         const RunContext& context) {
  const RunScope scope(context);
  const Format& format = format_of(path);
  unit_for(options.units, "", format);  // refuses a bad --units before the long part
  ModelFolder folder(path, options.confined_to);
  // What is no picture is refused before the long part.
  std::vector<std::uint8_t> texture_file;
  std::optional<Begun<Image>> only_texture;
  if (!options.texture.empty() && fs::exists(path)) {
    texture_file = read_picture(options.texture);
    only_texture.emplace([&] { return decode_image(texture_file, options.texture.string()); });
  }
  ModelPictures pictures(path.string(), folder, context);
  context.check_cancelled();
  ModelFile file = read_model(path, format, folder, only_texture ? nullptr : &pictures, context);
  context.check_cancelled();

  LoadedObject loaded;
  loaded.picture_problems = std::move(file.color_problems);
  pictures.take_over(std::move(file.pictures));
  Materials materials(file, pictures, only_texture.has_value(), loaded.object);
  if (only_texture) {
    forget_colors(file, path, options.texture, loaded.object);
    file.colors = {};
    folder.note(options.texture);
  }
  try {
    ObjectMaker(path.string(), file, materials, only_texture.has_value(), loaded.object, context)
        .make();
    const std::string file_units = file.units;
    const Unit unit = unit_for(options.units, file_units, format);
    if (file.y_up) turn_y_up(loaded.object);
    file = {};
    scale_to_mm(loaded.object, unit.mm);
    loaded.units = unit.name;
    loaded.units_are_told = !options.units.empty() || !file_units.empty() || *format.unit != 0;
    loaded.health = check_and_repair(loaded.object);
    if (only_texture)
      loaded.object.textures.push_back(std::make_shared<const Image>(only_texture->take()));
    materials.show(pictures.take(loaded.object.textures, loaded.picture_problems));
  } catch (const std::bad_alloc&) {
    throw InputError(
        fmt::format("{}: not enough memory for a model of this size; simplify it.", path.string()));
  }
  if (loaded.object.triangles.empty())
    throw InputError(fmt::format("{}: all its triangles are degenerate; export the model again.",
                                 path.string()));
  warn_of_one_color(loaded.object, context);
  loaded.files = folder.files();
  return loaded;
}

}  // namespace hydrodip
