// How shares of surface and film are told, and judged, alike in sentence and findings.
#pragma once

#include <string>

namespace hydrodip {

// Of the surface that faces down; film ends a cell or so short of every border.
constexpr double kNearlyAll = 0.9;

// "under 0.1 %", "2.1 %", "47 %".
std::string percent(double share);

}  // namespace hydrodip
