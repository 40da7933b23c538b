// Which of a number of things belong together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace hydrodip {

// Things numbered from 0; at first each is alone. A set's root is its lowest number.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  // The root.
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  std::size_t find(std::int32_t i) { return find(std::uint32_t(i)); }
  void join(std::int32_t a, std::int32_t b) {
    const std::uint32_t root_a = find(std::uint32_t(a)), root_b = find(std::uint32_t(b));
    if (root_a != root_b) parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }
  bool is_root(std::size_t i) const { return parent_[i] == i; }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace hydrodip
