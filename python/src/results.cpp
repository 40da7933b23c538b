#include "results.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "arrays.h"
#include "base/parallel.h"
#include "bindings.h"
#include "dip/principal_stretch.h"
#include "elastic/corotated.h"
#include "hydrodip/hydrodip.h"
#include "ink/discoloration.h"
#include "job/job_record.h"
#include "job/sheet_of.h"
#include "job/wanted.h"
#include "running.h"

namespace hydrodip::python {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// Where the object's normal is looked for if none is given.
constexpr double kNear_mm = 1;
constexpr double kFar = 1e6;
constexpr std::size_t kGrain = 1024;

struct FilmHandle {
  std::shared_ptr<const DippedFilm> film;
};

struct AirHandle {
  std::shared_ptr<const TrappedAir> air;
};

std::array<double, 3> plain(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

// As `hydrodip print` would report it, whose verdict the sheet's margin bears.
Report report_of(const Design& d, const RunContext& context) {
  const std::vector<ReportInput> inputs;
  const Timings times;
  JobRecord record{"print", d.job->config,    d.job->prepared,
                   inputs,  *d.finish,        times,
                   context, &d.designed->ink, d.job->printer.model->name()};
  record.wanted = wanted_coverage(d.dipped, d.finish->paint(),
                                  doubtful_stretch(d.job->config.design.dip.material));
  return make_report(record);
}

// ---- film ----

template <typename Value, typename Per>
py::array per_triangle(const FilmHandle& handle, const std::vector<py::ssize_t>& shape,
                       const Per& per) {
  const DippedFilm& film = *handle.film;
  std::vector<Value> values(film.mesh().triangles.size());
  for (std::size_t t = 0; t < values.size(); ++t) {
    const Triangle& v = film.mesh().triangles[t];
    std::array<Vec2, 3> flat;
    std::array<Vec3, 3> placed;
    for (std::size_t k = 0; k < 3; ++k) {
      flat[k] = film.mesh().u[std::size_t(v[k])];
      placed[k] = film.position[std::size_t(v[k])];
    }
    values[t] = per(flat, placed);
  }
  return taken<double>(std::move(values), shape);
}

py::array deformation_gradient_of(const FilmHandle& handle) {
  using Gradient = std::array<double, 6>;  // rows x, y, z
  return per_triangle<Gradient>(handle, {3, 2}, [](const auto& flat, const auto& placed) {
    const RestTriangle rest = rest_triangle(flat[0], flat[1], flat[2]);
    Gradient G{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 2; ++column)
          G[2 * row + column] +=
              placed[k][Eigen::Index(row)] * rest.gradient(Eigen::Index(k), Eigen::Index(column));
    return G;
  });
}

py::array principal_stretches_of(const FilmHandle& handle) {
  using Pair = std::array<double, 2>;
  return per_triangle<Pair>(handle, {2}, [](const auto& flat, const auto& placed) {
    const PrincipalStretches s = principal_stretches(flat, placed);
    return Pair{s.largest, s.least};
  });
}

py::array on_object_of(const FilmHandle& handle) {
  std::vector<std::uint8_t> lies(handle.film->mesh().triangles.size());
  for (std::size_t t = 0; t < lies.size(); ++t) lies[t] = handle.film->lies_on_object(t) ? 1 : 0;
  return taken<bool>(std::move(lies), {});
}

void bind_film(py::module_& m) {
  const auto array = [](auto member) {
    return [member](const FilmHandle& h) { return view((*h.film).*member, h.film); };
  };
  const auto flags = [](auto member) {
    return [member](const FilmHandle& h) { return view_of_flags((*h.film).*member, h.film); };
  };
  py::class_<FilmHandle>(m, "Film",
                         "The film after a dip. Arrays are read-only; views share its memory.")
      .def_property_readonly(
          "positions", array(&DippedFilm::position),
          "(vertices, 3) float64, mm: where the film is, in the posed object's frame. A view.")
      .def_property_readonly(
          "film_coordinates",
          [](const FilmHandle& h) { return view(h.film->mesh().u, h.film->shared_mesh); },
          "(vertices, 2) float64, mm: where it is printed, from the sheet's centre as seen from "
          "above. A view.")
      .def_property_readonly(
          "triangles",
          [](const FilmHandle& h) { return view(h.film->mesh().triangles, h.film->shared_mesh); },
          "(triangles, 3) int32: vertex numbers, counter-clockwise as seen from above on the flat "
          "film. A view.")
      .def_property_readonly(
          "state",
          [](const FilmHandle& h) {
            static_assert(sizeof(VertexState) == 1);
            return view<std::uint8_t>(h.film->state, {}, keep(h.film));
          },
          "(vertices,) uint8: 0 unattached, 1 attached, 2 clamped. A view.")
      .def_property_readonly("area_ratio", array(&DippedFilm::area_ratio),
                             "(vertices,) float64: area now over area printed. A view.")
      .def_property_readonly("stretch", array(&DippedFilm::stretch),
                             "(vertices,) float64: largest principal stretch around. A view.")
      .def_property_readonly("torn", flags(&DippedFilm::torn),
                             "(triangles,) bool: torn, or on the object upside down. A view.")
      .def_property_readonly("torn_at_mm", array(&DippedFilm::torn_at_mm),
                             "(triangles,) float64, mm: how far the object had travelled when it "
                             "tore; infinity: it did not. A view.")
      .def_property_readonly("wrinkled", flags(&DippedFilm::wrinkled),
                             "(triangles,) bool: on the object, pressed together to less than "
                             "material.wrinkle_stretch. A view.")
      .def_property_readonly(
          "lifted", flags(&DippedFilm::lifted),
          "(vertices,) bool: attached, and lifted out of the water again. A view.")
      .def_property_readonly("on_object", &on_object_of,
                             "(triangles,) bool: all corners attached and not torn.")
      .def_property_readonly("deformation_gradient", &deformation_gradient_of,
                             "(triangles, 3, 2) float64: d position / d film coordinate.")
      .def_property_readonly(
          "principal_stretches", &principal_stretches_of,
          "(triangles, 2) float64: largest and least, lengths now over lengths printed.")
      .def_property_readonly("depth_mm", [](const FilmHandle& h) { return h.film->depth_mm; })
      .def(
          "write",
          [](const FilmHandle& h, const std::filesystem::path& file) { write_film(file, *h.film); },
          py::arg("file"), "Writes film.ply as the program does: single precision, little-endian.");
}

// ---- figures ----

void bind_figures(py::module_& m) {
  py::class_<Coverage>(m, "Coverage",
                       "What a dip amounts to: areas in mm^2, stretches of film on the object.")
      .def_readonly("object_mm2", &Coverage::object_mm2)
      .def_readonly("downward_mm2", &Coverage::downward_mm2)
      .def_readonly("covered_mm2", &Coverage::covered_mm2)
      .def_readonly("covered_downward_mm2", &Coverage::covered_downward_mm2)
      .def_readonly("doubtful_mm2", &Coverage::doubtful_mm2)
      .def_readonly("film_on_object_mm2", &Coverage::film_on_object_mm2)
      .def_readonly("torn_mm2", &Coverage::torn_mm2)
      .def_readonly("wrinkled_mm2", &Coverage::wrinkled_mm2)
      .def_readonly("lifted_mm2", &Coverage::lifted_mm2)
      .def_readonly("stretch_mean", &Coverage::stretch_mean)
      .def_readonly("stretch_max", &Coverage::stretch_max)
      .def_readonly("area_ratio_mean", &Coverage::area_ratio_mean)
      .def_readonly("area_ratio_max", &Coverage::area_ratio_max)
      .def_property_readonly("covered_share", &Coverage::covered_share)
      .def_property_readonly("covered_downward_share", &Coverage::covered_downward_share)
      .def_property_readonly("doubtful_share", &Coverage::doubtful_share)
      .def_property_readonly("torn_share", &Coverage::torn_share);
  py::class_<AirPocket>(m, "AirPocket", "Air in one hollow: mm^2 of dry surface, mm^3.")
      .def_readonly("area_mm2", &AirPocket::area_mm2)
      .def_readonly("volume_mm3", &AirPocket::volume_mm3)
      .def_readonly("closed_at_mm", &AirPocket::closed_at_mm)
      .def_readonly("escapes_share", &AirPocket::escapes_share)
      .def_property_readonly("top", [](const AirPocket& p) { return plain(p.top); });
  py::class_<AirHandle>(m, "Air", "Air that the object takes into the water.")
      .def_property_readonly("area_mm2", [](const AirHandle& h) { return h.air->area_mm2(); })
      .def_property_readonly("volume_mm3", [](const AirHandle& h) { return h.air->volume_mm3(); })
      .def_property_readonly("pockets", [](const AirHandle& h) { return h.air->pockets; })
      .def_property_readonly("cell_mm", [](const AirHandle& h) { return h.air->cell_mm; })
      .def_property_readonly(
          "pocket_of_face",
          [](const AirHandle& h) { return view<std::int32_t>(h.air->pocket_of, {}, keep(h.air)); })
      .def_property_readonly("lid_vertices",
                             [](const AirHandle& h) { return view(h.air->lids.positions, h.air); })
      .def_property_readonly("lid_faces",
                             [](const AirHandle& h) { return view(h.air->lids.triangles, h.air); });
  py::class_<DipStatistics>(m, "Statistics", "Sums over all steps of a dip.")
      .def_readonly("steps", &DipStatistics::steps)
      .def_readonly("iterations", &DipStatistics::iterations)
      .def_readonly("unconverged_steps", &DipStatistics::unconverged_steps)
      .def_readonly("failed_steps", &DipStatistics::failed_steps)
      .def_readonly("largest_residual_mm", &DipStatistics::largest_residual_mm);
}

// ---- a dip ----

// What was found for every row, NaN where nothing was.
template <int kWidth, typename Find>
py::array each(py::ssize_t count, const Find& find) {
  std::vector<std::array<double, kWidth>> found(static_cast<std::size_t>(count));
  {
    const py::gil_scoped_release release;
    parallel_for(found.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        found[n].fill(kNone);
        if (const auto there = find(n))
          for (std::size_t k = 0; k < kWidth; ++k) found[n][k] = (*there)[Eigen::Index(k)];
      }
    });
  }
  return taken<double>(std::move(found), {kWidth});
}

py::array to_object(const Simulation& s, const Rows& film_points) {
  const py::ssize_t count = require_rows(film_points, 2, "points of the film");
  const double* at = film_points.data();
  const TriangleMesh& mesh = s.dipped.posed.mesh();
  return each<3>(count, [&](std::size_t n) -> std::optional<Vec3> {
    const auto point = s.dipped.map->to_object(Vec2(at[2 * n], at[2 * n + 1]));
    if (!point) return std::nullopt;
    return position_at(mesh, *point);
  });
}

py::array to_film(const Simulation& s, const Rows& points, const py::object& given_normals) {
  const py::ssize_t count = require_rows(points, 3, "points of the object");
  Rows normals;
  if (!given_normals.is_none()) {
    normals = given_normals.cast<Rows>();
    if (require_rows(normals, 3, "normals") != count)
      throw InputError("there have to be as many normals as points");
  }
  const double *at = points.data(), *up = given_normals.is_none() ? nullptr : normals.data();
  const Surface& surface = s.dipped.posed.surface();
  return each<2>(count, [&](std::size_t n) -> std::optional<Vec2> {
    const Vec3 place(at[3 * n], at[3 * n + 1], at[3 * n + 2]);
    if (!place.allFinite()) return std::nullopt;
    if (up != nullptr)
      return s.dipped.map->to_film(place, Vec3(up[3 * n], up[3 * n + 1], up[3 * n + 2]));
    const auto hit = surface.closest_point(place, kNear_mm);
    if (!hit) return std::nullopt;
    return s.dipped.map->to_film(place, surface.normal(*hit));
  });
}

// What rays meet: face and weights of its second and third corner, place, film triangle and film
// coordinate there; -1 and NaN where there is none.
py::tuple see(const Simulation& s, const Rows& origins, const std::array<double, 3>& along) {
  const auto count = std::size_t(require_rows(origins, 3, "the origins"));
  const Vec3 direction(along[0], along[1], along[2]);
  if (!(direction.norm() > 0 && direction.allFinite())) throw InputError("rays need a direction");
  std::vector<std::int32_t> face(count, -1), film_triangle(count, -1);
  std::vector<std::array<double, 2>> weights(count, {kNone, kNone}), film_point = weights;
  std::vector<std::array<double, 3>> place(count, {kNone, kNone, kNone});
  const Surface& surface = s.dipped.posed.surface();
  const double* at = origins.data();
  {
    const py::gil_scoped_release release;
    parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
      FilmMap::Cursor cursor;
      for (std::size_t n = begin; n < end; ++n) {
        const Vec3 origin(at[3 * n], at[3 * n + 1], at[3 * n + 2]);
        const auto hit = surface.first_hit(origin, direction, 0, kFar);
        if (!hit) continue;
        face[n] = hit->triangle;
        weights[n] = {hit->u, hit->v};
        const Vec3 there = surface.position(*hit);
        place[n] = plain(there);
        const auto u = s.dipped.map->to_film(there, surface.normal(*hit));
        if (!u) continue;
        film_point[n] = {u->x(), u->y()};
        if (s.dipped.map->to_object(*u, cursor)) film_triangle[n] = cursor.film_triangle;
      }
    });
  }
  return py::make_tuple(
      taken<std::int32_t>(std::move(face), {}), taken<double>(std::move(weights), {2}),
      taken<double>(std::move(place), {3}), taken<std::int32_t>(std::move(film_triangle), {}),
      taken<double>(std::move(film_point), {2}));
}

// sRGB bytes at points of the surface; black where there is no face, or weights are no numbers.
py::array colors_at(const Simulation& s, const py::object& face_numbers, const Rows& weights,
                    bool predicted) {
  const auto count = std::size_t(require_rows(weights, 2, "the weights"));
  const WholeNumbers face = whole_numbers(face_numbers, "the faces");
  if (std::size_t(face.size()) != count)
    throw InputError("there have to be as many faces as weights");
  const auto faces = std::int64_t(s.dipped.posed.mesh().triangles.size());
  std::vector<std::array<std::uint8_t, 3>> colors(count, {0, 0, 0});
  const Finish& finish = *s.finish;
  const std::int64_t* of = face.data();
  const double* w = weights.data();
  {
    const py::gil_scoped_release release;
    parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        if (of[n] < 0 || of[n] >= faces) continue;
        const SurfacePoint point{int(of[n]), w[2 * n], w[2 * n + 1]};
        if (!std::isfinite(point.u) || !std::isfinite(point.v)) continue;
        const LinearColor c = predicted ? finish.color_at(point) : finish.paint().color_at(point);
        colors[n] = {linear_to_srgb8(c.r), linear_to_srgb8(c.g), linear_to_srgb8(c.b)};
      }
    });
  }
  return taken<std::uint8_t>(std::move(colors), {3});
}

py::list frames_of(const Simulation& s) {
  py::list list;
  for (const DipFrame& frame : s.dipped.history->frames())
    list.append(py::make_tuple(frame.moment.travelled_mm,
                               view<float>(frame.position, {3}, keep(s.dipped.history))));
  return list;
}

py::array matrix_of(const Simulation& s) {
  const Eigen::Matrix4d& M = s.dipped.posed.matrix();
  std::vector<double> rows;
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index j = 0; j < 4; ++j) rows.push_back(M(i, j));
  return taken<double>(std::move(rows), {}).reshape(std::vector<py::ssize_t>{4, 4});
}

template <typename Owner>
py::array image_view(const BlankArray<std::uint8_t>& bytes, int width_px, int height_px,
                     const Owner& owner) {
  return view<std::uint8_t>(bytes, {}, keep(owner))
      .reshape(std::vector<py::ssize_t>{height_px, width_px, 4});
}

py::array render_picture(const Simulation& s, int width_px, const py::object& progress) {
  if (width_px < 64 || width_px > 8192) throw InputError("width_px has to be from 64 to 8192");
  const auto picture =
      run_for<std::shared_ptr<const Image>>(progress, [&](const RunContext& context) {
        return std::make_shared<const Image>(render(*s.finish, width_px, context));
      });
  return image_view(picture->rgba, picture->width_px, picture->height_px, picture);
}

void bind_dip(py::module_& m) {
  py::class_<Simulation>(m, "Simulation", "A dip that was computed. It never changes.")
      .def_property_readonly(
          "film", [](const Simulation& d) { return FilmHandle{d.dipped.film}; },
          "Where the film is: a Film.")
      .def_property_readonly(
          "air", [](const Simulation& d) { return AirHandle{d.dipped.air}; },
          "Air that hollows keep: an Air.")
      .def_property_readonly(
          "vertices",
          [](const Simulation& d) { return view(d.dipped.posed.mesh().positions, d.dipped.posed); },
          "(n, 3) float64, mm: the object as it hangs over the bath (posed-object frame). A view.")
      .def_property_readonly(
          "faces",
          [](const Simulation& d) { return view(d.dipped.posed.mesh().triangles, d.dipped.posed); },
          "(m, 3) int32: its triangles, checked and mended. A view.")
      .def_property_readonly(
          "pose_matrix", &matrix_of,
          "(4, 4) float64: from the model's coordinates in mm to the posed-object frame.")
      .def_property_readonly(
          "coverage", [](const Simulation& d) { return d.dipped.coverage; },
          "What the dip amounts to, in mm^2 and shares.")
      .def_property_readonly(
          "statistics", [](const Simulation& d) { return d.dipped.statistics; },
          "How the computation went.")
      .def_property_readonly(
          "frames", &frames_of,
          "Up to 32 moments of the dip: (travelled in mm, (vertices, 3) float32 positions). Views.")
      .def_property_readonly(
          "warnings", [](const Simulation& d) { return py::tuple(py::cast(d.warnings)); },
          "Sentences about what was tolerated.")
      .def_property_readonly(
          "depth_mm", [](const Simulation& d) { return d.dipped.film->depth_mm; },
          "Of the object's deepest point in the end, mm.")
      .def("to_object", &to_object, py::arg("points"),
           "Where points (k, 2) of the film, mm, end up: (k, 3) in the posed-object frame, mm; NaN "
           "where the film does not lie on the object.")
      .def("to_film", &to_film, py::arg("points"), py::arg("normals") = py::none(),
           "Which point of the film, (k, 2) mm, lands at points (k, 3) of the object with those "
           "unit "
           "normals (else those of the nearest surface); NaN where it stays bare.")
      .def(
          "see", &see, py::arg("origins"), py::arg("direction"),
          "What parallel rays from (k, 3) meet of the object: face (k,), weights of its second and "
          "third corner (k, 2), place (k, 3) mm, film triangle (k,), film coordinate (k, 2) mm; -1 "
          "and NaN where there is none.")
      .def("colors_at", &colors_at, py::arg("faces"), py::arg("weights"),
           py::arg("predicted") = true,
           "(k, 3) uint8: sRGB at points of the object, as see() names them, predicted or wanted.");
  m.def("render", &render_picture);
}

// ---- a design ----

py::list rounds_of(const Design& d) {
  py::list list;
  for (const InkRound& round : d.designed->ink.rounds)
    list.append(py::dict(py::arg("change_mm") = round.change_mm,
                         py::arg("printed_mm2") = round.printed_mm2,
                         py::arg("mean_modulus") = round.mean_modulus));
  return list;
}

py::array print_image_of(const Design& d) {
  std::shared_ptr<const Image> look;
  {
    const py::gil_scoped_release release;
    const Inking& laid = d.designed->ink.ink.inking;
    look =
        std::make_shared<const Image>(look_on_film(laid.inks, laid.printed, *d.job->printer.model));
  }
  return image_view(look->rgba, look->width_px, look->height_px, look);
}

void bind_design(py::module_& m) {
  py::class_<Design, Simulation>(m, "Design", "What to print, and the dip of it.")
      .def_property_readonly(
          "film_image",
          [](const Design& d) {
            const Image& i = d.designed->ink.ink.wanted;
            return image_view(i.rgba, i.width_px, i.height_px, d.designed);
          },
          "(rows, columns, 4) uint8: what shall appear on the object, laid on the film, sRGB with "
          "straight alpha, seen from above; row 0 is the +y edge. Not what print.png shows, which "
          "is "
          "print_image. A view.")
      .def_property_readonly(
          "print_image", &print_image_of,
          "(rows, columns, 4) uint8: print.png of a film whose ink side is up: what the inks look "
          "like on the flat sheet, before the dip, over white; transparent where nothing is "
          "printed.")
      .def_property_readonly(
          "inks",
          [](const Design& d) {
            const InkImage& i = d.designed->ink.ink.inking.inks;
            return image_view(i.cmyk, i.width_px, i.height_px, d.designed);
          },
          "(rows, columns, 4) uint8: cyan, magenta, yellow, black to print, 0 to 255. A view.")
      .def_property_readonly(
          "on_object_image",
          [](const Design& d) {
            const std::shared_ptr<const Image>& i = d.finish->coats().front().look;
            return image_view(i->rgba, i->width_px, i->height_px, i);
          },
          "(rows, columns, 4) uint8: what each pixel will look like on the object; transparent "
          "where "
          "no film lies on it. A view.")
      .def_property_readonly(
          "dpi", [](const Design& d) { return d.designed->raster.dpi; },
          "Pixels per inch of these.")
      .def_property_readonly(
          "settled", [](const Design& d) { return d.designed->ink.settled; },
          "Whether ink and film agree.")
      .def_property_readonly("rounds", &rounds_of,
                             "What each round of dipping and printing changed.")
      .def_property_readonly(
          "out_of_reach_share",
          [](const Design& d) { return d.designed->ink.reach.out_of_reach_share(); },
          "Of the printed surface: where the printer cannot give the wanted colour.")
      .def(
          "write_sheet",
          [](const Design& d, const std::filesystem::path& folder, const py::object& progress) {
            run(progress, [&](const RunContext& context) {
              write_sheet(folder, *d.designed, d.job->printer,
                          sheet_of(d.job->config, d.designed->dipped.posed, report_of(d, context)),
                          context);
            });
          },
          py::arg("folder"), py::arg("progress") = py::none(),
          "Writes print.png, print.tif and print.pdf into the folder: all, or none.");
}

}  // namespace

void bind_results(py::module_& m) {
  bind_film(m);
  bind_figures(m);
  bind_dip(m);
  bind_design(m);
}

}  // namespace hydrodip::python
