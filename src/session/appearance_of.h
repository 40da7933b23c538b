// A finish as pictures show it.
#pragma once

#include "coat/finish.h"
#include "render/appearance.h"

namespace hydrodip {

// Wanted: the paint, or the bare object where it says nothing; predicted: the finish. Refers to it.
Appearance appearance_of(const Finish& finish);

}  // namespace hydrodip
