// Pictures laid on the surface: where it can be unrolled, they lie as on paper.
#include <gtest/gtest.h>

#include <random>

#include "artwork/artwork.h"
#include "artwork/geodesic.h"
#include "artwork/placement.h"
#include "shapes.h"

namespace hydrodip {
namespace {

// Corners moved about in their own plane, so that no row of triangles is regular.
double jitter(std::mt19937& random) { return (double(random() % 2001) / 1000 - 1) * 0.3; }

// A sheet of irregular triangles.
TriangleMesh irregular(int n, const std::function<Vec3(double, double)>& at) {
  std::mt19937 random(7);
  TriangleMesh mesh = sheet(n, n, [](double s, double t) { return Vec3(s, t, 0); });
  for (Vec3& p : mesh.positions) {
    const bool inside = p.x() > 0 && p.x() < 1 && p.y() > 0 && p.y() < 1;
    if (inside) p += Vec3(jitter(random) / n, jitter(random) / n, 0);
    p = at(p.x(), p.y());
  }
  return mesh;
}

// Largest error of a surface's unrolled coordinates against closed-form ones, relative to the
// distance from the centre, which lies at (0, 0) of both.
double unrolling_error(const TriangleMesh& mesh, const Vec3& centre, const Vec3& right,
                       const Vec3& up, double reach,
                       const std::function<Vec2(const Vec3&)>& unrolled) {
  const auto object = posed(mesh);
  const auto hit = object.surface().closest_point(moved(object, centre), 10);
  const PolarMap map = polar_map(object.mesh(), {hit->triangle, hit->u, hit->v}, right, up, reach);
  double worst = 0;
  int seen = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec2 wanted = unrolled(mesh.positions[v]);
    if (wanted.norm() > reach || wanted.norm() < 0.05 * reach) continue;
    ++seen;
    worst = std::max(worst, (map.place_mm[v] - wanted).norm() / wanted.norm());
  }
  EXPECT_GT(seen, 100);
  return worst;
}

TEST(Wrap, OnAPlaneIsThePlane) {
  const TriangleMesh mesh =
      irregular(40, [](double s, double t) { return Vec3(80 * s, 80 * t, 0); });
  EXPECT_LT(unrolling_error(mesh, {37, 43, 0}, Vec3::UnitX(), Vec3::UnitY(), 35,
                            [](const Vec3& p) { return Vec2(p.x() - 37, p.y() - 43); }),
            1e-4);
}

TEST(Wrap, OnACylinderIsItsUnrolling) {
  constexpr double kRadius = 25, kArc = 100;  // less than all around
  const TriangleMesh mesh = irregular(60, [](double s, double t) {
    const double angle = kArc / kRadius * (s - 0.5);
    return Vec3(kRadius * std::sin(angle), -kRadius * std::cos(angle), 80 * t);
  });
  EXPECT_LT(unrolling_error(mesh, {0, -kRadius, 40}, Vec3::UnitX(), Vec3::UnitZ(), 35,
                            [](const Vec3& p) {
                              return Vec2(kRadius * std::atan2(p.x(), -p.y()), p.z() - 40);
                            }),
            0.005);
}

TEST(Wrap, OnAConeIsItsUnrolling) {
  // Half angle 30 degrees, tip at the origin, opening along z; slant 40 to 140 mm.
  const double sine = 0.5, cosine = std::sqrt(0.75);
  const TriangleMesh mesh = irregular(60, [&](double s, double t) {
    const double angle = 2.4 * (s - 0.5), slant = 40 + 100 * t;
    return Vec3(slant * sine * std::sin(angle), -slant * sine * std::cos(angle), slant * cosine);
  });
  const double middle = 90;
  const Vec3 centre(0, -middle * sine, middle * cosine);
  // Unrolled, the angle about the tip shrinks by the sine; up is away from the tip.
  EXPECT_LT(unrolling_error(mesh, centre, Vec3::UnitX(), Vec3(0, -sine, cosine), 35,
                            [&](const Vec3& p) {
                              const double angle = sine * std::atan2(p.x(), -p.y());
                              return Vec2(p.norm() * std::sin(angle),
                                          p.norm() * std::cos(angle) - middle);
                            }),
            0.005);
}

TEST(Wrap, OnASphereKeepsLengthsAndDirectionsFromTheCentre) {
  constexpr double kRadius = 30, kReach = 40;
  // Anywhere, and at a corner where rows of corners meet.
  for (const Vec3& towards : {Vec3(0.3, -0.8, 0.5), Vec3(0, -1, 0)}) {
    const PosedObject object = posed(ball(kRadius, 120, 60));
    const Vec3 middle = moved(object, Vec3::Zero()), out = towards.normalized();
    const Vec3 right = Vec3(0, 0, 1).cross(out).normalized(), up = out.cross(right);
    const auto hit = object.surface().closest_point(middle + kRadius * out, 1);
    const PolarMap map =
        polar_map(object.mesh(), {hit->triangle, hit->u, hit->v}, right, up, kReach);
    int seen = 0;
    for (std::size_t v = 0; v < map.place_mm.size(); ++v) {
      const Vec3 q = (object.mesh().positions[v] - middle).normalized();
      const double length = kRadius * std::acos(std::clamp(q.dot(out), -1.0, 1.0));
      if (length > kReach || length < 2) continue;
      ++seen;
      EXPECT_NEAR(map.place_mm[v].norm(), length, 0.005 * length);
      const double turn = std::atan2(q.dot(up), q.dot(right));
      const double found = std::atan2(map.place_mm[v].y(), map.place_mm[v].x());
      EXPECT_NEAR(std::remainder(found - turn, 2 * kPi), 0, 0.02);
    }
    EXPECT_GT(seen, 1000);
  }
}

TEST(Wrap, FollowsAnEdgeAsPaperDoes) {
  // Over a box's edge, 20 mm away on the next face, in big triangles that have to be cut first.
  const PosedObject object = posed(box({-30, -30, -30}, {30, 30, 30}));
  ArtworkLayer layer;
  layer.projection = Projection::kWrap;
  layer.at_mm = Vec3(0, -30, 15);
  layer.width_mm = 20;
  layer.height_mm = 60;
  WrapReport report;
  const Placed placed = place_wrapped({layer, 1, object, true}, report);
  const auto hit = object.surface().closest_point(moved(object, Vec3(3, -25, 30)), 1);
  Spot spot;
  ASSERT_TRUE(placed.placement->find({hit->triangle, hit->u, hit->v}, spot));
  EXPECT_NEAR(spot.place_mm.x(), 3, 0.01);
  EXPECT_NEAR(spot.place_mm.y(), 20, 0.01);
  EXPECT_NEAR(report.stretch_most, 1, 0.02);
  EXPECT_EQ(report.folded_mm2, 0);
}

TEST(Wrap, IsSeenUnmirroredOnASheetWhoseNormalsPointInward) {
  // Half a tube, open, turned inside out by its file.
  TriangleMesh half = sheet(60, 20, [](double s, double t) {
    const double angle = kPi * (s - 0.5);
    return Vec3(25 * std::sin(angle), -25 * std::cos(angle), 60 * t);
  });
  for (const bool inward : {false, true}) {
    if (inward)
      for (Triangle& t : half.triangles) std::swap(t[1], t[2]);
    const PosedObject object = posed(half);
    ArtworkLayer layer;
    layer.projection = Projection::kWrap;
    layer.at_mm = Vec3(0, -25, 30);
    layer.width_mm = 20;
    WrapReport report;
    const Placed placed = place_wrapped({layer, 1, object, false}, report);
    const Vec3 aside = moved(object, Vec3(25 * std::sin(0.2), -25 * std::cos(0.2), 34));
    const auto hit = object.surface().closest_point(aside, 1);
    Spot spot;
    ASSERT_TRUE(placed.placement->find({hit->triangle, hit->u, hit->v}, spot));
    // Seen from outside, from -y with z up, +x is to the right.
    EXPECT_NEAR(spot.place_mm.x(), 5, 0.05);
    EXPECT_NEAR(spot.place_mm.y(), 4, 0.05);
  }
}

TEST(Wrap, WarnsBeforeItFoldsOverItself) {
  const PosedObject object = posed(ball(20, 96, 48));
  ArtworkLayer layer;
  layer.projection = Projection::kWrap;
  layer.at_mm = Vec3(0, -20, 0);
  WrapReport report;
  layer.width_mm = 20;
  place_wrapped({layer, 1, object, true}, report);
  EXPECT_EQ(report.folded_mm2, 0);
  EXPECT_LT(report.stretch_most, 1.02);
  EXPECT_NEAR(report.stretch_least, std::sin(10 * std::sqrt(2.0) / 20) / (10 * std::sqrt(2.0) / 20),
              0.02);
  layer.width_mm = 100;  // its corners would meet behind
  place_wrapped({layer, 1, object, true}, report);
  EXPECT_GT(report.folded_mm2, 1);
}

TEST(Wrap, AsLargeAsFitsStaysFair) {
  const PosedObject object = posed(ball(20, 96, 48));
  ArtworkLayer layer;
  layer.projection = Projection::kWrap;
  layer.at_mm = Vec3(0, -20, 0);
  WrapReport report;
  const Placed placed = place_wrapped({layer, 2, object, true}, report);
  EXPECT_EQ(report.folded_mm2, 0);
  EXPECT_NEAR(placed.size_mm.x() / placed.size_mm.y(), 2, 1e-9);
  EXPECT_GT(placed.size_mm.x(), 20);
  EXPECT_GT(report.stretch_least, 0.75);
}

TEST(FineMesh, KeepsEveryPointWhereItIs) {
  const TriangleMesh coarse = box({0, 0, 0}, {3, 4, 5});
  const FineMesh fine(coarse, 7);
  EXPECT_EQ(fine.mesh().triangles.size(), coarse.triangles.size() * 49);
  // Closed: twice as many vertices as triangles have, less four.
  EXPECT_EQ(fine.mesh().positions.size(), fine.mesh().triangles.size() / 2 + 2);
  each_point(coarse, [&](const SurfacePoint& point) {
    const SurfacePoint there = fine.fine(point);
    EXPECT_LT((position_at(coarse, point) - position_at(fine.mesh(), there)).norm(), 1e-9);
    EXPECT_GE(there.u, -1e-9);
    EXPECT_GE(there.v, -1e-9);
    EXPECT_LE(there.u + there.v, 1 + 1e-9);
  });
}

}  // namespace
}  // namespace hydrodip
