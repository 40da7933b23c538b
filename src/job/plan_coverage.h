// What planned dips come to: how much they cover together, as blank film, and whether that is worth
// printing.
#pragma once

#include <optional>
#include <vector>

#include "job/dip_plan.h"
#include "job/prepare.h"
#include "report/findings.h"
#include "report/report.h"
#include "settings/config.h"

namespace hydrodip {

struct PlanCoverage {
  // Share of the surface under film after each dip: counted at the points at which a print counts,
  // of a single dip its film's area.
  std::vector<double> covered_share;
  // Of several: of all together, of the whole surface and of what shall be printed if that is not
  // everywhere.
  std::optional<ReportWanted> everywhere, wanted;
};

PlanCoverage coverage_of(const DipPlan& plan, const JobConfig& config,
                         const PreparedObject& prepared);

// What a print would say of the film that tears, if it would advise against these dips for that.
std::optional<Finding> too_much_torn(const DipPlan& plan, const PlanCoverage& coverage);

}  // namespace hydrodip
