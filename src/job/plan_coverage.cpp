#include "job/plan_coverage.h"

#include <algorithm>
#include <cstdint>

#include "base/parallel.h"
#include "job/dips_report.h"
#include "job/wanted.h"
#include "job/ways.h"

namespace hydrodip {
namespace {

// Of a point of the surface: the first dip whose film stays there, and whether one comes to it.
struct Seen {
  std::size_t covered_by = 0;
  bool is_covered = false, is_reached = false;
};

std::vector<Seen> seen_by(const DipPlan& plan, const TrialTask& task) {
  const Targets& targets = task.targets;
  std::vector<std::vector<float>> worth;
  for (const PlannedDip& dip : plan.dips)
    worth.push_back(worth_at(task, dip.blank.posed, *dip.blank.film));
  std::vector<Seen> seen(targets.list.size());
  parallel_for(seen.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::size_t& first = seen[i].covered_by;
      while (first < worth.size() && !(worth[first][i] > 0)) ++first;
      seen[i].is_covered = first < worth.size();
      seen[i].is_reached = seen[i].is_covered ||
                           std::any_of(plan.dips.begin(), plan.dips.end(), [&](const auto& dip) {
                             return is_reached(dip.blank, targets.list[i]);
                           });
    }
  });
  return seen;
}

// Of what `counts` of the points.
template <class Counts>
ReportWanted sum_of(const std::vector<Seen>& seen, const Targets& targets, double scale,
                    const Counts& counts, std::vector<double>& covered_share) {
  ReportWanted sum;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!counts(i)) continue;
    const double mm2 = scale * scale * targets.list[i].area;
    sum.add(mm2, seen[i].is_reached, seen[i].is_covered, false);
    for (std::size_t k = seen[i].covered_by; k < covered_share.size(); ++k) covered_share[k] += mm2;
  }
  for (double& share : covered_share) share = Coverage::share(share, sum.object_mm2);
  return sum;
}

}  // namespace

double gained(const std::vector<double>& covered, std::size_t k) {
  return covered[k] - (k > 0 ? covered[k - 1] : 0);
}

PlanCoverage coverage_of(const DipPlan& plan, const JobConfig& config,
                         const PreparedObject& prepared) {
  const auto nodes = make_nodes(prepared, config.plan.overlap_mm);
  const Targets& targets = nodes->targets();
  const std::vector<Seen> seen = seen_by(plan, job_trials(config, prepared, targets));
  const double scale = prepared.posed.scale();
  PlanCoverage result;
  result.covered_share.resize(plan.dips.size());
  const auto all = [](std::size_t) { return true; };
  result.everywhere = sum_of(seen, targets, scale, all, result.covered_share);
  const std::vector<std::uint8_t> is_wanted = wanted_at(targets, *prepared.paint);
  if (!is_wanted.empty()) {
    result.covered_wanted_share.resize(plan.dips.size());
    const auto wanted = [&](std::size_t i) { return is_wanted[i] != 0; };
    result.wanted = sum_of(seen, targets, scale, wanted, result.covered_wanted_share);
  }
  if (plan.dips.size() == 1) {
    result.covered_share = {plan.dips.front().blank.coverage.covered_share()};
    result.everywhere.reset();
  }
  return result;
}

std::vector<Finding> foretold(const DipPlan& plan, const PlanCoverage& coverage,
                              const JobConfig& config) {
  Report report;
  report.tear_stretch = config.design.dip.material.tear_stretch;
  std::vector<const DippedObject*> films;
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    const DippedObject& blank = plan.dips[k].blank;
    films.push_back(&blank);
    ReportDip dip;
    dip.gained_share = gained(coverage.covered_share, k);
    if (coverage.wanted) dip.gained_wanted_share = gained(coverage.covered_wanted_share, k);
    dip.torn_share = blank.coverage.torn_share();
    dip.obstacle = obstacle_of(blank, nullptr, report.tear_stretch, k + 1, plan.dips.size());
    report.dips.push_back(dip);
  }
  report.coverage = films_together(films);
  const DippedObject& first = *films.front();
  report.coverage->object_mm2 = first.coverage.object_mm2;
  report.coverage->covered_mm2 = coverage.covered_share.back() * first.coverage.object_mm2;
  report.together = coverage.everywhere;
  report.wanted = coverage.wanted;
  if (films.size() == 1) {
    report.air = first.air;
    report.equilibrium = equilibrium_of(first.statistics, nullptr);
  }
  std::vector<Finding> told = findings(report);
  std::erase_if(told, [](const Finding& finding) {
    return finding.concern != Concern::kStop && finding.key != "poor_dips";
  });
  return told;
}

}  // namespace hydrodip
