#include "samples/samples.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "base/nearest_name.h"
#include "base/run_scope.h"
#include "image/files.h"
#include "samples/parts.h"

namespace hydrodip {
namespace {

struct Sample {
  SampleInfo info;
  Object (*make)();
};

const std::vector<Sample>& table() {
  static const std::vector<Sample> all = {
      {{"sphere", "a full sphere of radius 30 mm with a 5 mm checkerboard"}, make_sphere},
      {{"pyramid", "a square pyramid, 60 mm wide and 24 mm high, apex first, checkerboard"},
       make_pyramid},
      {{"ellipsoid", "a full ellipsoid of 90 x 60 x 48 mm with a 5 mm checkerboard"},
       make_ellipsoid},
      {{"mask", "a face mask of 99 x 130 mm with painted features"}, make_mask},
      {{"box", "a flat-bottomed box of 40 x 40 x 15 mm with vertical walls, checkerboard"},
       make_box},
  };
  return all;
}

const Sample& find_sample(const std::string& name) {
  const auto found = std::find_if(table().begin(), table().end(),
                                  [&](const Sample& sample) { return sample.info.name == name; });
  if (found != table().end()) return *found;
  std::vector<std::string> names;
  for (const Sample& sample : table()) names.push_back(sample.info.name);
  const std::string hint = did_you_mean(name, names);
  throw InputError(fmt::format(
      "there is no sample '{}'{}", name,
      hint.empty() ? fmt::format("; the samples are {}", fmt::join(names, ", ")) : hint));
}

std::string obj_text(const Object& object, const std::string& name) {
  std::string text = fmt::format(
      "# hydrodip sample: {}; millimetres, z up, dips towards -z\n"
      "mtllib {}.mtl\no {}\n",
      name, name, name);
  CheckEvery check(256);
  for (const Vec3& p : object.positions) {
    check();
    text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x(), p.y(), p.z());
  }
  // Corners that share a vertex and a texture coordinate share a vt line.
  std::vector<std::vector<std::pair<Eigen::Vector2f, long>>> known(object.positions.size());
  long count = 0;
  std::string faces = fmt::format("usemtl {}\n", name);
  for (std::size_t t = 0; t < object.triangles.size(); ++t) {
    check();
    faces += 'f';
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = std::size_t(object.triangles[t][k]);
      const Eigen::Vector2f uv = object.uvs[t][k];
      auto& at_vertex = known[vertex];
      auto found = std::find_if(at_vertex.begin(), at_vertex.end(),
                                [&](const auto& entry) { return entry.first == uv; });
      if (found == at_vertex.end()) {
        text += fmt::format("vt {:.8f} {:.8f}\n", uv.x(), uv.y());
        found = at_vertex.insert(at_vertex.end(), {uv, ++count});
      }
      faces += fmt::format(" {}/{}", vertex + 1, found->second);
    }
    faces += '\n';
  }
  return text + faces;
}

std::string mtl_text(const std::string& name) {
  return fmt::format("newmtl {}\nKd 1 1 1\nd 1\nillum 1\nmap_Kd {}.png\n", name, name);
}

}  // namespace

void rest_on_zero(Object& object) {
  const double lowest = object.bounds().min.z();
  for (Vec3& p : object.positions) p.z() -= lowest;
}

void set_planar_uvs(Object& object, double width_mm, double height_mm) {
  object.uvs.clear();
  for (const Triangle& triangle : object.triangles) {
    CornerUv uv;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = object.positions[std::size_t(triangle[k])];
      uv[k] = Eigen::Vector2f(float(0.5 - p.x() / width_mm), float(0.5 + p.y() / height_mm));
    }
    object.uvs.push_back(uv);
  }
}

void set_texture(Object& object, const std::string& name, Image image) {
  Material material;
  material.name = name;
  material.texture = 0;
  material.wrap_u = material.wrap_v = Wrap::kClamp;
  object.materials = {material};
  object.material_of.assign(object.triangles.size(), 0);
  object.textures = {std::make_shared<const Image>(std::move(image))};
}

const std::vector<SampleInfo>& samples() {
  static const std::vector<SampleInfo> infos = [] {
    std::vector<SampleInfo> list;
    for (const Sample& sample : table()) list.push_back(sample.info);
    return list;
  }();
  return infos;
}

Object make_sample(const std::string& name) { return find_sample(name).make(); }

std::vector<std::string> write_sample(const std::string& name, const Object& sample,
                                      const std::filesystem::path& folder) {
  write_file(folder / (name + ".obj"), obj_text(sample, name));
  write_file(folder / (name + ".mtl"), mtl_text(name));
  save_png(folder / (name + ".png"), *sample.textures.front());
  return {name + ".obj", name + ".mtl", name + ".png"};
}

}  // namespace hydrodip
