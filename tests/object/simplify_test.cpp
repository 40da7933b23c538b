#include "object/simplify.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace hydrodip {
namespace {

// A ball of radius 1 around (5, 0, 0), of 2 n (n - 1) triangles, whose colours say where they are.
Object ball(int n) {
  Object object;
  object.materials.resize(2);
  for (int ring = 0; ring <= n; ++ring)
    for (int k = 0; k < n; ++k) {
      const double tilt = std::numbers::pi * ring / n, turn = 2 * std::numbers::pi * k / n;
      object.positions.emplace_back(5 + std::sin(tilt) * std::cos(turn),
                                    std::sin(tilt) * std::sin(turn), std::cos(tilt));
    }
  const auto at = [n](int ring, int k) { return std::int32_t(ring * n + k % n); };
  const auto add = [&](const Triangle& t) {
    object.triangles.push_back(t);
    object.material_of.push_back(object.positions[std::size_t(t[0])].x() > 5 ? 1 : 0);
    CornerColor colors;
    for (std::size_t k = 0; k < 3; ++k)
      colors[k] = {float(object.positions[std::size_t(t[k])].z()), 0, 0, 1};
    object.colors.push_back(colors);
  };
  for (int ring = 0; ring < n; ++ring)
    for (int k = 0; k < n; ++k) {
      if (ring + 1 < n) add({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)});
      if (ring > 0) add({at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)});
    }
  return object;
}

TEST(Simplify, KeepsShapeBoxAndColours) {
  const Object fine = ball(300);
  const Object coarse = simplified(fine, 20000);
  EXPECT_LE(coarse.triangles.size(), 20000u);
  EXPECT_GT(coarse.triangles.size(), 10000u);
  EXPECT_EQ(coarse.bounds().min, fine.bounds().min);
  EXPECT_EQ(coarse.bounds().max, fine.bounds().max);
  double volume = 0;
  ASSERT_EQ(coarse.colors.size(), coarse.triangles.size());
  ASSERT_EQ(coarse.material_of.size(), coarse.triangles.size());
  for (std::size_t t = 0; t < coarse.triangles.size(); ++t) {
    const auto corner = [&](std::size_t k) {
      return Vec3(coarse.positions[std::size_t(coarse.triangles[t][k])] - Vec3(5, 0, 0));
    };
    volume += corner(0).dot(corner(1).cross(corner(2))) / 6;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(corner(k).norm(), 1, 0.03);
      EXPECT_NEAR(coarse.colors[t][k].r, corner(k).z(), 0.06);
    }
  }
  EXPECT_NEAR(volume, 4 * std::numbers::pi / 3, 0.03);
}

TEST(Simplify, LeavesWhatIsSmallEnough) {
  const Object object = ball(20);
  const Object same = simplified(object, object.triangles.size());
  EXPECT_EQ(same.triangles, object.triangles);
  EXPECT_EQ(same.positions, object.positions);
}

}  // namespace
}  // namespace hydrodip
