// How different two colours look.
#pragma once

#include "base/math.h"
#include "image/image.h"

namespace hydrodip {

// CIE L*a*b* under D65 of a colour in linear sRGB.
Vec3 to_cielab(const LinearColor& color);

// CIEDE2000 (Sharma, Wu and Dalal, "The CIEDE2000 color-difference formula", 2005), all weights 1.
// About 1 is just visible side by side, 5 is plain to see.
double ciede2000(const Vec3& lab1, const Vec3& lab2);

}  // namespace hydrodip
