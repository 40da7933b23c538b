#include "job/plan_coverage.h"

#include <algorithm>
#include <cstdint>

#include "base/parallel.h"
#include "job/wanted.h"
#include "job/ways.h"
#include "plan/choice.h"

namespace hydrodip {
PlanCoverage coverage_of(const DipPlan& plan, const JobConfig& config,
                         const PreparedObject& prepared) {
  if (plan.dips.size() == 1) return {{plan.dips.front().blank.coverage.covered_share()}, {}, {}};
  const auto nodes = make_nodes(prepared, config.plan.overlap_mm);
  const Targets& targets = nodes->targets();
  const TrialTask task = job_trials(config, prepared, targets);
  std::vector<Trial> dips(plan.dips.size());
  for (std::size_t k = 0; k < dips.size(); ++k)
    dips[k].worth = worth_at(task, plan.dips[k].blank.posed, *plan.dips[k].blank.film);
  PlanCoverage result;
  std::vector<const Trial*> so_far;
  for (const Trial& dip : dips) {
    so_far.push_back(&dip);
    result.covered_share.push_back(covered_share_of(targets, so_far));
  }
  struct Seen {
    bool reached = false, covered = false;
  };
  std::vector<Seen> seen(targets.list.size());
  parallel_for(seen.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      seen[i].covered =
          std::any_of(dips.begin(), dips.end(), [&](const Trial& dip) { return dip.worth[i] > 0; });
      seen[i].reached = seen[i].covered ||
                        std::any_of(plan.dips.begin(), plan.dips.end(), [&](const PlannedDip& dip) {
                          return is_reached(dip.blank, targets.list[i]);
                        });
    }
  });
  const std::vector<std::uint8_t> is_wanted = wanted_at(targets, *prepared.paint);
  const double scale = prepared.posed.scale();
  result.everywhere.emplace();
  if (!is_wanted.empty()) result.wanted.emplace();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double real_mm2 = scale * scale * targets.list[i].area;
    result.everywhere->add(real_mm2, seen[i].reached, seen[i].covered, false);
    if (result.wanted && is_wanted[i])
      result.wanted->add(real_mm2, seen[i].reached, seen[i].covered, false);
  }
  return result;
}

std::optional<Finding> too_much_torn(const DipPlan& plan, const PlanCoverage& coverage) {
  if (!coverage.everywhere) return std::nullopt;
  Report report;
  report.coverage.emplace();
  report.coverage->object_mm2 = coverage.everywhere->object_mm2;
  report.coverage->covered_mm2 = coverage.everywhere->covered_mm2;
  for (const PlannedDip& dip : plan.dips) {
    report.coverage->film_on_object_mm2 += dip.blank.coverage.film_on_object_mm2;
    report.coverage->torn_mm2 += dip.blank.coverage.torn_mm2;
  }
  report.dips.resize(plan.dips.size());
  report.together = coverage.everywhere;
  report.wanted = coverage.wanted;
  for (const Finding& finding : findings(report))
    if (finding.key == "tears" && finding.concern == Concern::kStop) return finding;
  return std::nullopt;
}

}  // namespace hydrodip
