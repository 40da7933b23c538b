// Any paint as one texture: for files and pages that know nothing but texture coordinates.
#pragma once

#include "object/paint.h"

namespace hydrodip {

// The mesh with the paint's colours: as the paint gives them itself (Paint::as_object), or baked
// into one texture in which every chart of the surface (charts.h) has a patch of its own, as long
// and as wide as it is. The texture is at most `most_px` wide and high; where no triangle would
// have more of it than its corners, these have the colours instead. Lengths as in the mesh.
Object painted_object(const TriangleMesh& mesh, const Paint& paint, int most_px = 2048);

}  // namespace hydrodip
