#include "dip/lowest_places.h"

#include <algorithm>
#include <cstddef>

namespace hydrodip {
namespace {

// By height first.
bool is_before(const Vec3& a, const Vec3& b) {
  if (a.z() != b.z()) return a.z() < b.z();
  if (a.x() != b.x()) return a.x() < b.x();
  return a.y() < b.y();
}

}  // namespace

std::vector<double> lowest_places(const std::vector<Vec3>& positions,
                                  const std::vector<Triangle>& triangles) {
  enum : std::uint8_t { kUnused, kLowest, kAbove };
  std::vector<std::uint8_t> is(positions.size(), kUnused);
  for (const Triangle& t : triangles) {
    double low = positions[std::size_t(t[0])].z();
    for (const std::int32_t v : t) low = std::min(low, positions[std::size_t(v)].z());
    for (const std::int32_t v : t) {
      std::uint8_t& own = is[std::size_t(v)];
      own = positions[std::size_t(v)].z() > low ? std::uint8_t(kAbove)
                                                : std::max(own, std::uint8_t(kLowest));
    }
  }
  std::vector<Vec3> lowest;
  for (std::size_t v = 0; v < is.size(); ++v)
    if (is[v] == kLowest) lowest.push_back(positions[v]);
  std::sort(lowest.begin(), lowest.end(), is_before);
  // Another corner at the same place may have something below it.
  std::vector<std::uint8_t> is_lowest(lowest.size(), 1);
  for (std::size_t v = 0; v < is.size(); ++v) {
    if (is[v] != kAbove) continue;
    const auto same = std::equal_range(lowest.begin(), lowest.end(), positions[v], is_before);
    std::fill(is_lowest.begin() + (same.first - lowest.begin()),
              is_lowest.begin() + (same.second - lowest.begin()), 0);
  }
  std::vector<double> heights;
  for (std::size_t n = 0; n < lowest.size(); ++n)
    if (is_lowest[n] && (heights.empty() || heights.back() != lowest[n].z()))
      heights.push_back(lowest[n].z());
  return heights;
}

}  // namespace hydrodip
