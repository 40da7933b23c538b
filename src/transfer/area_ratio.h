// How film that nobody has measured counts.
#pragma once

namespace hydrodip {

// Of FilmStretch::area_ratio: what is not known, 0, counts as not stretched.
inline float ratio_or_one(float area_ratio) { return area_ratio == 0 ? 1 : area_ratio; }

}  // namespace hydrodip
