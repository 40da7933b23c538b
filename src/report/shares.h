// How shares of surface and film are told, and from what on things are judged: alike in sentence,
// findings and what a customer reads.
#pragma once

#include "base/plain_number.h"

namespace hydrodip {

// Of what faces down, from where on a dip does what it can; film ends a cell or so short of every
// border.
constexpr double kNearlyAll = 0.9;
// Of what shall be printed, or of the object.
constexpr double kWholePicture = 0.98;
constexpr double kLittleDoubt = 0.01;     // of the surface under whole film
constexpr double kMuchOutOfGamut = 0.02;  // of the covered surface
constexpr double kPale = 1.3;             // area ratio from which paling shows
constexpr double kPlainDifference = 5;    // CIEDE2000: plain to see
constexpr double kUsualMiss_mm = 1;       // how far off a dip usually lands
// Of what shall be printed and gets film: the verdict says it.
constexpr double kSomeDoubt = 0.05;

}  // namespace hydrodip
