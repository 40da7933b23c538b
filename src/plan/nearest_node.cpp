#include "plan/nearest_node.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace hydrodip {

struct NearestNode::Looking {
  const Vec3& position;
  const Vec3& normal;
  double most;  // squared; from the first that is found on, its own
  bool is_found = false;
};

NearestNode::NearestNode(const SurfaceNodes& nodes, std::vector<std::int32_t> among)
    : nodes_(nodes.nodes()), sorted_(std::move(among)), axis_(sorted_.size(), 0) {
  sort(0, sorted_.size());
}

void NearestNode::sort(std::size_t begin, std::size_t end) {
  if (end - begin < 2) return;
  Box3 box;
  for (std::size_t i = begin; i < end; ++i) box.add(nodes_[std::size_t(sorted_[i])].position);
  Eigen::Index axis = 0;
  box.size().maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return sorted_.begin() + std::ptrdiff_t(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::int32_t a, std::int32_t b) {
    return nodes_[std::size_t(a)].position[axis] < nodes_[std::size_t(b)].position[axis];
  });
  axis_[middle] = std::uint8_t(axis);
  sort(begin, middle);
  sort(middle + 1, end);
}

double NearestNode::squared_distance(const Vec3& position, const Vec3& normal, double reach) const {
  Looking looking{position, normal, reach * reach};
  look(0, sorted_.size(), looking);
  return looking.is_found ? looking.most : std::numeric_limits<double>::infinity();
}

void NearestNode::look(std::size_t begin, std::size_t end, Looking& looking) const {
  if (begin == end) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const Target& node = nodes_[std::size_t(sorted_[middle])];
  const double squared = (node.position - looking.position).squaredNorm();
  if (squared <= looking.most && SurfaceNodes::face_alike(node.normal, looking.normal)) {
    looking.most = squared;
    looking.is_found = true;
  }
  const auto axis = Eigen::Index(axis_[middle]);
  const double beyond = looking.position[axis] - node.position[axis];
  const std::pair below(begin, middle), above(middle + 1, end);
  const auto& [near, far] = beyond < 0 ? std::pair(below, above) : std::pair(above, below);
  look(near.first, near.second, looking);
  if (beyond * beyond <= looking.most) look(far.first, far.second, looking);
}

}  // namespace hydrodip
