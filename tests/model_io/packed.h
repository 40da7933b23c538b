// What compressed model files hold, packed by the libraries that define the formats, and ZIP
// archives as programs write them that do not know sizes beforehand.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "model_io/model_files.h"

namespace hydrodip::fixtures {

struct DracoMesh {
  Bytes bytes;
  unsigned positions = 0, uvs = 0, colors = 0;  // the ids of what it holds
};
// Its colours, all the same, are whole numbers of which it does not say that they are normalised.
DracoMesh draco_mesh(const std::vector<std::array<float, 3>>& positions,
                     const std::vector<std::array<float, 2>>& uvs,
                     const std::vector<std::array<std::uint16_t, 3>>& triangles,
                     const std::array<std::uint8_t, 3>& color = {255, 255, 255});

// By meshoptimizer: numbers of `stride` bytes each, and triangles.
Bytes meshopt_vertices(const Bytes& values, std::size_t stride);
Bytes meshopt_triangles(const std::vector<std::array<std::uint16_t, 3>>& triangles,
                        std::size_t vertices);

// Sizes stand behind each member, and are those of Zip64.
Bytes streamed_zip(const std::vector<std::pair<std::string, std::string>>& members);

}  // namespace hydrodip::fixtures
