#include "job/plan_coverage.h"

#include <algorithm>
#include <cstdint>

#include "base/parallel.h"
#include "job/wanted.h"
#include "job/ways.h"
#include "plan/choice.h"

namespace hydrodip {
namespace {

bool comes_to_film(const DipPlan& plan, const Target& node) {
  return std::any_of(plan.dips.begin(), plan.dips.end(), [&](const PlannedDip& dip) {
    return faces_film(dip.blank, in_pose(node, dip.blank.posed));
  });
}

// Where `counts` says so; empty: everywhere.
ReportWanted summed(const Targets& targets, const std::vector<std::uint8_t>& reached,
                    const std::vector<std::uint8_t>& covered,
                    const std::vector<std::uint8_t>& counts, double scale) {
  ReportWanted sum;
  for (std::size_t i = 0; i < targets.list.size(); ++i) {
    if (!counts.empty() && !counts[i]) continue;
    const double real_mm2 = scale * scale * targets.list[i].area;
    sum.object_mm2 += real_mm2;
    sum.reached_mm2 += reached[i] ? real_mm2 : 0;
    sum.covered_mm2 += covered[i] ? real_mm2 : 0;
  }
  return sum;
}

}  // namespace

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
  std::vector<std::uint8_t> covered(targets.list.size()), reached(targets.list.size());
  parallel_for(covered.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      covered[i] =
          std::any_of(dips.begin(), dips.end(), [&](const Trial& dip) { return dip.worth[i] > 0; });
      reached[i] = covered[i] || comes_to_film(plan, targets.list[i]);
    }
  });
  const double scale = prepared.posed.scale();
  result.everywhere = summed(targets, reached, covered, {}, scale);
  const std::vector<std::uint8_t> is_wanted = wanted_at(targets, *prepared.paint);
  if (!is_wanted.empty()) result.wanted = summed(targets, reached, covered, is_wanted, scale);
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
