#include "job/dips_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "coat/dipped_object.h"
#include "job/output.h"
#include "job/wanted.h"
#include "job/ways.h"
#include "plan/hold.h"
#include "report/findings.h"

namespace hydrodip {
namespace {

// A place is covered by dips whose films lie there and bring so much of its ink: film on which
// another dip's ink was meant to be is blank there.
constexpr float kMuchOfTheInk = 0.5F;

bool lies_in_doubt(const MadeDip& dip, const Target& node) {
  const Target hung = in_pose(node, dip.posed);
  return is_in_doubt(dip.made.dipped.map->hold_at(hung.position, hung.normal),
                     doubtful_stretch(dip.config.design.dip.material));
}

// What becomes of the surface.
struct Brought {
  std::vector<double> gained;  // per dip: the part covered by it and those before, not without it
  double doubtful_share = 0;   // where so much of the ink comes with film that may tear, or move
  // Of what shall be printed, if that is not everywhere.
  std::optional<ReportWanted> wanted;
  std::vector<double> gained_wanted;  // per dip, a share of it
  ReportWanted everywhere;            // the same of the whole surface
};

Brought brought_by(const MadeDips& all, const SharedSurface& shared) {
  const Targets& targets = all.nodes->targets();
  Brought result;
  result.gained.resize(all.dips.size(), 0);
  const std::vector<std::uint8_t> is_wanted = wanted_at(targets, *all.prepared.paint);
  ReportWanted wanted;
  std::vector<double> gained_wanted_mm2(all.dips.size(), 0);
  double doubtful_mm2 = 0;
  const double scale = all.prepared.posed.scale();
  for (std::size_t i = 0; i < targets.list.size(); ++i) {
    const Target& node = targets.list[i];
    const double real_mm2 = scale * scale * node.area;
    const std::vector<float> shares = shared.shares_at(node.position, node.normal);
    float brought = 0, in_doubt = 0;
    for (std::size_t k = 0; k < all.dips.size(); ++k) {
      const bool was_covered = brought >= kMuchOfTheInk;
      if (all.worth[k][i] > 0) brought += shares[k];
      if (!was_covered && brought >= kMuchOfTheInk) {
        result.gained[k] += node.area / targets.area;
        if (!is_wanted.empty() && is_wanted[i]) gained_wanted_mm2[k] += node.area;
      }
      if (shares[k] > 0 && lies_in_doubt(all.dips[k], node)) in_doubt += shares[k];
    }
    if (in_doubt >= kMuchOfTheInk) doubtful_mm2 += node.area;
    const bool covered = brought >= kMuchOfTheInk;
    const bool reached =
        covered || std::any_of(all.dips.begin(), all.dips.end(), [&](const MadeDip& dip) {
          return is_reached(dip.made.dipped, node);
        });
    const bool doubtful = covered && in_doubt >= kMuchOfTheInk;
    result.everywhere.add(real_mm2, reached, covered, doubtful);
    if (!is_wanted.empty() && is_wanted[i]) wanted.add(real_mm2, reached, covered, doubtful);
  }
  result.doubtful_share = doubtful_mm2 / targets.area;
  if (all.dips.size() == 1) {  // a single film's area is known better than points tell it
    const Coverage& coverage = all.dips.front().made.dipped.coverage;
    result.gained = {coverage.covered_share()};
    result.doubtful_share = coverage.doubtful_share();
  }
  if (is_wanted.empty()) return result;
  for (const double mm2 : gained_wanted_mm2)
    result.gained_wanted.push_back(mm2 * scale * scale / wanted.object_mm2);
  result.wanted = wanted;
  return result;
}

// Of all films together: the surface under those that bring its ink, and the films.
Coverage coverage_together(const MadeDips& all, const Brought& brought) {
  std::vector<const DippedObject*> dips;
  for (const MadeDip& dip : all.dips) dips.push_back(&dip.made.dipped);
  Coverage sum = films_together(dips);
  const double scale = all.prepared.posed.scale();
  sum.object_mm2 = sum.downward_mm2 = scale * scale * all.nodes->targets().area;
  for (const double share : brought.gained) sum.covered_mm2 += share * sum.object_mm2;
  sum.covered_downward_mm2 = sum.covered_mm2;
  sum.doubtful_mm2 = brought.doubtful_share * sum.object_mm2;
  return sum;
}

// The air of each, largest first.
std::shared_ptr<const TrappedAir> air_together(const MadeDips& all) {
  if (all.dips.size() == 1) return all.dips.front().made.dipped.air;
  auto sum = std::make_shared<TrappedAir>();
  for (const MadeDip& dip : all.dips) {
    const TrappedAir& air = *dip.made.dipped.air;
    sum->pockets.insert(sum->pockets.end(), air.pockets.begin(), air.pockets.end());
    sum->vents.insert(sum->vents.end(), air.vents.begin(), air.vents.end());
    sum->cell_mm = std::max(sum->cell_mm, air.cell_mm);
  }
  const auto larger = [](const auto& a, const auto& b) { return a.area_mm2 > b.area_mm2; };
  std::stable_sort(sum->pockets.begin(), sum->pockets.end(), larger);
  std::stable_sort(sum->vents.begin(), sum->vents.end(), larger);
  return sum;
}

// Colours are as far off as in the dip that is known least. What found no equilibrium, its dip
// tells.
ReportEquilibrium equilibrium_together(const MadeDips& all) {
  ReportEquilibrium worst;
  for (const MadeDip& dip : all.dips) {
    const ReportEquilibrium own = equilibrium_of(dip.made.dipped.statistics, &dip.made.ink);
    worst.unsettled_mm = std::max(worst.unsettled_mm, own.unknown_mm());
  }
  return worst;
}

// Which part each does, and what is covered after it.
std::vector<ReportDip> report_dips(const MadeDips& all, const SharedSurface& shared,
                                   const Brought& brought) {
  std::vector<ReportDip> list;
  const std::vector<double> parts = shared.shares_of_surface();
  double so_far = 0;
  for (std::size_t k = 0; k < all.dips.size(); ++k) {
    const MadeDip& dip = all.dips[k];
    so_far += brought.gained[k];
    const Vec3& rotate = dip.trial.pose.rotate_deg;
    list.push_back(
        {side_name(dip.trial.pose.down),
         {rotate.x(), rotate.y(), rotate.z()},
         dip.trial.depth_mm,
         describe_hold(dip.trial.pose, way_up(all.config)),
         dip.folder,
         parts[k],
         brought.gained[k],
         so_far,
         dip.made.dipped.coverage.torn_share(),
         obstacle_of(dip.made.dipped, &dip.made.ink, dip.config.design.dip.material.tear_stretch,
                     std::size_t(dip.number), all.dips.size()),
         brought.wanted ? std::optional(brought.gained_wanted[k]) : std::nullopt,
         dip.blank,
         dip.trial.path});
  }
  return list;
}

std::vector<ReportOutput> outputs_of(const MadeDips& all) {
  std::vector<ReportOutput> list;
  const char* side = all.config.print.ink_side == InkSide::kUp ? "up" : "down";
  for (std::size_t k = 0; k < all.dips.size(); ++k) {
    const std::string& folder = all.dips[k].folder;
    list.push_back(
        {folder + "/print.pdf",
         fmt::format("sheet {}: print it at 100 % (no scaling), ink side {}", k + 1, side)});
  }
  list.push_back({"dip-.../print.png, print.tif, film.ply, preview.glb, report.json",
                  "what belongs to each dip"});
  if (all.config.pictures) {
    list.push_back({"preview.png", "the whole finish: what was asked for beside what comes out"});
    list.push_back({"dips.png", "which dip does which part, and how far colours are off"});
  }
  list.push_back({"report.html", "everything about this job, for people"});
  list.push_back({"report.json", "the same for programs"});
  return list;
}

}  // namespace

Report report_on(const MadeDips& all, const SharedSurface& shared, const FinishCheck& check,
                 const JobRecord& record) {
  Report report = make_report(record);
  const Brought brought = brought_by(all, shared);
  report.coverage = coverage_together(all, brought);
  report.wanted = brought.wanted;
  report.air = air_together(all);
  if (all.dips.size() > 1) {
    report.together = brought.everywhere;
    report.equilibrium = equilibrium_together(all);
  }
  report.angles.reset();
  report.figures = {model_size(all.prepared.posed)};
  report.rounds.clear();
  report.dips = report_dips(all, shared, brought);
  report.colors = check.colors();
  report.seams = ReportSeams{check.films_meet() ? shared.seam_mm() : 0, all.config.plan.overlap_mm,
                             check.seam_error(), FinishCheck::kOff_mm, check.seam_error_off()};
  report.outputs = outputs_of(all);
  return report;
}

std::optional<ReportObstacle> obstacle_of(const DippedObject& dipped, const InkResult* ink,
                                          double tear_stretch, std::size_t number, std::size_t of) {
  if (of == 1) return std::nullopt;  // the report is its own
  Report report;
  report.dip_number = int(number);
  report.dip_of = int(of);
  report.coverage = dipped.coverage;
  report.air = dipped.air;
  report.equilibrium = equilibrium_of(dipped.statistics, ink);
  report.tear_stretch = tear_stretch;
  std::optional<ReportObstacle> air;
  for (const Finding& finding : findings(report)) {
    const ReportObstacle told{finding.title + ": " + finding.figure, finding.text, finding.advice,
                              finding.concern == Concern::kStop};
    // Of tears and bare surface all together decide.
    if (told.forbids && finding.key != "tears" && finding.key != "coverage") return told;
    if (!air && (finding.key == "air" || finding.key == "vent")) air = told;
  }
  return air;
}

Coverage films_together(const std::vector<const DippedObject*>& dips) {
  Coverage sum;
  double stretch = 0, area_ratio = 0;
  for (const DippedObject* dip : dips) {
    const Coverage& c = dip->coverage;
    sum.film_on_object_mm2 += c.film_on_object_mm2;
    sum.torn_mm2 += c.torn_mm2;
    sum.wrinkled_mm2 += c.wrinkled_mm2;
    sum.lifted_mm2 += c.lifted_mm2;
    if (c.lifted_mm2 > 0) sum.lifted_at = c.lifted_at;
    sum.stretch_max = std::max(sum.stretch_max, c.stretch_max);
    sum.area_ratio_max = std::max(sum.area_ratio_max, c.area_ratio_max);
    stretch += c.stretch_mean * c.film_on_object_mm2;
    area_ratio += c.area_ratio_mean * c.film_on_object_mm2;
  }
  if (sum.film_on_object_mm2 > 0) {
    sum.stretch_mean = stretch / sum.film_on_object_mm2;
    sum.area_ratio_mean = area_ratio / sum.film_on_object_mm2;
  }
  return sum;
}

std::vector<std::string> file_names(const MadeDips& all) {
  std::vector<std::string> names;
  for (const MadeDip& dip : all.dips)
    for (const std::string& name : files_of_dip()) names.push_back(dip.folder + "/" + name);
  if (all.config.pictures) names.insert(names.end(), {"preview.png", "dips.png"});
  names.insert(names.end(), {"report.html", "report.json"});
  return names;
}

}  // namespace hydrodip
