#include "object/charts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "samples/samples.h"

namespace hydrodip {
namespace {

std::vector<std::size_t> sizes(const std::vector<std::vector<std::size_t>>& list) {
  std::vector<std::size_t> sizes;
  for (const auto& chart : list) sizes.push_back(chart.size());
  return sizes;
}

TEST(Charts, EveryTriangleIsInOne) {
  const Object box = make_sample("box");
  std::set<std::size_t> seen;
  std::size_t count = 0;
  for (const auto& chart : charts(box)) {
    seen.insert(chart.begin(), chart.end());
    count += chart.size();
  }
  EXPECT_EQ(count, box.triangles.size());
  EXPECT_EQ(seen.size(), box.triangles.size());
}

TEST(Charts, ACubeHasSixOfTwoTriangles) {
  TriangleMesh cube;
  for (int v = 0; v < 8; ++v) cube.positions.emplace_back(v & 1, (v >> 1) & 1, (v >> 2) & 1);
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  EXPECT_EQ(sizes(charts(cube)), std::vector<std::size_t>(6, 2));
}

// Caps of 40 degrees: at least eight, and fewer than its 20 times.
TEST(Charts, ASphereHasAFew) {
  const Object sphere = make_sample("sphere");
  const std::vector<std::size_t> of = sizes(charts(sphere));
  EXPECT_GE(of.size(), 8U);
  EXPECT_LT(of.size(), 160U);
}

// A ramp that goes three times round a column, in triangles far smaller than the footprint's cells
// or far larger.
TEST(Charts, NoneLiesOverItself) {
  for (const int steps : {60, 60000}) {
    TriangleMesh ramp;
    for (int i = 0; i <= steps; ++i) {
      const double turn = 6 * M_PI * i / steps;
      for (const double radius : {1.0, 1.5})
        ramp.positions.emplace_back(radius * std::cos(turn), radius * std::sin(turn), 0.1 * turn);
      const std::int32_t last = 2 * i;
      if (i == 0) continue;
      ramp.triangles.push_back({last - 2, last - 1, last});
      ramp.triangles.push_back({last - 1, last + 1, last});
    }
    for (const auto& chart : charts(ramp)) {
      double area = 0;
      for (const std::size_t t : chart) {
        const Triangle& v = ramp.triangles[t];
        const auto at = [&](std::size_t k) {
          return ramp.positions[std::size_t(v[k])].head<2>().eval();
        };
        area += std::abs(cross2(at(1) - at(0), at(2) - at(0))) / 2;
      }
      EXPECT_LE(area, M_PI * (1.5 * 1.5 - 1) * 1.01) << steps;
    }
  }
}

// Three leaves of a book in one plane would overlap.
TEST(Charts, NoneGoesOnAcrossAnEdgeOfThree) {
  TriangleMesh book;
  book.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}};
  book.triangles = {{0, 2, 1}, {0, 3, 1}, {0, 1, 4}};
  EXPECT_EQ(charts(book).size(), 3U);
}

}  // namespace
}  // namespace hydrodip
