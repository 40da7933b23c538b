// How well scans will determine a film, said before anything is dipped.
#pragma once

#include <vector>

#include "base/context.h"
#include "calibrate/checkerboard_dip.h"
#include "coat/design.h"

namespace hydrodip {

// Standard deviations to be expected.
struct Expectation {
  FilmParameters truth;  // of which film
  double z_stretch = 0;
  double ln_ratio = 0;  // of the ratio's logarithm
  double poisson = 0;
  std::size_t corners = 0;  // of all scans together
};

// From how the simulated corners move with the parameters (differences around `truth`), with
// independent noise on every coordinate of every corner, one scan of each object. `design`: the
// film and the dip; a draft will do. `pose_known`: the scans are in the object's frame. Throws
// DipError, Cancelled.
Expectation expect(const std::vector<CalibrationObject>& objects, const CheckeredFilm& film,
                   const DesignOptions& design, const FilmParameters& truth, double noise_mm,
                   const RunContext& context, bool pose_known = false);

}  // namespace hydrodip
