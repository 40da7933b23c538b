// Any shape: every dip ends, with finite results, film that is the right way up, and every attached
// vertex on the object.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "base/eigenpairs.h"
#include "dip/dip.h"
#include "dip/zoo_shapes.h"
#include "elastic/corotated.h"

namespace hydrodip {
namespace {

void expect_sound(const shapes::Shape& shape, const FilmOptions& film_options,
                  const DipOptions& options, const RunContext& context,
                  const TrajectoryOptions& way = {}) {
  const FilmMesh mesh = make_film_mesh(film_options);
  const Surface surface(shape.positions, shape.triangles);
  const Trajectory trajectory = make_trajectory(way, shape.positions);
  const DipResult result =
      dip(mesh, shape.positions, shape.triangles, surface, trajectory, options, context);
  const Eigen::Isometry3d end = trajectory.bath_from_object(1);
  const Vec3 up = end.linear().row(2).transpose();
  const DippedFilm& film = result.film;

  if (options.material.tear_stretch > 0) {
    EXPECT_EQ(result.statistics.unconverged_steps, 0);
  }

  long attached = 0;
  for (std::size_t v = 0; v < mesh.u.size(); ++v) {
    ASSERT_TRUE(film.position[v].allFinite());
    ASSERT_TRUE(std::isfinite(film.area_ratio[v]) && film.area_ratio[v] >= 0);
    ASSERT_TRUE(std::isfinite(film.stretch[v]) && film.stretch[v] >= 0);
    if (film.state[v] == VertexState::kClamped) {
      EXPECT_LT(((end * film.position[v]).head<2>() - mesh.u[v]).norm(), 1e-9);
    }
    if (film.state[v] == VertexState::kUnattached) {
      EXPECT_NEAR((end * film.position[v]).z(), 0, 1e-9);
    }
    if (film.state[v] != VertexState::kAttached) continue;
    ++attached;
    EXPECT_TRUE(surface.closest_point(film.position[v], 0.01)) << "vertex off the object";
  }
  EXPECT_GT(attached, 0);

  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (film.torn[t]) continue;
    const Triangle& v = mesh.triangles[t];
    const Vec3 &a = film.position[std::size_t(v[0])], &b = film.position[std::size_t(v[1])],
               &c = film.position[std::size_t(v[2])];
    const Vec3 normal = (b - a).cross(c - a);
    const bool floating = std::none_of(v.begin(), v.end(), [&](std::int32_t w) {
      return film.state[std::size_t(w)] == VertexState::kAttached;
    });
    if (floating) {
      EXPECT_GT(normal.dot(up), 0) << "floating film turned over";
    }
    if (!film.lies_on_object(t)) continue;
    const auto below = surface.closest_point((a + b + c) / 3, 1000);
    ASSERT_TRUE(below);
    EXPECT_LT(normal.dot(surface.normal(*below)), 0) << "film upside down on the object";
    const double limit = options.material.tear_stretch, lost = options.material.lost_stretch;
    const RestTriangle flat = rest_triangle(mesh.u[std::size_t(v[0])], mesh.u[std::size_t(v[1])],
                                            mesh.u[std::size_t(v[2])]);
    Eigen::Matrix<double, 3, 2> J =
        a * flat.gradient.row(0) + b * flat.gradient.row(1) + c * flat.gradient.row(2);
    if (limit > 0) {
      EXPECT_LE(std::sqrt(eigenpairs(J.transpose() * J).values.maxCoeff()), lost * (1 + 1e-9));
    }
  }
}

class Zoo : public ::testing::TestWithParam<int> {
 protected:
  Zoo() { options.step_mm = 0.5; }
  void expect_ends_soundly(const TrajectoryOptions& way = {}) {
    const auto animal = shapes::zoo()[std::size_t(GetParam())];
    SCOPED_TRACE(animal.name);
    expect_sound(animal.shape, shapes::zoo_film(), options, RunContext(), way);
  }
  DipOptions options;
};

TEST_P(Zoo, EndsSoundlyWithTears) { expect_ends_soundly(); }

TEST_P(Zoo, EndsSoundlyRolledIn) {
  TrajectoryOptions way;
  way.tilt_deg = 10;
  way.tilt_toward_deg = 30;
  way.roll_deg = 25;
  expect_ends_soundly(way);
}

TEST_P(Zoo, EndsSoundlyWithoutTears) {
  options.material.tear_stretch = 0;
  expect_ends_soundly();
}

INSTANTIATE_TEST_SUITE_P(Slow, Zoo, ::testing::Range(0, int(shapes::zoo().size())),
                         [](const auto& tested) {
                           std::string name = shapes::zoo()[std::size_t(tested.param)].name;
                           std::erase_if(name, [](char c) { return !std::isalnum(c); });
                           return name;
                         });

TEST(ZooSlow, TwoMillionTriangles) {
  const shapes::Shape shape = shapes::full_sphere(22, 1000, 1000);
  ASSERT_GT(shape.triangles.size(), 1990000u);
  RunContext context;
  DipOptions options;
  options.step_mm = 0.5;
  expect_sound(shape, shapes::zoo_film(), options, context, {.depth_mm = 20});
}

TEST(ZooSlow, WarnsWhenTheObjectTouchesTheRim) {
  FilmOptions film = shapes::zoo_film();
  film.width_mm = film.height_mm = 60;
  film.elements = 800;
  const shapes::Shape shape = shapes::box({-25, -5, 0}, {25, 5, 8});
  RunContext context;
  DipOptions options;
  options.step_mm = 0.5;
  expect_sound(shape, film, options, context);
  ASSERT_EQ(context.warnings().size(), 1u);
  EXPECT_NE(context.warnings()[0].find("rim"), std::string::npos);
}

}  // namespace
}  // namespace hydrodip
