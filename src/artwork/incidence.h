// Which triangles a mesh's corners belong to.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "object/object.h"

namespace hydrodip {

class Incidence {
 public:
  explicit Incidence(const TriangleMesh& mesh);
  // In the mesh's order.
  std::span<const std::uint32_t> around(std::int32_t vertex) const {
    const std::uint32_t begin = begin_[std::size_t(vertex)];
    return {triangles_.data() + begin, begin_[std::size_t(vertex) + 1] - begin};
  }

 private:
  std::vector<std::uint32_t> begin_;  // per vertex, into triangles_; one more at the end
  std::vector<std::uint32_t> triangles_;
};

}  // namespace hydrodip
