// The object as a page or a viewer draws it: vertices with everything that belongs to them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "object/object.h"

namespace hydrodip {

struct ShownVertex {
  std::array<float, 3> position{};  // mm
  std::array<float, 3> normal{};    // unit, smooth
  std::array<float, 2> uv{};        // 0 without UVs
  std::array<float, 4> color{};     // linear, white without vertex colours

  bool operator==(const ShownVertex& other) const = default;
};

// Triangles of one material, as indices[begin .. begin + count).
struct ShownGroup {
  int material = 0;
  std::size_t begin = 0, count = 0;
};

struct ShownObject {
  std::vector<ShownVertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<ShownGroup> groups;
  bool simplified = false;
};

// Corners that agree in everything share a vertex. Above `most_triangles`, vertices are drawn
// together on a grid just fine enough.
ShownObject shown_object(const Object& object, std::size_t most_triangles);

}  // namespace hydrodip
