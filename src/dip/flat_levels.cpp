#include "dip/flat_levels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace hydrodip {
namespace {

// What differs by less in height is level.
constexpr double kLevel_mm = 1e-4;

}  // namespace

std::vector<double> flat_levels(const std::vector<Vec3>& positions,
                                const std::vector<Triangle>& triangles, double least_area_mm2) {
  std::vector<std::pair<double, double>> faces;  // height, area
  for (const Triangle& t : triangles) {
    const Vec3 &a = positions[std::size_t(t[0])], &b = positions[std::size_t(t[1])],
               &c = positions[std::size_t(t[2])];
    const auto [low, high] = std::minmax({a.z(), b.z(), c.z()});
    if (high - low < kLevel_mm) faces.emplace_back(low, 0.5 * (b - a).cross(c - a).norm());
  }
  std::sort(faces.begin(), faces.end());
  std::vector<double> levels;
  for (std::size_t first = 0; first < faces.size();) {
    double area = 0;
    std::size_t last = first;
    for (; last < faces.size() && faces[last].first - faces[first].first < kLevel_mm; ++last)
      area += faces[last].second;
    if (area >= least_area_mm2) levels.push_back(faces[first].first);
    first = last;
  }
  return levels;
}

}  // namespace hydrodip
