// How near a finish of several coats comes to what was wanted.
#pragma once

#include <vector>

#include "base/context.h"
#include "coat/finish.h"
#include "plan/seams.h"
#include "report/report.h"

namespace hydrodip {

// Wanted against predicted colour at every node that has film, each averaged over a node and its
// neighbours. CIEDE2000. A value.
class FinishCheck {
 public:
  static constexpr double kOff_mm = 1;

  FinishCheck(const Finish& finish, const SharedSurface& shared, const RunContext& context);

  // Whether film lies anywhere where several dips have a part in the ink.
  bool films_meet() const { return films_meet_; }
  // Means over the nodes in whose ink several dips have a part, and over all others.
  double seam_error() const { return seam_; }
  double other_error() const { return other_; }
  // Over the seams if every dip but the first lands kOff_mm off, in the mean of four directions.
  double seam_error_off() const { return seam_off_; }
  // Everywhere.
  ReportColors colors() const { return colors_; }

  // At the nearest node; 0 where there is none near. In the object's own frame.
  double error_near(const Vec3& position, const Vec3& normal) const;

 private:
  const SurfaceNodes& nodes_;
  std::vector<float> error_;  // per node; negative: no film
  bool films_meet_ = false;
  double seam_ = 0, other_ = 0, seam_off_ = 0;
  ReportColors colors_;
};

}  // namespace hydrodip
