#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/file.h"
#include "base/parallel.h"
#include "image/files.h"
#include "report/bytes.h"
#include "report/normals.h"
#include "report/preview.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;
using Vec3f = std::array<float, 3>;

constexpr double kFilmOffsetMm = 0.05;  // so that film and object do not flicker through each other
constexpr int kLongestSidePx = 2048;

constexpr int kFloat = 5126, kUint32 = 5125;
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963;

struct GlbMesh {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;
  std::vector<std::array<float, 2>> uvs;  // empty: none
  std::vector<std::uint32_t> indices;
};

// Posed-object frame (mm) to glTF (y up, facing +z): the side that met the film is the front.
Vec3f to_gltf(const Vec3& v) { return {float(-v.x()), float(v.y()), float(-v.z())}; }
Vec3f to_gltf_metres(const Vec3& mm) { return to_gltf(1e-3 * mm); }

// The object with smooth normals; corners with the same position and normal share a vertex.
GlbMesh object_mesh(const Object& object) {
  const std::vector<CornerNormals> normals = corner_normals(object.positions, object.triangles);
  std::map<std::pair<Vec3f, Vec3f>, std::uint32_t> known;
  GlbMesh mesh;
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = object.positions[std::size_t(object.triangles[t][k])];
      const std::pair<Vec3f, Vec3f> corner = {to_gltf_metres(p), to_gltf(normals[t][k])};
      const auto [where, is_new] = known.try_emplace(corner, std::uint32_t(known.size()));
      if (is_new) {
        mesh.positions.push_back(corner.first);
        mesh.normals.push_back(corner.second);
      }
      mesh.indices.push_back(where->second);
    }
  }
  return mesh;
}

// Unit outward normal per film vertex (against the film's own: its underside shows), zero where no
// film lies.
std::vector<Vec3> outward_normals(const DippedFilm& film) {
  std::vector<Vec3> normals(film.position.size(), Vec3::Zero());
  for (std::size_t t = 0; t < film.mesh.triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    const Triangle& triangle = film.mesh.triangles[t];
    const Vec3& a = film.position[std::size_t(triangle[0])];
    const Vec3 area = (film.position[std::size_t(triangle[1])] - a)
                          .cross(film.position[std::size_t(triangle[2])] - a);
    for (const std::int32_t v : triangle) normals[std::size_t(v)] -= area;
  }
  for (Vec3& n : normals) {
    const double length = n.norm();
    if (length > 0) n /= length;
  }
  return normals;
}

// The part of the sheet that is shown, reduced by a whole factor.
struct Crop {
  int x0 = 0, y0 = 0;  // px of the film image
  int factor = 1;
  int width = 0, height = 0;  // px after reduction; empty: no film lies on the object
};

Crop crop_to_film(const DippedFilm& film, const Image& image, double width_mm, double height_mm) {
  constexpr double kRimMm = 1;
  Box2 box;
  for (std::size_t t = 0; t < film.mesh.triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    for (const std::int32_t v : film.mesh.triangles[t]) box.add(film.mesh.u[std::size_t(v)]);
  }
  if (box.empty() || image.empty()) return {};
  const auto column = [&](double x_mm) {
    const double px = (x_mm / width_mm + 0.5) * image.width_px;
    return int(std::clamp(std::floor(px), 0.0, image.width_px - 1.0));
  };
  const auto row = [&](double y_mm) {
    const double px = (0.5 - y_mm / height_mm) * image.height_px;
    return int(std::clamp(std::floor(px), 0.0, image.height_px - 1.0));
  };
  Crop crop;
  crop.x0 = column(box.min.x() - kRimMm);
  crop.y0 = row(box.max.y() + kRimMm);
  const int width = column(box.max.x() + kRimMm) + 1 - crop.x0;
  const int height = row(box.min.y() - kRimMm) + 1 - crop.y0;
  crop.factor = (std::max(width, height) + kLongestSidePx - 1) / kLongestSidePx;
  crop.width = (width + crop.factor - 1) / crop.factor;
  crop.height = (height + crop.factor - 1) / crop.factor;
  return crop;
}

// Mean colour of a block of the film image over the object's own colour, in linear light.
LinearColor mean_over(const Image& image, const Crop& crop, int x, int y, const LinearColor& base) {
  LinearColor sum{0, 0, 0, 1};
  float count = 0;
  for (int j = 0; j < crop.factor; ++j) {
    for (int i = 0; i < crop.factor; ++i) {
      const int sx = std::min(crop.x0 + x * crop.factor + i, image.width_px - 1);
      const int sy = std::min(crop.y0 + y * crop.factor + j, image.height_px - 1);
      const std::uint8_t* p = image.pixel(sx, sy);
      const float alpha = float(p[3]) / 255;
      sum.r += base.r + alpha * (srgb8_to_linear(p[0]) - base.r);
      sum.g += base.g + alpha * (srgb8_to_linear(p[1]) - base.g);
      sum.b += base.b + alpha * (srgb8_to_linear(p[2]) - base.b);
      count += 1;
    }
  }
  return {sum.r / count, sum.g / count, sum.b / count, 1};
}

Image film_texture(const Image& image, const Crop& crop, const LinearColor& base) {
  Image texture(crop.width, crop.height);
  parallel_for(std::size_t(crop.height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      for (int x = 0; x < crop.width; ++x) {
        const LinearColor c = mean_over(image, crop, x, int(y), base);
        std::uint8_t* pixel = texture.pixel(x, int(y));
        pixel[0] = linear_to_srgb8(c.r);
        pixel[1] = linear_to_srgb8(c.g);
        pixel[2] = linear_to_srgb8(c.b);
        pixel[3] = 255;
      }
    }
  });
  return texture;
}

GlbMesh film_mesh(const DippedFilm& film, const Image& image, const Crop& crop, double width_mm,
                  double height_mm) {
  const std::vector<Vec3> normals = outward_normals(film);
  std::vector<std::int64_t> number(film.position.size(), -1);
  GlbMesh mesh;
  const auto vertex = [&](std::size_t v) {
    if (number[v] < 0) {
      number[v] = std::int64_t(mesh.positions.size());
      const Vec3 normal = normals[v].squaredNorm() > 0.5 ? normals[v] : Vec3(-Vec3::UnitZ());
      const Vec2& u = film.mesh.u[v];
      const double x = (u.x() / width_mm + 0.5) * image.width_px;
      const double y = (0.5 - u.y() / height_mm) * image.height_px;
      mesh.positions.push_back(to_gltf_metres(film.position[v] + kFilmOffsetMm * normal));
      mesh.normals.push_back(to_gltf(normal));
      mesh.uvs.push_back({float((x - crop.x0) / (crop.width * crop.factor)),
                          float((y - crop.y0) / (crop.height * crop.factor))});
    }
    return std::uint32_t(number[v]);
  };
  for (std::size_t t = 0; t < film.mesh.triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    for (const std::size_t k : {0, 2, 1}) {  // seen from its underside
      mesh.indices.push_back(vertex(std::size_t(film.mesh.triangles[t][k])));
    }
  }
  return mesh;
}

// The JSON and the binary chunk of a GLB file as they grow.
class GlbWriter {
 public:
  GlbWriter() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "hydrodip"}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({{{"name", "Preview"}, {"nodes", Json::array()}}});
    for (const char* part : {"nodes", "meshes", "materials"}) json_[part] = Json::array();
  }

  int add_material(const Json& material) { return append("materials", material); }

  // An embedded PNG as a texture that neither repeats nor wraps.
  int add_texture(const std::vector<std::uint8_t>& png) {
    const int image = append(
        "images",
        {{"bufferView", add_view(png, 0)}, {"mimeType", "image/png"}, {"name", "film image"}});
    constexpr int kLinear = 9729, kLinearMipmapLinear = 9987, kClampToEdge = 33071;
    const int sampler = append("samplers", {{"magFilter", kLinear},
                                            {"minFilter", kLinearMipmapLinear},
                                            {"wrapS", kClampToEdge},
                                            {"wrapT", kClampToEdge}});
    return append("textures", {{"sampler", sampler}, {"source", image}});
  }

  void add_mesh(const std::string& name, const GlbMesh& mesh, int material) {
    Json attributes;
    attributes["POSITION"] = add_floats(mesh.positions, true);
    attributes["NORMAL"] = add_floats(mesh.normals, false);
    if (!mesh.uvs.empty()) attributes["TEXCOORD_0"] = add_floats(mesh.uvs, false);
    const Json primitive = {
        {"attributes", attributes}, {"indices", add_indices(mesh.indices)}, {"material", material}};
    const int number = append("meshes", {{"name", name}, {"primitives", Json::array({primitive})}});
    const int node = append("nodes", {{"name", name}, {"mesh", number}});
    json_["scenes"][0]["nodes"].push_back(node);
  }

  std::vector<std::uint8_t> finish() {
    json_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
    Bytes text;
    text.add(json_.dump());
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

 private:
  int append(const char* list, const Json& entry) {
    json_[list].push_back(entry);
    return int(json_[list].size()) - 1;
  }

  int add_view(const std::vector<std::uint8_t>& bytes, int target) {
    Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    binary_.add(bytes);
    binary_.pad(0);
    return append("bufferViews", view);
  }

  template <std::size_t N>
  int add_floats(const std::vector<std::array<float, N>>& values, bool with_limits) {
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
                     {"type", N == 3 ? "VEC3" : "VEC2"}};
    if (with_limits) {
      accessor["min"] = low;
      accessor["max"] = high;
    }
    return append("accessors", accessor);
  }

  int add_indices(const std::vector<std::uint32_t>& indices) {
    Bytes bytes;
    for (const std::uint32_t index : indices) bytes.add_u32(index);
    return append("accessors", {{"bufferView", add_view(bytes.data(), kIndexBuffer)},
                                {"componentType", kUint32},
                                {"count", indices.size()},
                                {"type", "SCALAR"}});
  }

  Json json_;
  Bytes binary_;
};

Json matte(const std::string& name) {
  Json material;
  material["name"] = name;
  material["pbrMetallicRoughness"] = {{"metallicFactor", 0.0}, {"roughnessFactor", 0.6}};
  material["doubleSided"] = true;
  return material;
}

}  // namespace

void write_preview_glb(const std::filesystem::path& path, const Object& object,
                       const DippedFilm& film, const Image& film_image, double sheet_width_mm,
                       double sheet_height_mm, const LinearColor& base) {
  GlbWriter glb;
  const auto channel = [](float value) { return std::clamp(value, 0.0f, 1.0f); };
  Json bare = matte("object");
  bare["pbrMetallicRoughness"]["baseColorFactor"] = {channel(base.r), channel(base.g),
                                                     channel(base.b), 1.0};
  glb.add_mesh("object", object_mesh(object), glb.add_material(bare));

  const Crop crop = crop_to_film(film, film_image, sheet_width_mm, sheet_height_mm);
  if (crop.width > 0) {
    Json printed = matte("film");
    const int texture = glb.add_texture(encode_png(film_texture(film_image, crop, base)));
    printed["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
    glb.add_mesh("film", film_mesh(film, film_image, crop, sheet_width_mm, sheet_height_mm),
                 glb.add_material(printed));
  }
  const std::vector<std::uint8_t> bytes = glb.finish();
  write_file(path, bytes.data(), bytes.size());
}

}  // namespace hydrodip
