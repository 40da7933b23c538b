#include "export/preview_glb.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/file.h"
#include "base/parallel.h"
#include "export/glb_writer.h"
#include "export/scene_object.h"
#include "image/files.h"
#include "image/resize.h"
#include "object/surface.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;
using Vec3f = std::array<float, 3>;
using ImageFile = std::vector<std::uint8_t>;

// So that film and object do not flicker through each other.
constexpr double kFilmOffsetMm = 0.05;
constexpr double kMostOffsetMm = 1;

constexpr int kJpegQuality = 92;

// Posed-object frame (mm) to glTF (y up, facing +z): the side that met the film is the front.
Vec3f to_gltf(const Vec3& v) { return {float(-v.x()), float(v.y()), float(-v.z())}; }
Vec3f to_gltf_metres(const Vec3& mm) { return to_gltf(1e-3 * mm); }

// The vertices of the object, with texture coordinates and colours only if it has any.
GlbMesh object_vertices(const ShownObject& shown, const Object& object) {
  GlbMesh mesh;
  for (const ShownVertex& v : shown.vertices) {
    const Vec3 position(double(v.position[0]), double(v.position[1]), double(v.position[2]));
    mesh.positions.push_back(to_gltf_metres(position));
    mesh.normals.push_back({-v.normal[0], v.normal[1], -v.normal[2]});
    if (!object.uvs.empty()) mesh.uvs.push_back({v.uv[0], 1 - v.uv[1]});
  }
  return mesh;
}

// Unit outward normal per film vertex (against the film's own: its underside shows), zero where no
// film lies.
std::vector<Vec3> outward_normals(const DippedFilm& film) {
  std::vector<Vec3> normals(film.position.size(), Vec3::Zero());
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    const Triangle& triangle = film.mesh().triangles[t];
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

// How far each film vertex has to be lifted so that the object, which bulges between the film's
// vertices, stays below.
std::vector<double> lifts(const Surface& surface, const DippedFilm& film,
                          const std::vector<Vec3>& normals) {
  constexpr std::array<std::array<double, 3>, 4> kPlaces = {
      {{0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {1.0 / 3, 1.0 / 3, 1.0 / 3}}};
  const auto bulge_over = [&](const Triangle& corners) {
    double bulge = 0;
    for (const auto& weights : kPlaces) {
      Vec3 place = Vec3::Zero(), outward = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        place += weights[k] * film.position[std::size_t(corners[k])];
        outward += weights[k] * normals[std::size_t(corners[k])];
      }
      const auto hit = surface.first_hit(place, outward, 0, kMostOffsetMm);
      if (hit) bulge = std::max(bulge, hit->t * outward.norm());
    }
    return bulge;
  };
  const std::vector<Triangle>& triangles = film.mesh().triangles;
  std::vector<double> bulge(triangles.size(), 0.0);
  parallel_for(triangles.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      if (film.lies_on_object(t)) bulge[t] = bulge_over(triangles[t]);
  });
  std::vector<double> lift(film.position.size(), kFilmOffsetMm);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const std::int32_t v : triangles[t])
      lift[std::size_t(v)] = std::max(lift[std::size_t(v)], bulge[t] + kFilmOffsetMm);
  return lift;
}

// The part of the sheet that is shown, reduced by a whole factor.
struct Crop {
  int x0 = 0, y0 = 0;  // px of the film image
  int factor = 1;
  int width = 0, height = 0;  // px after reduction; empty: no film lies on the object
};

Crop crop_to_film(const DippedFilm& film, const Image& image, double width_mm, double height_mm,
                  int texture_px) {
  constexpr double kRimMm = 1;
  Box2 box;
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    for (const std::int32_t v : film.mesh().triangles[t]) box.add(film.mesh().u[std::size_t(v)]);
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
  crop.factor = (std::max(width, height) + texture_px - 1) / texture_px;
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

GlbMesh film_mesh(const Surface& surface, const DippedFilm& film, const Image& image,
                  const Crop& crop, double width_mm, double height_mm) {
  const std::vector<Vec3> normals = outward_normals(film);
  const std::vector<double> lift = lifts(surface, film, normals);
  std::vector<std::int64_t> number(film.position.size(), -1);
  GlbMesh mesh;
  const auto vertex = [&](std::size_t v) {
    if (number[v] < 0) {
      number[v] = std::int64_t(mesh.positions.size());
      const Vec3 normal = normals[v].squaredNorm() > 0.5 ? normals[v] : Vec3(-Vec3::UnitZ());
      const Vec2& u = film.mesh().u[v];
      const double x = (u.x() / width_mm + 0.5) * image.width_px;
      const double y = (0.5 - u.y() / height_mm) * image.height_px;
      mesh.positions.push_back(to_gltf_metres(film.position[v] + lift[v] * normal));
      mesh.normals.push_back(to_gltf(normal));
      mesh.uvs.push_back({float((x - crop.x0) / (crop.width * crop.factor)),
                          float((y - crop.y0) / (crop.height * crop.factor))});
    }
    return std::uint32_t(number[v]);
  };
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    for (const std::size_t k : {0, 2, 1}) {  // seen from its underside
      mesh.indices.push_back(vertex(std::size_t(film.mesh().triangles[t][k])));
    }
  }
  return mesh;
}

Json matte(const std::string& name) {
  Json material;
  material["name"] = name;
  material["pbrMetallicRoughness"] = {{"metallicFactor", 0.0}, {"roughnessFactor", 0.6}};
  material["doubleSided"] = true;
  return material;
}

Json plain(const std::string& name, const LinearColor& color) {
  const auto channel = [](float value) { return std::clamp(value, 0.0f, 1.0f); };
  Json material = matte(name);
  material["pbrMetallicRoughness"]["baseColorFactor"] = {channel(color.r), channel(color.g),
                                                         channel(color.b), 1.0};
  return material;
}

// Draws nothing: what is not there in one of the variants.
Json hidden() {
  Json material = matte("hidden");
  material["pbrMetallicRoughness"]["baseColorFactor"] = {1.0, 1.0, 1.0, 0.0};
  material["alphaMode"] = "MASK";
  material["alphaCutoff"] = 0.5;
  return material;
}

LinearColor tinted_over(const LinearColor& color, const LinearColor& tint,
                        const LinearColor& base) {
  const float alpha = std::clamp(color.a * tint.a, 0.0f, 1.0f);
  const auto mix = [&](float c, float t, float b) { return b + alpha * (c * t - b); };
  return {mix(color.r, tint.r, base.r), mix(color.g, tint.g, base.g), mix(color.b, tint.b, base.b),
          1};
}

// A texture as it looks on the bare object, with the material's colour.
Image painted(const Image& texture, const LinearColor& tint, const LinearColor& base) {
  Image result = texture;
  CheckEvery check(1 << 14);
  for (std::size_t i = 0; i < result.rgba.size(); i += 4) {
    check();
    std::uint8_t* p = result.rgba.data() + i;
    const LinearColor color{srgb8_to_linear(p[0]), srgb8_to_linear(p[1]), srgb8_to_linear(p[2]),
                            float(p[3]) / 255};
    const LinearColor c = tinted_over(color, tint, base);
    p[0] = linear_to_srgb8(c.r);
    p[1] = linear_to_srgb8(c.g);
    p[2] = linear_to_srgb8(c.b);
    p[3] = 255;
  }
  return result;
}

int gltf_wrap(Wrap wrap) {
  if (wrap == Wrap::kRepeat) return 10497;
  return wrap == Wrap::kMirror ? 33648 : kGlbClampToEdge;
}

bool is_textured(const Object& object, const Material& material) {
  return material.texture >= 0 && !object.uvs.empty();
}

// JPEG files of the materials' textures; empty for materials without.
std::vector<ImageFile> wanted_pictures(const Object& object, const LinearColor& base,
                                       int texture_px) {
  std::vector<ImageFile> pictures(object.materials.size());
  parallel_for(pictures.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Material& m = object.materials[n];
      if (!is_textured(object, m)) continue;
      const Image& texture = *object.textures[std::size_t(m.texture)];
      pictures[n] =
          encode_jpeg(painted(shrink_to(texture, texture_px), m.base_color, base), kJpegQuality);
    }
  });
  return pictures;
}

// The model's own materials; the object's vertex colours, if any, multiply them.
std::vector<int> add_wanted_materials(GlbWriter& glb, const Object& object, const LinearColor& base,
                                      const std::vector<ImageFile>& pictures) {
  std::vector<int> numbers;
  for (std::size_t n = 0; n < pictures.size(); ++n) {
    const Material& m = object.materials[n];
    const std::string name = "wanted " + m.name;
    if (!is_textured(object, m)) {
      const LinearColor white{1, 1, 1, 1};
      numbers.push_back(glb.add_material(
          plain(name, object.colors.empty() ? tinted_over(m.base_color, white, base) : white)));
      continue;
    }
    Json material = matte(name);
    const int texture =
        glb.add_texture(pictures[n], "image/jpeg", name, gltf_wrap(m.wrap_u), gltf_wrap(m.wrap_v));
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
    numbers.push_back(glb.add_material(material));
  }
  return numbers;
}

// Vertex colours as they look on the bare object.
void add_colors(GlbMesh& mesh, const ShownObject& shown, const Object& object,
                const LinearColor& base) {
  mesh.colors.resize(shown.vertices.size());
  for (const ShownGroup& group : shown.groups) {
    const Material& material = object.materials[std::size_t(group.material)];
    const bool textured = is_textured(object, material);
    for (std::size_t i = group.begin; i < group.begin + group.count; ++i) {
      const auto v = std::size_t(shown.indices[i]);
      const auto& c = shown.vertices[v].color;
      const LinearColor tint = textured ? LinearColor{1, 1, 1, 1} : material.base_color;
      const LinearColor seen = tinted_over({c[0], c[1], c[2], c[3]}, tint, base);
      mesh.colors[v] = {seen.r, seen.g, seen.b, 1};
    }
  }
}

// The object: bare as predicted, in its own colours as wanted. Vertex colours cannot be switched
// off, so that an object that has them comes twice.
void add_object(GlbWriter& glb, const Object& object, const ShownObject& shown,
                const std::vector<ImageFile>& pictures, const LinearColor& base, int bare,
                int nothing) {
  GlbMesh mesh = object_vertices(shown, object);
  mesh.indices = shown.indices;
  if (mesh.indices.empty()) return;
  if (!object.has_appearance()) {
    mesh.uvs.clear();
    glb.add_mesh("object", mesh, {{0, mesh.indices.size(), bare, bare}});
    return;
  }
  const std::vector<int> wanted = add_wanted_materials(glb, object, base, pictures);
  const bool twice = !object.colors.empty();
  std::vector<GlbPart> parts, colored;
  for (const ShownGroup& group : shown.groups) {
    const int own = wanted[std::size_t(group.material)];
    parts.push_back({group.begin, group.count, bare, twice ? nothing : own});
    colored.push_back({group.begin, group.count, nothing, own});
  }
  glb.add_mesh("object", mesh, parts);
  if (!twice) return;
  add_colors(mesh, shown, object, base);
  glb.add_mesh("wanted", mesh, colored);
}

void add_film(GlbWriter& glb, const GlbMesh& mesh, const ImageFile& picture, int nothing) {
  if (picture.empty()) return;
  Json printed = matte("film");
  const int texture = glb.add_texture(picture, "image/png", "film image");
  printed["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
  glb.add_mesh("film", mesh, {{0, mesh.indices.size(), glb.add_material(printed), nothing}});
}

}  // namespace

void write_preview_glb(const std::filesystem::path& path, const Object& object,
                       const Surface& surface, const DippedFilm& film, const Image& film_image,
                       double sheet_width_mm, double sheet_height_mm, const LinearColor& base,
                       int texture_px) {
  const Crop crop = crop_to_film(film, film_image, sheet_width_mm, sheet_height_mm, texture_px);
  const bool has_film = crop.width > 0;
  ShownObject shown;
  std::vector<ImageFile> pictures;
  GlbMesh laid;
  ImageFile film_picture;
  parallel_do({
      [&] { shown = shown_object(object, std::numeric_limits<std::size_t>::max()); },
      [&] { pictures = wanted_pictures(object, base, texture_px); },
      [&] {
        if (has_film)
          laid = film_mesh(surface, film, film_image, crop, sheet_width_mm, sheet_height_mm);
      },
      [&] {
        if (has_film) film_picture = encode_png(film_texture(film_image, crop, base));
      },
  });

  GlbWriter glb;
  const int bare = glb.add_material(plain("object", base));
  int nothing = bare;
  if (object.has_appearance()) {
    glb.add_variants();
    nothing = glb.add_material(hidden());
  }
  add_object(glb, object, shown, pictures, base, bare, nothing);
  add_film(glb, laid, film_picture, nothing);
  const std::vector<std::uint8_t> bytes = glb.finish();
  write_file(path, bytes.data(), bytes.size());
}

}  // namespace hydrodip
