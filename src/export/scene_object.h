// The object as a page or a viewer draws it: vertices with everything that belongs to them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"
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

// A picture as pages read it: JPEG of that quality, or PNG if some of it is not opaque.
struct ShownPicture {
  std::string type;  // "image/jpeg"
  std::vector<std::uint8_t> bytes;
};
ShownPicture shown_picture(const Image& image, int jpeg_quality);

// "repeat", "mirror", "clamp", "decal".
const char* wrap_name(Wrap wrap);

}  // namespace hydrodip
