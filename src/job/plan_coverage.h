// What planned dips come to: how much they cover together, as blank film, and what their print will
// say of them.
#pragma once

#include <cstddef>
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
  // The same of what shall be printed, if that is not everywhere; empty: it is, or nobody knows.
  std::vector<double> covered_wanted_share;
  // Of all together: of several the whole surface, and what shall be printed likewise.
  std::optional<ReportWanted> everywhere, wanted;
};

// What the kth dip, from 0 on, adds to one of these shares.
double gained(const std::vector<double>& covered, std::size_t k);

PlanCoverage coverage_of(const DipPlan& plan, const JobConfig& config,
                         const PreparedObject& prepared);

// Why a print would advise against these dips, and which of them are hardly worth their film. Of
// blank film.
std::vector<Finding> foretold(const DipPlan& plan, const PlanCoverage& coverage,
                              const JobConfig& config);

}  // namespace hydrodip
