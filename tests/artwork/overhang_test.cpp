// What rays that leave a triangle could meet, against the rays themselves and closed forms.
#include "artwork/overhang.h"

#include <gtest/gtest.h>

#include "object/surface.h"
#include "shapes.h"

namespace hydrodip {
namespace {

using Way = std::function<Vec3(const Vec3&)>;

const Way kUp = [](const Vec3&) { return Vec3(0, 0, 1); };
const Way kFromAxis = [](const Vec3& p) { return Vec3(p.x(), p.y(), 0).normalized(); };
const Way kFromCentre = [](const Vec3& p) { return p.normalized(); };

LeavingRays leaving(const TriangleMesh& mesh, int triangle, const Way& way) {
  LeavingRays rays{triangle, {}};
  for (std::size_t k = 0; k < 3; ++k)
    rays.ways[k] = way(mesh.positions[std::size_t(mesh.triangles[std::size_t(triangle)][k])]);
  return rays;
}

// Of those that face the way at all their corners, whether each is clear; asked as neighbours are.
std::map<int, bool> clear_of(const TriangleMesh& mesh, const Way& way) {
  const Overhang overhang(mesh);
  std::map<int, bool> clear;
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    std::vector<LeavingRays> together;
    for (const int other : overhang.together(t)) {
      together.push_back(leaving(mesh, other, way));
      const Vec3 normal = face_normal(mesh, other);
      for (const Vec3& w : together.back().ways)
        if (normal.dot(w) < 0.02) {
          together.pop_back();
          break;
        }
    }
    std::vector<std::uint8_t> answers;
    overhang.are_clear(together, answers);
    for (std::size_t i = 0; i < together.size(); ++i)
      if (together[i].triangle == t) clear[t] = answers[i] != 0;
  }
  return clear;
}

// Whether a ray meets something from any of many points of a triangle.
bool is_hit_anywhere(const TriangleMesh& mesh, const Surface& surface, int triangle,
                     const Way& way) {
  constexpr int kSteps = 24;
  for (int i = 1; i < kSteps; ++i)
    for (int j = 1; i + j < kSteps; ++j) {
      const Vec3 p = position_at(mesh, {triangle, double(i) / kSteps, double(j) / kSteps});
      if (surface.is_hit(p, way(p), 1e-2, 1e4)) return true;
    }
  return false;
}

// A plain of n x n cells under a small slab that floats above a corner of it.
TriangleMesh plain_with_slab() {
  TriangleMesh mesh = sheet(20, 20, [](double s, double t) { return Vec3(100 * s, 100 * t, 0); });
  append(mesh, box({11, 12, 30}, {23, 24, 35}));
  return mesh;
}

TEST(Overhang, OnAPlainIsWhatASlabCovers) {
  const TriangleMesh mesh = plain_with_slab();
  int clear = 0, covered = 0;
  for (const auto& [t, is_clear] : clear_of(mesh, kUp)) {
    Box3 box;
    for (const std::int32_t v : mesh.triangles[std::size_t(t)])
      box.add(mesh.positions[std::size_t(v)]);
    if (box.min.z() > 0) {
      EXPECT_EQ(is_clear, box.min.z() > 34) << t;
      continue;
    }
    // The slab's square reaches into cells 2 to 4 both ways; of two cells only one half.
    const bool beside =
        box.max.x() <= 11 || box.min.x() >= 23 || box.max.y() <= 12 || box.min.y() >= 24;
    const Vec3 a = mesh.positions[std::size_t(mesh.triangles[std::size_t(t)][1])];
    const bool lower = a.x() > box.min.x() && a.y() == box.min.y();
    const bool corner = (box.min.x() == 10 && box.min.y() == 20 && lower) ||
                        (box.min.x() == 20 && box.min.y() == 10 && !lower);
    if (corner) continue;  // beside the square's corner, or not: the rays' test tells
    EXPECT_EQ(is_clear, beside) << box.min.transpose();
    ++(is_clear ? clear : covered);
  }
  EXPECT_GT(clear, 700);
  EXPECT_GT(covered, 10);
}

TEST(Overhang, WhatIsClearNoRayMeetsAndWhatIsNotSomeRayDoes) {
  // Wavy ground with a ball over it, whose triangles cut those of the ground's shadow anyhow.
  TriangleMesh mesh = sheet(24, 18, [](double s, double t) {
    return Vec3(60 * s - 30, 60 * t - 30, 4 * std::sin(9 * s) * std::cos(7 * t) - 30);
  });
  TriangleMesh over = ball(9, 14, 9);
  for (Vec3& p : over.positions) p += Vec3(3, -5, 5);
  append(mesh, over);
  const Surface surface(mesh.positions, mesh.triangles);
  for (const Way& way : {kUp, Way([](const Vec3&) { return Vec3(0.3, -0.2, 1).normalized(); }),
                         Way([](const Vec3& p) { return (p - Vec3(5, 5, -200)).normalized(); })}) {
    int clear = 0, not_clear = 0, too_careful = 0;
    for (const auto& [t, is_clear] : clear_of(mesh, way)) {
      const bool is_hit = is_hit_anywhere(mesh, surface, t, way);
      EXPECT_FALSE(is_clear && is_hit) << t;
      if (!is_clear && !is_hit) ++too_careful;
      ++(is_clear ? clear : not_clear);
    }
    EXPECT_GT(clear, 500);
    EXPECT_GT(not_clear, 60);
    // Slivers between the points that were asked.
    EXPECT_LT(too_careful, 12);
  }
}

TEST(Overhang, InABowlNeighboursAreNotInTheWay) {
  // Every triangle is touched by others that rise above its plane.
  const TriangleMesh bowl = sheet(15, 15, [](double s, double t) {
    const Vec2 at(40 * s - 20, 40 * t - 20);
    return Vec3(at.x(), at.y(), 0.02 * at.squaredNorm());
  });
  const std::map<int, bool> clear = clear_of(bowl, kUp);
  EXPECT_EQ(clear.size(), bowl.triangles.size());
  for (const auto& [t, is_clear] : clear) EXPECT_TRUE(is_clear) << t;
}

TEST(Overhang, UprightWallsAreNotInTheWayOfTheFloorBetweenThem) {
  // A tray without a lid, in any position: walls stand in the planes that bound the floor's rays.
  TriangleMesh tray = sheet(4, 3, [](double s, double t) { return Vec3(40 * s, 30 * t, 0); });
  const auto floor = tray.triangles.size();
  append(tray, sheet(4, 2, [](double s, double t) { return Vec3(40 * s, 0, 9 * t); }));
  append(tray, sheet(4, 2, [](double s, double t) { return Vec3(40 * s, 30, 9 * t); }));
  append(tray, sheet(3, 2, [](double s, double t) { return Vec3(0, 30 * s, 9 * t); }));
  append(tray, sheet(3, 2, [](double s, double t) { return Vec3(40, 30 * s, 9 * t); }));
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  for (Vec3& p : tray.positions) p = turn * p + Vec3(17.3, -4.1, 60.7);
  const std::map<int, bool> clear =
      clear_of(tray, [&](const Vec3&) -> Vec3 { return turn.col(2); });
  EXPECT_EQ(clear.size(), floor);
  for (const auto& [t, is_clear] : clear) EXPECT_TRUE(is_clear) << t;
}

TEST(Overhang, FromAnAxisAndACentreTheOutermostWallIsClear) {
  TriangleMesh tubes = tube(10, 40, 36, 7);
  const auto inner = int(tubes.triangles.size());
  append(tubes, tube(14, 30, 30, 5));
  // The outer one covers three quarters of the inner one's height.
  for (const auto& [t, is_clear] : clear_of(tubes, kFromAxis)) {
    double least = 1e300;
    for (const std::int32_t v : tubes.triangles[std::size_t(t)])
      least = std::min(least, tubes.positions[std::size_t(v)].z());
    EXPECT_EQ(is_clear, t >= inner || least >= 30) << t << " from " << least;
  }
  TriangleMesh balls = ball(10, 24, 12);
  const auto outer = int(balls.triangles.size());
  append(balls, ball(15, 31, 17));
  const std::map<int, bool> clear = clear_of(balls, kFromCentre);
  EXPECT_EQ(clear.size(), balls.triangles.size());
  for (const auto& [t, is_clear] : clear) EXPECT_EQ(is_clear, t >= outer) << t;
}

TEST(Overhang, WhateverStandsOnARayIsInTheWay) {
  // A triangle around the axis whose rays go apart, and on one of them something tiny.
  const TriangleMesh alone = [] {
    TriangleMesh mesh;
    for (const auto& [turn, z] : {std::pair(-0.3, -8.0), {0.5, 3.0}, {-0.1, 9.0}})
      mesh.positions.emplace_back(10 * std::cos(turn), 10 * std::sin(turn), z);
    mesh.triangles = {{0, 1, 2}};
    return mesh;
  }();
  for (const Way& way : {kFromAxis, kFromCentre, Way([](const Vec3&) { return Vec3(1, 0, 0); })}) {
    EXPECT_TRUE(clear_of(alone, way).at(0));
    for (const auto& [u, v] : {std::pair(0.002, 0.4),
                               {0.5, 0.002},
                               {0.499, 0.499},
                               {0.3, 0.3},
                               {0.002, 0.002},
                               {0.99, 0.005},
                               {0.005, 0.99}})
      for (const double far : {0.01, 3.0, 300.0}) {
        TriangleMesh mesh = alone;
        const Vec3 p = position_at(mesh, {0, u, v}), there = p + far * way(p);
        const double size = 1e-3;
        append(mesh, {{there, there + Vec3(size, 0, 0), there + Vec3(0, size, size)}, {{0, 1, 2}}});
        EXPECT_FALSE(clear_of(mesh, way).at(0)) << u << ' ' << v << ' ' << far;
      }
  }
}

TEST(Overhang, OfFlatRaysAndOfThoseOnBothSidesNothingIsTold) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
  mesh.triangles = {{0, 1, 2}};
  const Overhang overhang(mesh);
  const Vec3 up(0.6, 0, 0.8), down(0.6, 0, -0.8), flat = Vec3(1, 0, 0.005).normalized();
  const auto is_clear = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    std::vector<std::uint8_t> clear;
    overhang.are_clear(std::vector<LeavingRays>{{0, {a, b, c}}}, clear);
    return clear.at(0) != 0;
  };
  EXPECT_TRUE(is_clear(up, up, up));
  EXPECT_TRUE(is_clear(down, down, down));
  EXPECT_FALSE(is_clear(flat, flat, flat));
  EXPECT_FALSE(is_clear(up, up, down));
  EXPECT_FALSE(is_clear(down, up, up));
}

TEST(Overhang, DoesNotDependOnWhoIsAskedTogether) {
  const TriangleMesh mesh = plain_with_slab();
  const Overhang overhang(mesh);
  std::vector<std::uint8_t> one, all;
  std::vector<LeavingRays> rays;
  rays.reserve(mesh.triangles.size());
  for (int t = 0; t < int(mesh.triangles.size()); ++t) rays.push_back(leaving(mesh, t, kUp));
  overhang.are_clear(rays, all);
  for (std::size_t t = 0; t < rays.size(); ++t) {
    overhang.are_clear(std::span(rays).subspan(t, 1), one);
    EXPECT_EQ(one, std::vector<std::uint8_t>{all[t]}) << t;
  }
  // Ways that go apart as widely as can be: one after the other.
  std::vector<LeavingRays> apart = {rays[0], rays[1]};
  for (Vec3& way : apart[1].ways) way = -way;
  overhang.are_clear(apart, all);
  EXPECT_EQ(all, (std::vector<std::uint8_t>{1, 1}));
}

TEST(Overhang, ItsTrianglesTogetherAreAllOfThem) {
  const TriangleMesh mesh = plain_with_slab();
  const Overhang overhang(mesh);
  std::vector<int> seen(mesh.triangles.size(), 0);
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    const std::span<const int> together = overhang.together(t);
    EXPECT_NE(std::find(together.begin(), together.end(), t), together.end());
    if (together.front() == t)
      for (const int other : together) ++seen[std::size_t(other)];
  }
  EXPECT_EQ(seen, std::vector<int>(mesh.triangles.size(), 1));
}

}  // namespace
}  // namespace hydrodip
