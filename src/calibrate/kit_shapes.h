// The calibration shapes to print: watertight, standing on their mount, with a hole for it.
#pragma once

#include "calibrate/checkerboard_dip.h"
#include "object/object.h"

namespace hydrodip {

// The side of a known shape that dips, made longer upwards by a straight body with a flat end, in
// the middle of which is a blind hole for a screw. As printed: z up, standing on the flat end at z
// = 0. Precondition: one of kit_shapes().
Object kit_shape(const KitShape& shape);

// The dome of tear_limit.h with its grooves, every fifth of them wide, as printed.
Object dome_to_print();

constexpr double kMountHole_mm = 5.6;  // a 1/4-20 tripod screw cuts its thread into it
constexpr double kMountHoleDepth_mm = 12;

}  // namespace hydrodip
