#include "model.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>

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

void set_uvs(Object& object, const Rows& uv) {
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
      if (!std::isfinite(at[2 * n]) || !std::isfinite(at[2 * n + 1]))
        throw InputError("the uv has a number that is not finite");
      object.uvs[t][k] = Eigen::Vector2f(float(at[2 * n]), float(at[2 * n + 1]));
    }
}

void set_colors(Object& object, const Bytes& colors) {
  if (colors.ndim() != 2 || std::size_t(colors.shape(0)) != object.positions.size() ||
      colors.shape(1) < 3 || colors.shape(1) > 4)
    throw InputError("the colors have to be an array of bytes of shape (vertices, 3 or 4)");
  object.colors.resize(object.triangles.size());
  for (std::size_t t = 0; t < object.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint8_t* c = colors.data(object.triangles[t][k], 0);
      object.colors[t][k] = {srgb8_to_linear(c[0]), srgb8_to_linear(c[1]), srgb8_to_linear(c[2]),
                             colors.shape(1) == 4 ? float(c[3]) / 255 : 1.0F};
    }
}

void check_indices(const Object& object) {
  for (const Triangle& t : object.triangles)
    for (const std::int32_t v : t)
      if (std::size_t(v) >= object.positions.size())
        throw InputError("a face has a vertex number that cannot be: there are " +
                         std::to_string(object.positions.size()) + " vertices");
}

LoadedObject loaded_of(const Model& model) {
  return {*model.object, model.health, model.units, model.files, {}};
}

ModelHandle make_model(const Rows& vertices, const py::array& faces, const py::object& uv,
                       const py::object& texture, const py::object& colors) {
  Object object;
  object.positions.resize(std::size_t(require_rows(vertices, 3, "the vertices")));
  std::copy_n(vertices.data(), vertices.size(), object.positions.data()->data());
  object.triangles = triangles_from(faces);
  check_indices(object);
  if (!uv.is_none()) set_uvs(object, uv.cast<Rows>());
  if (!colors.is_none()) set_colors(object, colors.cast<Bytes>());
  object.materials.resize(1);
  if (!texture.is_none()) {
    if (uv.is_none()) throw InputError("a texture needs uv, which say where it lies");
    object.textures.push_back(
        std::make_shared<const Image>(image_from(texture.cast<Bytes>(), "the texture")));
    object.materials[0].texture = 0;
  }
  return run_for<ModelHandle>(py::none(), [&](const RunContext& context) {
    const RunScope scope(context);
    return ModelHandle{
        std::make_shared<const LoadedObject>(loaded_of(model_from(std::move(object))))};
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
    const auto image = std::make_shared<const Image>(load_image(file));
    return view<std::uint8_t>(image->rgba, {}, keep(image))
        .reshape(std::vector<py::ssize_t>{image->height_px, image->width_px, 4});
  });
  m.def("write_png", [](const std::filesystem::path& file, const Bytes& pixels) {
    write_png(file, image_from(pixels, "the picture"));
  });
}

}  // namespace hydrodip::python
