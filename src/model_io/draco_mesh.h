// Meshes compressed by Draco, as glTF holds them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hydrodip {

struct DracoMesh {
  std::int64_t points = 0;
  std::vector<std::array<std::uint32_t, 3>> faces;  // indices below points
  struct Attribute {
    int components = 0;         // 1 to 4
    std::vector<float> values;  // `components` per point
  };
  // By the ids that were asked for, in that order; without values if the mesh has none of that id.
  std::vector<Attribute> attributes;
};

// Throws std::runtime_error saying what is wrong.
DracoMesh decode_draco(std::span<const std::uint8_t> bytes, const std::vector<std::uint32_t>& ids);

}  // namespace hydrodip
