// Ways into the water other than straight down, against solutions in closed form or as ordinary
// differential equations.
#include <gtest/gtest.h>

#include "base/error.h"
#include "exact/paths.h"

namespace hydrodip {
namespace {

using namespace exact;

constexpr double kBar_mm = 0.02;

// The figures of an independent integration, given to about 3e-4 mm.
TEST(PathSolutions, OfARolledCylinder) {
  const RolledCylinder rolled;
  const RolledCylinder::Side right = rolled.solved(1), left = rolled.solved(-1);
  const auto psi = [](double x) { return std::asin(x / 30); };
  EXPECT_NEAR(right.at(psi(10)), 10.1057, 4e-4);
  EXPECT_NEAR(right.at(psi(20)), 21.0843, 4e-4);
  EXPECT_NEAR(right.at(psi(25)), 27.6962, 4e-4);
  EXPECT_NEAR(right.at(psi(29)), 35.3908, 4e-4);
  EXPECT_NEAR(30 * std::sin(right.psi.back()), 29.666, 1e-3);
  EXPECT_NEAR(right.u.back(), 37.791, 1e-3);
  EXPECT_NEAR(left.at(psi(-10)), -10.0518, 4e-4);
  EXPECT_NEAR(left.at(psi(-20)), -20.4025, 4e-4);
  EXPECT_NEAR(left.at(psi(-25)), -25.9272, 4e-4);
  EXPECT_NEAR(left.at(psi(-26)), -27.1259, 4e-4);
}

// Straight down, log((L - u) / (L - x)) is a mere integral over x.
TEST(PathSolutions, OfACylinderStraightDown) {
  const RolledCylinder straight{.shift = 0, .turn = 0};
  const RolledCylinder::Side right = straight.solved(1), left = straight.solved(-1);
  for (const double x : {5.0, 10.0, 20.0, 25.0}) {
    constexpr int kParts = 20000;
    double sum = 0;
    for (int n = 0; n < kParts; ++n) {
      const double at = (n + 0.5) * x / kParts;
      sum += std::hypot(1, kZStretch * at / std::sqrt(900 - at * at)) / (95 - at) * x / kParts;
    }
    const double u = 95 - 95 * std::exp(-sum), psi = std::asin(x / 30);
    EXPECT_NEAR(right.at(psi), u, 1e-5);
    EXPECT_NEAR(left.at(-psi), -u, 1e-5);
  }
}

TEST(PathSolutions, OfATwistedSphere) {
  const auto tan_theta = [](double a) { return a / std::sqrt(900 - a * a); };
  const RevolutionTable u(28.4, kZStretch, tan_theta);
  const std::vector<double> v = twisted({10, 20, 28}, kClampRadius, kZStretch, tan_theta, u,
                                        [](double a) { return 2 * kDegree * a / 28; });
  EXPECT_NEAR(v[0], -0.0413, 1e-4);
  EXPECT_NEAR(v[1], -0.1618, 1e-4);
  EXPECT_NEAR(v[2], -0.2958, 1e-4);
}

// On coarse film, too, and in long steps: the way of a step is that of its middle.
TEST(Path, RolledCylinderIsMetInLongSteps) {
  const PathError error = rolled_cylinder_error({}, 3000, 0.2);
  EXPECT_LE(error.largest_mm, 0.004);
  EXPECT_GT(error.reach_mm, 35);
  EXPECT_GT(error.vertices, 800);
}

TEST(PathSlow, RolledCylinderMeetsTheBarByDefault) {
  const PathError error = rolled_cylinder_error({}, 40000);
  EXPECT_LE(error.largest_mm, kBar_mm);
  EXPECT_GT(error.reach_mm, 38);
  EXPECT_GT(error.vertices, 3000);
}

TEST(PathSlow, TwistedSphereMeetsTheBarByDefault) {
  const PathError error = twisted_sphere_error(2, 40000);
  EXPECT_LE(error.largest_mm, kBar_mm);
  EXPECT_GT(error.reach_mm, 27.5);
  EXPECT_GT(error.vertices, 3000);
}

// ---- what must not change the film ----

// Half an ellipsoid that leans, in no symmetric place.
shapes::Shape egg() {
  shapes::Shape shape = shapes::revolve(
      [](double s) { return Vec2(18 * std::sin(M_PI * s), 12 * (1 - std::cos(M_PI * s))); }, 50,
      70);
  const Eigen::AngleAxisd tilt(0.3, Vec3(0.6, 0.8, 0));
  double bottom = 1e300;
  for (Vec3& p : shape.positions) {
    p = tilt * p + Vec3(-4.3, 2.1, 0);
    bottom = std::min(bottom, p.z());
  }
  for (Vec3& p : shape.positions) p.z() -= bottom;
  return shape;
}

shapes::Shape moved(shapes::Shape shape, const Eigen::Isometry3d& motion) {
  for (Vec3& p : shape.positions) p = motion * p;
  return shape;
}

FilmMesh square_film() {
  return make_film_mesh({.width_mm = 160, .height_mm = 160, .margin_mm = 10, .elements = 3000});
}

DippedFilm dipped_along(const shapes::Shape& shape, const Trajectory& trajectory) {
  DipOptions options;
  options.step_mm = 0.2;
  options.even_steps = true;
  options.material.tear_stretch = 0;
  return dip_along(shape, square_film(), trajectory, options).film;
}

// Largest distance between what one film covers, carried along by a motion, and another.
double apart(const DippedFilm& a, const DippedFilm& b,
             const Eigen::Isometry3d& motion = Eigen::Isometry3d::Identity()) {
  double largest = 0;
  int attached = 0, differ = 0;
  for (std::size_t v = 0; v < a.position.size(); ++v) {
    const bool on_a = a.state[v] == VertexState::kAttached;
    differ += on_a != (b.state[v] == VertexState::kAttached);
    if (!on_a || b.state[v] != VertexState::kAttached) continue;
    ++attached;
    largest = std::max(largest, (motion * a.position[v] - b.position[v]).norm());
  }
  EXPECT_GT(attached, 200);
  // Where the water ends a vertex may touch in one and just not in the other.
  EXPECT_LE(differ, 4);
  return largest;
}

TEST(PathInvariance, ThatSplittingItChangesNothing) {
  const Keyframe begin{.lower_mm = -1}, end{.lower_mm = 14, .shift_x_mm = 3, .turn_y_deg = 12};
  const Trajectory whole = Trajectory::through({begin, end});
  const Trajectory split =
      Trajectory::through({begin, whole.at(0.25), whole.at(0.5), whole.at(0.75), end});
  EXPECT_LT(apart(dipped_along(egg(), whole), dipped_along(egg(), split)), 2e-3);
}

TEST(PathInvariance, ThatMovingBeforeTheTouchIsMovingTheObject) {
  const Trajectory path = Trajectory::through({{.lower_mm = -9},
                                               {.lower_mm = -9, .shift_x_mm = 5, .shift_y_mm = 3},
                                               {.lower_mm = 12, .shift_x_mm = 5, .shift_y_mm = 3}});
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation() = Vec3(5, 3, 0);
  EXPECT_LT(apart(dipped_along(egg(), path),
                  dipped_along(moved(egg(), motion), Trajectory::straight_down(12)), motion),
            2e-3);
}

TEST(PathInvariance, ThatATurnedObjectGoesDownLikeOneThatWasMadeTurned) {
  const Keyframe turn{.turn_x_deg = 15, .turn_y_deg = -10, .turn_z_deg = 40};
  Eigen::Isometry3d motion = Trajectory::through({turn, turn}).bath_from_object(0);
  double low = 1e300;
  for (const Vec3& p : egg().positions) low = std::min(low, (motion * p).z());
  Keyframe begin = turn, end = turn;
  begin.lower_mm = low;
  end.lower_mm = low + 12;
  motion.translation().z() -= low;
  EXPECT_LT(apart(dipped_along(egg(), Trajectory::through({begin, end})),
                  dipped_along(moved(egg(), motion), Trajectory::straight_down(12)), motion),
            2e-3);
}

// The film's grid is the same after a quarter turn; its vertices have other numbers.
TEST(PathInvariance, ThatEverythingMayBeTurnedByAQuarter) {
  const FilmMesh film = square_film();
  Eigen::Isometry3d quarter = Eigen::Isometry3d::Identity();
  quarter.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Vec3 pivot(2, 1, 6);
  // About y before, about -x after.
  const DippedFilm before = dipped_along(
      egg(), Trajectory::through(
                 {{.lower_mm = -1}, {.lower_mm = 13, .shift_x_mm = 3, .turn_y_deg = 14}}, pivot));
  const DippedFilm after = dipped_along(
      moved(egg(), quarter),
      Trajectory::through({{.lower_mm = -1}, {.lower_mm = 13, .shift_y_mm = 3, .turn_x_deg = -14}},
                          quarter * pivot));
  double largest = 0;
  int attached = 0, differ = 0;
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    const Vec2 there = (quarter * Vec3(film.u[v].x(), film.u[v].y(), 0)).head<2>();
    for (std::size_t w = 0; w < film.u.size(); ++w) {
      if ((film.u[w] - there).norm() > 1e-9) continue;
      const bool on = before.state[v] == VertexState::kAttached;
      differ += on != (after.state[w] == VertexState::kAttached);
      if (!on || after.state[w] != VertexState::kAttached) continue;
      ++attached;
      largest = std::max(largest, (quarter * before.position[v] - after.position[w]).norm());
    }
  }
  EXPECT_GT(attached, 200);
  EXPECT_LE(differ, 4);
  EXPECT_LT(largest, 2e-3);
}

// What has been laid stays where it is when the object comes up again, and is known to be out.
TEST(Path, FilmThatIsLiftedOutStaysAndIsKnown) {
  const DippedFilm down = dipped_along(egg(), Trajectory::straight_down(12));
  const DippedFilm up = dipped_along(
      egg(), Trajectory::through({{}, {.lower_mm = 12}, {.lower_mm = 7}, {.lower_mm = 12}}));
  EXPECT_LT(apart(down, up), 0.02);
  int lifted = 0;
  for (std::size_t v = 0; v < up.position.size(); ++v) {
    EXPECT_FALSE(down.lifted[v]);
    if (up.state[v] != VertexState::kAttached) continue;
    const double z = up.position[v].z();
    if (z > 7.4 && z < 11.5) {
      EXPECT_TRUE(up.lifted[v]) << z;
    } else if (z < 6.9) {
      EXPECT_FALSE(up.lifted[v]) << z;
    }
    lifted += up.lifted[v];
  }
  EXPECT_GT(lifted, 30);
}

// Whatever an object does in the water, the film comes out whole in its topology: no vertex is
// without a place, what is on the object is on it.
TEST(Path, AnyWayEndsSoundly) {
  const shapes::Shape shape = egg();
  const Surface surface(shape.positions, shape.triangles);
  const std::vector<Trajectory> paths = {
      Trajectory::through({{}, {.lower_mm = 24, .turn_x_deg = 90}}, Vec3(0, 0, 12)),
      Trajectory::through(
          {{.lower_mm = -5}, {.lower_mm = 30, .shift_x_mm = 20, .turn_z_deg = 200}}),
      Trajectory::through({{},
                           {.lower_mm = 10},
                           {.lower_mm = -3, .shift_x_mm = 15},
                           {.lower_mm = 10, .shift_x_mm = 15}}),
      Trajectory::through({{},
                           {.lower_mm = 11},
                           {.lower_mm = 11, .shift_x_mm = 12},
                           {.lower_mm = 11, .shift_x_mm = -12}}),
      Trajectory::through({{}, {.lower_mm = 12}, {.lower_mm = 12, .turn_y_deg = 120}},
                          Vec3(0, 0, 12))};
  for (const Trajectory& path : paths)
    for (const double tear_stretch : {0.0, 1.4}) {
      DipOptions options;
      options.step_mm = 0.4;
      options.material.tear_stretch = tear_stretch;
      const DippedFilm film = dip_along(shape, square_film(), path, options).film;
      for (std::size_t v = 0; v < film.position.size(); ++v) {
        ASSERT_TRUE(film.position[v].allFinite());
        ASSERT_TRUE(std::isfinite(film.stretch[v]));
        if (film.state[v] == VertexState::kAttached) {
          ASSERT_TRUE(surface.closest_point(film.position[v], 0.01));
        }
      }
    }
}

TEST(Path, NeedsTheContactLineScheme) {
  DipOptions options;
  options.scheme = DipScheme::kPaper;
  EXPECT_THROW(dip_along(egg(), square_film(), Trajectory::through({{}, {5, 1}}), options),
               InputError);
  options = {};
  options.method = DipMethod::kProjection;
  EXPECT_THROW(dip_along(egg(), square_film(), Trajectory::through({{}, {5, 1}}), options),
               InputError);
}

}  // namespace
}  // namespace hydrodip
