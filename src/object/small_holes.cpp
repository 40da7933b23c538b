#include "object/small_holes.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

#include "base/disjoint_sets.h"
#include "object/polygon.h"

namespace hydrodip {

namespace {

class HoleFiller {
 public:
  HoleFiller(Object& object, const std::vector<TriangleSide>& sides)
      : object_(object), sides_(sides) {}

  // Returns how many it closed.
  long run() {
    collect_rims();
    if (rims_.empty()) return 0;
    const double largest = kRelativeSize * object_.bounds().size().norm();
    std::vector<char> seen(rims_.size(), 0);
    long closed = 0;
    for (std::size_t start = 0; start < rims_.size(); ++start) {
      if (seen[start]) continue;
      const std::vector<std::size_t> loop = trace(start, largest, seen);
      if (loop.size() < 3 || !shell_dwarfs(loop)) continue;
      fill(loop);
      ++closed;
    }
    return closed;
  }

 private:
  static constexpr double kRelativeSize = 0.003;
  static constexpr std::size_t kMostCorners = 1000;

  // An open edge, in the direction in which its triangle runs.
  struct Rim {
    std::int32_t from, to;
    std::uint32_t place;
  };

  void collect_rims() {
    for_each_edge(sides_, [&](std::size_t begin, std::size_t end) {
      if (end - begin != 1) return;
      const std::uint32_t place = sides_[begin].place;
      const Triangle& t = object_.triangles[place / 3];
      rims_.push_back({t[place % 3], t[(place + 1) % 3], place});
    });
    std::sort(rims_.begin(), rims_.end(), [](const Rim& a, const Rim& b) {
      return std::tie(a.from, a.place) < std::tie(b.from, b.place);
    });
  }

  // The only open edge that begins at the vertex, or none.
  std::optional<std::size_t> leaving(std::int32_t vertex) const {
    const auto first =
        std::lower_bound(rims_.begin(), rims_.end(), vertex,
                         [](const Rim& rim, std::int32_t wanted) { return rim.from < wanted; });
    if (first == rims_.end() || first->from != vertex) return {};
    if (first + 1 != rims_.end() && (first + 1)->from == vertex) return {};
    return std::size_t(first - rims_.begin());
  }

  // The edges around a small hole, or nothing.
  std::vector<std::size_t> trace(std::size_t start, double largest, std::vector<char>& seen) const {
    std::vector<std::size_t> loop;
    Box3 box;
    for (std::size_t at = start;;) {
      seen[at] = 1;
      loop.push_back(at);
      box.add(object_.positions[std::size_t(rims_[at].from)]);
      if (loop.size() > kMostCorners || box.size().norm() > largest) return {};
      const auto next = leaving(rims_[at].to);
      if (!next) return {};
      if (*next == start) return loop;
      if (seen[*next]) return {};
      at = *next;
    }
  }

  // A loose scrap's outline is no hole.
  bool shell_dwarfs(const std::vector<std::size_t>& loop) {
    if (shell_boxes_.empty()) measure_shells();
    Box3 box;
    for (const std::size_t at : loop) box.add(object_.positions[std::size_t(rims_[at].from)]);
    const auto shell = shells_->find(std::uint32_t(rims_[loop[0]].from));
    return shell_boxes_[shell].size().norm() > 4 * box.size().norm();
  }

  void measure_shells() {
    shells_.emplace(object_.positions.size());
    for (const Triangle& t : object_.triangles) {
      shells_->join(t[0], t[1]);
      shells_->join(t[1], t[2]);
    }
    shell_boxes_.resize(object_.positions.size());
    for (std::size_t v = 0; v < object_.positions.size(); ++v)
      shell_boxes_[shells_->find(std::uint32_t(v))].add(object_.positions[v]);
  }

  // Against the open edges' direction, so that the new triangles face as their neighbours do. They
  // look like the neighbours at their corners.
  void fill(std::vector<std::size_t> loop) {
    std::reverse(loop.begin(), loop.end());
    std::vector<Vec3> corners;
    corners.reserve(loop.size());
    for (const std::size_t at : loop)
      corners.push_back(object_.positions[std::size_t(rims_[at].from)]);
    for (const auto& cut : triangulate(corners)) {
      std::array<std::uint32_t, 3> places{};
      for (std::size_t c = 0; c < 3; ++c) places[c] = rims_[loop[std::size_t(cut[c])]].place;
      const int material = object_.material_of[places[0] / 3];
      // Where materials meet, one of them goes on alone.
      for (std::uint32_t& place : places)
        if (object_.material_of[place / 3] != material) place = places[0];
      object_.triangles.push_back({rims_[loop[std::size_t(cut[0])]].from,
                                   rims_[loop[std::size_t(cut[1])]].from,
                                   rims_[loop[std::size_t(cut[2])]].from});
      object_.material_of.push_back(material);
      copy_corners(object_.uvs, places);
      copy_corners(object_.colors, places);
    }
  }

  template <typename Corner>
  static void copy_corners(std::vector<std::array<Corner, 3>>& values,
                           const std::array<std::uint32_t, 3>& places) {
    if (values.empty()) return;
    std::array<Corner, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = values[places[c] / 3][places[c] % 3];
    values.push_back(corners);
  }

  Object& object_;
  const std::vector<TriangleSide>& sides_;
  std::vector<Rim> rims_;
  std::optional<DisjointSets> shells_;
  std::vector<Box3> shell_boxes_;
};

}  // namespace

long close_small_holes(Object& object, const std::vector<TriangleSide>& sides) {
  return HoleFiller(object, sides).run();
}

}  // namespace hydrodip
