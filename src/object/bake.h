// Any paint as one texture: for files and pages that know nothing but texture coordinates.
#pragma once

#include <limits>

#include "object/paint.h"

namespace hydrodip {

// Finer than anybody sees on an object: 400 dpi.
inline constexpr double kFinestTexels_per_mm = 16;

struct TextureSize {
  int most_px;  // it is not wider or higher
  // Texels to a unit of the mesh's lengths.
  double finest = std::numeric_limits<double>::infinity();
};

// The mesh with the paint's colours: as the paint gives them itself (Paint::as_object), or baked
// into one texture in which every chart of the surface (charts.h) has a patch of its own, as long
// and as wide as it is. The texture is as large as `size` allows; where no triangle would have more
// of it than its corners, these have the colours instead.
Object painted_object(const TriangleMesh& mesh, const Paint& paint, const TextureSize& size);

}  // namespace hydrodip
