#include "model.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "arrays.h"
#include "base/run_scope.h"
#include "bindings.h"
#include "hydrodip/hydrodip.h"
#include "image/files.h"
#include "image/image.h"
#include "running.h"

namespace hydrodip::python {

namespace {

using Bytes = py::array_t<std::uint8_t, py::array::c_style>;

Image image_from(const Bytes& pixels, const std::string& what) {
  if (pixels.ndim() != 3 || pixels.shape(2) < 3 || pixels.shape(2) > 4 || pixels.size() == 0)
    throw InputError(what + " has to be an array of bytes of shape (rows, columns, 3 or 4)");
  const auto channels = std::size_t(pixels.shape(2));
  Image image(int(pixels.shape(1)), int(pixels.shape(0)));
  const std::uint8_t* from = pixels.data();
  for (std::size_t n = 0; n < image.rgba.size() / 4; ++n)
    for (std::size_t k = 0; k < 4; ++k)
      image.rgba[4 * n + k] = k < channels ? from[channels * n + k] : 255;
  return image;
}

template <typename Integer>
std::vector<Triangle> triangles_from(const py::array& given) {
  const py::array_t<Integer, py::array::c_style> faces(given);
  if (faces.ndim() != 2 || faces.shape(1) != 3)
    throw InputError("the faces have to be an array of shape (m, 3)");
  std::vector<Triangle> triangles(std::size_t(faces.shape(0)));
  const Integer* at = faces.data();
  for (Triangle& t : triangles)
    for (std::int32_t& v : t) {
      if (*at < 0 || *at > Integer(0x7fffffff))
        throw InputError("a face has a vertex number that cannot be");
      v = std::int32_t(*at++);
    }
  return triangles;
}

// Of int32 or int64.
std::vector<Triangle> triangles_from(const py::array& faces) {
  if (faces.dtype().kind() != 'i' && faces.dtype().kind() != 'u')
    throw InputError("the faces have to be whole numbers");
  return faces.itemsize() <= 4 && faces.dtype().kind() == 'i' ? triangles_from<std::int32_t>(faces)
                                                              : triangles_from<std::int64_t>(faces);
}

void set_uvs(Object& object, const py::object& given) {
  object.uvs.clear();
  if (given.is_none()) return;
  const auto uv = given.cast<Rows>();
  const auto vertices = py::ssize_t(object.positions.size()),
             faces = py::ssize_t(object.triangles.size());
  const bool per_vertex = uv.ndim() == 2 && uv.shape(0) == vertices && uv.shape(1) == 2;
  const bool per_corner =
      uv.ndim() == 3 && uv.shape(0) == faces && uv.shape(1) == 3 && uv.shape(2) == 2;
  if (!per_vertex && !per_corner)
    throw InputError("the uv has to be an array of shape (vertices, 2) or (faces, 3, 2)");
  const double* at = uv.data();
  object.uvs.resize(object.triangles.size());
  for (std::size_t t = 0; t < object.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t n = per_corner ? 3 * t + k : std::size_t(object.triangles[t][k]);
      object.uvs[t][k] = Eigen::Vector2f(float(at[2 * n]), float(at[2 * n + 1]));
      if (!object.uvs[t][k].allFinite())
        throw InputError("the uv has a number that is not finite, or beyond single precision");
    }
}

void set_colors(Object& object, const py::object& given) {
  object.colors.clear();
  if (given.is_none()) return;
  const auto colors = given.cast<Bytes>();
  const auto vertices = py::ssize_t(object.positions.size()),
             faces = py::ssize_t(object.triangles.size());
  const py::ssize_t channels = colors.ndim() < 2 ? 0 : colors.shape(colors.ndim() - 1);
  const bool per_vertex = colors.ndim() == 2 && colors.shape(0) == vertices;
  const bool per_corner = colors.ndim() == 3 && colors.shape(0) == faces && colors.shape(1) == 3;
  if (!(per_vertex || per_corner) || channels < 3 || channels > 4)
    throw InputError(
        "the colors have to be an array of bytes of shape (vertices, 3 or 4) or (faces, 3, 3 or "
        "4)");
  object.colors.resize(object.triangles.size());
  for (std::size_t t = 0; t < object.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t n = per_corner ? 3 * t + k : std::size_t(object.triangles[t][k]);
      const std::uint8_t* c = colors.data() + n * std::size_t(channels);
      object.colors[t][k] = {srgb8_to_linear(c[0]), srgb8_to_linear(c[1]), srgb8_to_linear(c[2]),
                             channels == 4 ? float(c[3]) / 255 : 1.0F};
    }
}

// Those of a model take the places of its own. Where it had none, what the picture shows is the
// colour, and no more what the material says.
void set_textures(Object& object, const py::object& given) {
  const auto pictures = given.cast<std::vector<Bytes>>();
  const bool had_some = !object.textures.empty();
  object.textures.clear();
  for (const Bytes& picture : pictures)
    object.textures.push_back(std::make_shared<const Image>(image_from(picture, "the texture")));
  for (Material& material : object.materials)
    if (pictures.empty()) {
      material.texture = -1;
    } else if (!had_some) {
      material.texture = 0;
      material.base_color = Material().base_color;
    }
}

void set_face_materials(Object& object, const py::object& numbers) {
  if (numbers.is_none()) {
    object.material_of.assign(object.triangles.size(), 0);
    return;
  }
  const WholeNumbers given = whole_numbers(numbers, "the face_materials");
  const auto materials = std::int64_t(object.materials.size());
  object.material_of.clear();
  for (py::ssize_t n = 0; n < given.size(); ++n) {
    if (given.at(n) < 0 || given.at(n) >= materials)
      throw InputError(
          fmt::format("a face has a material number that cannot be: the mesh has {} material{}",
                      materials, materials == 1 ? "" : "s"));
    object.material_of.push_back(int(given.at(n)));
  }
}

void set_vertices(Object& object, const py::object& given) {
  const auto vertices = given.cast<Rows>();
  object.positions.resize(std::size_t(require_rows(vertices, 3, "the vertices")));
  std::copy_n(vertices.data(), vertices.size(), object.positions.data()->data());
}

// If all faces have the same material, new ones have it too.
void set_faces(Object& object, const py::object& given) {
  object.triangles = triangles_from(given.cast<py::array>());
  std::vector<int>& materials = object.material_of;
  if (std::adjacent_find(materials.begin(), materials.end(), std::not_equal_to<>()) ==
      materials.end())
    materials.assign(object.triangles.size(), materials.empty() ? 0 : materials.front());
}

void check_indices(const Object& object) {
  for (const Triangle& t : object.triangles)
    for (const std::int32_t v : t)
      if (std::size_t(v) >= object.positions.size())
        throw InputError("a face has a vertex number that cannot be: there are " +
                         std::to_string(object.positions.size()) + " vertices");
}

// Faces may have been changed under what is said of each.
void check_faces(const Object& object) {
  const auto require = [&](std::size_t count, const char* name) {
    if (count != 0 && count != object.triangles.size())
      throw InputError(
          fmt::format("there are {0} faces, and {1} for {2}: set {1} for these faces, or to None",
                      object.triangles.size(), name, count));
  };
  require(object.uvs.size(), "uv");
  require(object.colors.size(), "colors");
  require(object.material_of.size(), "face_materials");
}

void check_textures(const Object& object) {
  const auto has_texture = [](const Material& material) { return material.texture >= 0; };
  if (object.uvs.empty() &&
      std::any_of(object.materials.begin(), object.materials.end(), has_texture))
    throw InputError("a texture needs uv, which say where it lies");
}

LoadedObject loaded_of(const Model& model) {
  return {*model.object, model.health, model.units, model.files, {}};
}

// `base` with other arrays, by the names that hydrodip.Mesh has for them; null: of these alone.
ModelHandle make_model(const ModelHandle* base, const py::dict& arrays) {
  Object object;
  object.materials.resize(1);
  if (base) object = base->loaded->object;
  const auto set = [&](const char* name, const auto& setter) {
    if (arrays.contains(name)) setter(object, arrays[name]);
  };
  set("vertices", set_vertices);
  set("faces", set_faces);
  check_indices(object);
  set("uv", set_uvs);
  set("colors", set_colors);
  set("face_materials", set_face_materials);
  set("textures", set_textures);
  check_faces(object);
  check_textures(object);
  return run_for<ModelHandle>(py::none(), [&](const RunContext& context) {
    const RunScope scope(context);
    LoadedObject loaded = loaded_of(model_from(std::move(object)));
    if (base && !arrays.contains("textures"))
      loaded.picture_problems = base->loaded->picture_problems;
    return ModelHandle{std::make_shared<const LoadedObject>(std::move(loaded))};
  });
}

ModelHandle load_model(const std::filesystem::path& file, const std::string& units,
                       const std::filesystem::path& texture, const py::object& progress) {
  return run_for<ModelHandle>(progress, [&](const RunContext& context) {
    const RunScope scope(context);
    return ModelHandle{
        std::make_shared<const LoadedObject>(load_object(file, {units, texture}, context))};
  });
}

py::object uv_of(const ModelHandle& model) {
  const Object& object = model.loaded->object;
  if (object.uvs.empty()) return py::none();
  static_assert(sizeof(CornerUv) == 6 * sizeof(float));
  return view<float>(object.uvs, {3, 2}, keep(model.loaded));
}

// As bytes, per corner: at a vertex faces may differ.
py::object colors_of(const ModelHandle& model) {
  const Object& object = model.loaded->object;
  if (object.colors.empty()) return py::none();
  std::vector<std::array<std::uint8_t, 12>> bytes(object.colors.size());
  for (std::size_t t = 0; t < bytes.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const LinearColor& c = object.colors[t][k];
      bytes[t][4 * k] = linear_to_srgb8(c.r);
      bytes[t][4 * k + 1] = linear_to_srgb8(c.g);
      bytes[t][4 * k + 2] = linear_to_srgb8(c.b);
      bytes[t][4 * k + 3] = std::uint8_t(std::lround(255 * std::clamp(c.a, 0.0F, 1.0F)));
    }
  return taken<std::uint8_t>(std::move(bytes), {3, 4});
}

std::vector<std::string> material_names_of(const ModelHandle& model) {
  std::vector<std::string> names;
  for (const Material& material : model.loaded->object.materials) names.push_back(material.name);
  return names;
}

std::vector<py::array> textures_of(const ModelHandle& model) {
  std::vector<py::array> list;
  for (const auto& texture : model.loaded->object.textures) {
    const py::array flat = view<std::uint8_t>(texture->rgba, {}, keep(texture));
    list.push_back(py::array(flat).reshape(
        std::vector<py::ssize_t>{texture->height_px, texture->width_px, 4}));
  }
  return list;
}

}  // namespace

void bind_model(py::module_& m) {
  py::class_<ModelHandle>(m, "Model")
      .def_property_readonly("vertices",
                             [](const ModelHandle& model) {
                               return view(model.loaded->object.positions, model.loaded);
                             })
      .def_property_readonly("faces",
                             [](const ModelHandle& model) {
                               return view(model.loaded->object.triangles, model.loaded);
                             })
      .def_property_readonly("uv", &uv_of)
      .def_property_readonly("colors", &colors_of)
      .def_property_readonly("materials", &material_names_of)
      .def_property_readonly("face_materials",
                             [](const ModelHandle& model) {
                               return view<std::int32_t>(model.loaded->object.material_of, {},
                                                         keep(model.loaded));
                             })
      .def_property_readonly("textures", &textures_of)
      .def_property_readonly("units", [](const ModelHandle& model) { return model.loaded->units; })
      .def_property_readonly("closed",
                             [](const ModelHandle& model) { return model.loaded->health.closed(); })
      .def_property_readonly(
          "findings", [](const ModelHandle& model) { return model.loaded->health.findings(); });
  m.def("make_model", &make_model);
  m.def("load_model", &load_model);
  m.def("sample_model", [](const std::string& name) {
    return ModelHandle{std::make_shared<const LoadedObject>(loaded_of(sample(name)))};
  });
  m.def("read_image", [](const std::filesystem::path& file) {
    const RunContext context;
    const RunScope scope(context);
    const auto image = std::make_shared<const Image>(load_image(file));
    for (const std::string& warning : context.warnings())
      if (PyErr_WarnEx(PyExc_UserWarning, warning.c_str(), 1) != 0) throw py::error_already_set();
    return view<std::uint8_t>(image->rgba, {}, keep(image))
        .reshape(std::vector<py::ssize_t>{image->height_px, image->width_px, 4});
  });
  m.def("write_png", [](const std::filesystem::path& file, const Bytes& pixels) {
    write_png(file, image_from(pixels, "the picture"));
  });
}

}  // namespace hydrodip::python
