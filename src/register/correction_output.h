// A correction as it is kept and shown: correction.json, correction.png.
#pragma once

#include <string>
#include <vector>

#include "film/film.h"
#include "image/image.h"
#include "register/displacement_fit.h"
#include "register/seen_dip.h"
#include "settings/correction_file.h"

namespace hydrodip {

// In one line. `samples`: those of the dips, and of earlier ones.
std::string correction_json(const CorrectedDip& of, const std::vector<SeenDip>& dips,
                            const std::vector<CorrectionSample>& samples,
                            const DisplacementFit& fit);

// Arrows where the field is known. `before_mm`: how far places were off, rms.
Image draw_field(const DisplacementFit& fit, const FilmOptions& film, double before_mm);

}  // namespace hydrodip
