// Paints that depend on the film, once a dip is known.
#pragma once

#include <memory>

#include "coat/dipped_object.h"
#include "object/paint.h"

namespace hydrodip {

// The paint with every point's film coordinate as this dip has it; the paint itself if it does not
// depend on the film.
std::shared_ptr<const Paint> paint_as_dipped(std::shared_ptr<const Paint> paint,
                                             const DippedObject& dipped);

}  // namespace hydrodip
