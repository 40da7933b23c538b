// The film's tear limit, read off a dome of the kit: the deeper it dips, the further the film that
// it takes up is stretched, and grooves around it count how far the film held.
#pragma once

#include <optional>
#include <vector>

#include "calibrate/checkerboard_dip.h"

namespace hydrodip {

// Part of a sphere, dipped to kDomeDepth_mm. Grooves run around it at even distances along its
// surface, the first one innermost.
constexpr double kDomeRadius_mm = 60, kDomeDepth_mm = 36;
constexpr int kDomeRings = 31;
// From the lowest point along the surface to a ring, 1 to kDomeRings.
double ring_arc_mm(int ring);

// As it dips, without grooves.
CalibrationObject tear_dome();

// The largest stretch around each of the rings, ring 1 first, in film that is inked evenly and does
// not tear; ascending. Throws DipError, Cancelled.
std::vector<double> ring_stretches(const DesignOptions& design, const FilmParameters& parameters,
                                   const RunContext& context);

// material.tear_stretch with its 95 % interval.
struct TearLimit {
  double stretch = 0, low = 0, high = 0;
};
// Readings: of each dip, the innermost ring on which film is torn anywhere. Throws InputError for
// one that cannot tell: none, the first, or beyond the last.
void require_rings(const std::vector<int>& torn_from);
// A reading may be off by a ring. Nothing where all those rings are stretched alike, which tells no
// limit. Throws as require_rings() does.
std::optional<TearLimit> tear_limit(const std::vector<double>& stretches,
                                    const std::vector<int>& torn_from);

}  // namespace hydrodip
