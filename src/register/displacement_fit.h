// A smooth field through scattered displacements, as smooth as they say it is.
#pragma once

#include <vector>

#include "film/correction.h"
#include "settings/correction_file.h"

namespace hydrodip {

struct FitArea {
  Vec2 min, max;  // mm, film coordinates
};

struct DisplacementFit {
  FilmCorrection field;
  std::vector<double> sigma_mm;  // per point of the field, of each component
  double smooth_mm = 0;          // over which distances it changes; 0: it is affine
  double noise_mm = 0;           // of a sample's component
  // Of a sample's displacement when the others foretell it, rms.
  double left_out_rms_mm = 0;
};

// Kriging with an affine drift and a Gaussian covariance; its length and the share of noise are
// those by which samples that are left out are foretold best (Dubrule, "Cross validation of kriging
// in a unique neighborhood", 1983). Of many samples near ones are averaged first. Throws InputError
// for fewer than 12 samples, or if all lie along one line.
DisplacementFit fit_displacements(const std::vector<CorrectionSample>& samples,
                                  const FitArea& area);

}  // namespace hydrodip
