#include "plan/nearest_node.h"

#include <algorithm>
#include <utility>

namespace hydrodip {

struct NearestNode::Looking {
  const Vec3& position;
  const Vec3& normal;
  Found best;  // squared: at most that, until one is found
};

NearestNode::NearestNode(const SurfaceNodes& nodes, const std::vector<std::int32_t>& among) {
  placed_.reserve(among.size());
  for (const std::int32_t i : among) {
    const Target& node = nodes.nodes()[std::size_t(i)];
    placed_.push_back({node.position, node.normal, i, 0});
  }
  sort(0, placed_.size());
}

void NearestNode::sort(std::size_t begin, std::size_t end) {
  if (end - begin < 2) return;
  Box3 box;
  for (std::size_t i = begin; i < end; ++i) box.add(placed_[i].position);
  Eigen::Index axis = 0;
  box.size().maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return placed_.begin() + std::ptrdiff_t(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](const Placed& a, const Placed& b) {
    return a.position[axis] < b.position[axis];
  });
  placed_[middle].axis = int(axis);
  sort(begin, middle);
  sort(middle + 1, end);
}

NearestNode::Found NearestNode::find(const Vec3& position, const Vec3& normal, double reach) const {
  Looking looking{position, normal, {-1, reach * reach, 0}};
  look(0, placed_.size(), looking);
  return looking.best;
}

void NearestNode::look(std::size_t begin, std::size_t end, Looking& looking) const {
  if (begin == end) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const Placed& placed = placed_[middle];
  const double squared = (placed.position - looking.position).squaredNorm();
  Found& best = looking.best;
  ++best.looked_at;
  const bool is_first = best.node < 0 || placed.node < best.node;
  if ((squared < best.squared || (squared == best.squared && is_first)) &&
      SurfaceNodes::face_alike(placed.normal, looking.normal))
    best = {placed.node, squared, best.looked_at};
  const double beyond = looking.position[placed.axis] - placed.position[placed.axis];
  const std::pair below(begin, middle), above(middle + 1, end);
  const auto& [near, far] = beyond < 0 ? std::pair(below, above) : std::pair(above, below);
  look(near.first, near.second, looking);
  if (beyond * beyond <= best.squared) look(far.first, far.second, looking);
}

}  // namespace hydrodip
