#include "air/section.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hydrodip {
namespace {

// Upright walls along lines in the plane z = 0, from z = -1 to 1; each line apart from the others.
TriangleMesh walls(const std::vector<std::vector<Vec2>>& lines) {
  TriangleMesh mesh;
  for (const std::vector<Vec2>& line : lines) {
    const auto first = std::int32_t(mesh.positions.size());
    for (const Vec2& p : line)
      for (const double z : {-1.0, 1.0}) mesh.positions.emplace_back(p.x(), p.y(), z);
    for (std::int32_t k = 0; k + 1 < std::int32_t(line.size()); ++k) {
      const std::int32_t at = first + 2 * k;
      mesh.triangles.push_back({at, at + 2, at + 3});
      mesh.triangles.push_back({at, at + 3, at + 1});
    }
  }
  return mesh;
}

double area_of(const std::vector<Loop>& loops) {
  double sum = 0;
  for (const Loop& loop : loops) sum += std::abs(area(loop));
  return sum;
}

const Plane kMiddle{Vec3::UnitZ(), 0.25};

TEST(Section, OfAnUprightTubeIsItsOutline) {
  const std::vector<Vec2> square = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}};
  TriangleMesh tube = walls({square});
  // The last corners are the first.
  for (Triangle& t : tube.triangles)
    for (std::int32_t& v : t)
      if (v >= 8) v -= 8;
  const std::vector<Loop> loops = section(tube, kMiddle, 0);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_NEAR(area_of(loops), 100, 1e-12);
  EXPECT_TRUE(encloses(loops[0], kMiddle.flat({5, 5, 0})));
  EXPECT_FALSE(encloses(loops[0], kMiddle.flat({15, 5, 0})));
  // Counter-clockwise outlines have a positive area.
  EXPECT_GT(area({{0, 0}, {1, 0}, {0, 1}}), 0);
  for (const Vec2& corner : loops[0]) EXPECT_NEAR(kMiddle.height(kMiddle.lifted(corner)), 0, 1e-12);
}

TEST(Section, AGapIsClosedIfItIsNoWiderThanItMayBe) {
  const TriangleMesh open = walls({{{0, 0}, {10, 0}, {10, 10}, {0, 10}}});  // no wall at x = 0
  EXPECT_TRUE(section(open, kMiddle, 9.9).empty());
  const std::vector<Loop> loops = section(open, kMiddle, 10.1);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_NEAR(area_of(loops), 100, 1e-12);
}

// Whichever way each of them runs.
TEST(Section, PiecesAreJoinedEndToEnd) {
  std::vector<Vec2> lower = {{0, 0.1}, {0, 0}, {10, 0}, {10, 0.1}},
                    upper = {{10, 0.3}, {10, 10}, {0, 10}, {0, 0.3}};
  for (int ways = 0; ways < 4; ++ways) {
    std::vector<std::vector<Vec2>> lines = {lower, upper};
    for (int k = 0; k < 2; ++k)
      if ((ways >> k & 1) != 0)
        std::reverse(lines[std::size_t(k)].begin(), lines[std::size_t(k)].end());
    const std::vector<Loop> loops = section(walls(lines), kMiddle, 0.5);
    ASSERT_EQ(loops.size(), 1U) << ways;
    EXPECT_NEAR(area_of(loops), 100, 1e-9) << ways;
    EXPECT_TRUE(section(walls(lines), kMiddle, 0.1).empty()) << ways;
  }
}

// Of leaning planes, too.
TEST(Section, OfALeaningPlaneIsLongerByItsSlope) {
  const std::vector<Vec2> square = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  TriangleMesh tube = walls({square});
  const auto n = std::int32_t(tube.positions.size());
  tube.triangles.push_back({n - 2, 0, 1});
  tube.triangles.push_back({n - 2, 1, n - 1});
  for (Vec3& p : tube.positions) p.z() *= 50;
  const double lean = 0.3;
  const Plane plane{Vec3(std::sin(lean), 0, std::cos(lean)), 0};
  const std::vector<Loop> loops = section(tube, plane, 0);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_NEAR(area_of(loops), 100 / std::cos(lean), 1e-9);
}

}  // namespace
}  // namespace hydrodip
