// Whether a correction belongs to the dip that it is to correct.
#pragma once

#include "object/posed_object.h"
#include "settings/config.h"
#include "settings/correction_file.h"

namespace hydrodip {

// What a correction of this dip notes. `depth_mm`: of its deepest point.
CorrectedDip corrected_dip(const JobConfig& config, const PosedObject& posed, double depth_mm);

// Throws InputError if config.correction is of another model, pose, depth or film, and says which.
void require_correction_fits(const JobConfig& config, const PosedObject& posed, double depth_mm);

}  // namespace hydrodip
