// What a design does to light on the object.
#pragma once

#include "coat/design.h"
#include "coat/finish.h"

namespace hydrodip {

// The coat of a design whose stretch is kept, unless it is the first: that one lies on the bare
// object, of the others it is what they do to light from below.
Coat coat_of(const Designed& made, bool is_first, const ColorModel& model);

}  // namespace hydrodip
