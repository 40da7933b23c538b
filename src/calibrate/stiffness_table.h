// How stiff each of a board's inks makes film, without supposing a law.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibrate/fit.h"

namespace hydrodip {

// Modulus over that of blank film.
struct InkStiffness {
  double density = 0;              // 1: a full pass
  double law = 1;                  // 1 + density (ratio - 1), with the answer's ratio
  double stiffness = 1;            // what the scans say; rises with the density
  double low_95 = 1, high_95 = 1;  // of that ink alone
};

struct StiffnessTable {
  std::vector<InkStiffness> inks;  // least ink first
  // By how much the table lessens the sum of squares, in squared noise, for each ink beyond the
  // first: about 1 if the law holds.
  double gain_per_ink = 0;
  bool law_holds = true;  // a gain that chance brings in one of a hundred scans or more
};

// `by_ink`: how the fit's residuals move with the logarithm of each ink's stiffness, at the fit's
// answer; a column per density. Of first order: true as long as the table is near to the law.
StiffnessTable stiffness_table(const FilmFit& fit, const std::vector<double>& densities,
                               const Eigen::MatrixXd& by_ink);

// A film on which one of the inks is stiffer by a factor than the law has it: between two inks,
// stiffness is straight in the density.
CheckeredFilm with_ink_stiffer(const CheckeredFilm& film, const std::vector<double>& densities,
                               std::size_t which, double factor, double ratio);

}  // namespace hydrodip
