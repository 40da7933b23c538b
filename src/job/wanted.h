// What shall be printed, and what of it a dip brings.
#pragma once

#include <optional>

#include "coat/dipped_object.h"
#include "object/paint.h"
#include "report/report.h"

namespace hydrodip {

inline constexpr int kWantedPoints = 20000;

// Looked at in about so many points of the surface. Nothing where the paint says nothing, or wants
// colour all over the object: coverage says it then.
std::optional<ReportWanted> wanted_coverage(const DippedObject& dipped, const Paint& paint,
                                            int points = kWantedPoints);

}  // namespace hydrodip
