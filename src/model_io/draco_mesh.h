// Meshes compressed by Draco, as glTF holds them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hydrodip {

struct DracoMesh {
  std::int64_t points = 0;
  std::vector<std::array<std::uint32_t, 3>> faces;  // indices below points
  struct Attribute {
    int components = 0;         // 1 to 4
    std::vector<float> values;  // `components` per point
  };
  // Those that were asked for, in that order; without values if the mesh has none of that id.
  std::vector<Attribute> attributes;
};

// What is asked for. Normalised whole numbers are brought to [0, 1] or [-1, 1], whatever the mesh
// itself says of them: glTF's accessors have the say, and encoders leave the mesh's own note out.
struct DracoWanted {
  std::uint32_t id = 0;
  bool normalized = false;
};

// Throws std::runtime_error saying what is wrong.
DracoMesh decode_draco(std::span<const std::uint8_t> bytes, const std::vector<DracoWanted>& wanted);

}  // namespace hydrodip
