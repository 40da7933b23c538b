#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/json_text.h"
#include "base/plain_number.h"
#include "base/run_scope.h"
#include "base/shell_word.h"
#include "job/dip_plan.h"
#include "job/plan_coverage.h"
#include "job/search_output.h"
#include "job/ways.h"
#include "plan/choice.h"
#include "plan/hold.h"
#include "render/hold_pictures.h"
#include "settings/job_file.h"

namespace hydrodip {
namespace {

using json = nlohmann::ordered_json;

constexpr LinearColor kEarlier{0.33F, 0.42F, 0.5F, 1};

// Shares of the surface under film after each dip.
using Covered = std::vector<double>;

json path_json(const std::vector<Keyframe>& path) {
  if (path.empty()) return nullptr;
  json rows = json::array();
  for (const Keyframe& k : path)
    rows.push_back(
        {k.lower_mm, k.shift_x_mm, k.shift_y_mm, k.turn_x_deg, k.turn_y_deg, k.turn_z_deg});
  return rows;
}

json missed_json(const PlanCoverage& coverage) {
  const auto& counted = coverage.wanted ? coverage.wanted : coverage.everywhere;
  return counted ? json(counted->missed_share()) : json(nullptr);
}

std::string machine_readable(const JobConfig& config, const DipPlan& plan,
                             const PlanCoverage& coverage) {
  const Covered& covered = coverage.covered_share;
  json dips = json::array(), counts = json::array();
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    const Trial& dip = plan.dips[k].trial;
    const Vec3& rotate = dip.pose.rotate_deg;
    dips.push_back({{"down", side_name(dip.pose.down)},
                    {"rotate_deg", {rotate.x(), rotate.y(), rotate.z()}},
                    {"depth_mm", dip.depth_mm},
                    {"path", path_json(dip.path)},
                    {"gained_share", gained(covered, k)},
                    {"covered_share", covered[k]},
                    {"torn_share", dip.figures.torn_share},
                    {"text", describe_trial(dip, way_up(config))}});
    counts.push_back({{"dips", k + 1}, {"covered_share", covered[k]}});
    if (!coverage.wanted) continue;
    const Covered& wanted = coverage.covered_wanted_share;
    dips.back()["gained_wanted_share"] = gained(wanted, k);
    counts.back()["covered_wanted_share"] = wanted[k];
  }
  const json all = {{"schema_version", 1},
                    {"command", "plan"},
                    {"model", config.model.string()},
                    {"trial_dips", plan.trial_dips},
                    {"coverage", counts},
                    {"missed_share", missed_json(coverage)},
                    {"dips", dips}};
  return json_text(all);
}

std::string after_each(const Covered& covered) {
  std::string text;
  for (std::size_t k = 0; k < covered.size(); ++k)
    text += fmt::format("{}{}: {}", k > 0 ? ", " : "", k + 1, percent(covered[k]));
  return text;
}

std::string in_words(const JobConfig& config, const DipPlan& plan, const PlanCoverage& coverage) {
  std::string text =
      fmt::format("covered after so many dips: {}", after_each(coverage.covered_share));
  if (coverage.wanted)
    text = fmt::format("{} of the surface; of what shall be printed: {}", text,
                       after_each(coverage.covered_wanted_share));
  text += " (of film without ink, which stiffens it: a print's may differ by some points)\n";
  for (std::size_t k = 0; k < plan.dips.size(); ++k)
    text +=
        fmt::format("{}. {}\n   {}\n", k + 1, describe_trial(plan.dips[k].trial, way_up(config)),
                    trial_options(plan.dips[k].trial));
  return text;
}

// Each dip as it hangs: what it covers anew in the wanted colours, what an earlier one does in grey
// blue.
Image draw(const JobConfig& config, const PreparedObject& prepared, const DipPlan& plan,
           const PlanCoverage& coverage, const RunContext& context) {
  const Covered& covered = coverage.wanted ? coverage.covered_wanted_share : coverage.covered_share;
  const std::string of = coverage.wanted ? " of what shall be printed" : "";
  const Paint& paint = *prepared.paint;
  std::vector<HoldPicture> pictures;
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    const auto look = [&paint, &plan, k](const SurfacePoint& point, const Vec3&, const Vec3&) {
      const auto lies = [&](std::size_t j) {
        return plan.dips[j].blank.map->to_film(point).has_value();
      };
      for (std::size_t j = 0; j < k; ++j)
        if (lies(j)) return kEarlier;
      if (!lies(k)) return kHoldBare;
      return paint.says_anything() ? paint.color_at(point) : kHoldCovered;
    };
    const Trial& dip = plan.dips[k].trial;
    pictures.push_back(
        {plan.dips[k].blank.posed.mesh(), plan.dips[k].blank.posed.surface(), look, dip.depth_mm,
         fmt::format("dip {}: {}, {:.4g} mm deep", k + 1, describe_hold(dip.pose, way_up(config)),
                     dip.depth_mm),
         fmt::format("adds {:.1f} %{}, {:.1f} % are covered after it{}{}", 100 * gained(covered, k),
                     of, 100 * covered[k], paint.says_anything() ? "" : "; teal: this dip",
                     k > 0 ? "; grey blue: done before" : "")});
  }
  return render_holds(pictures, config.preview_width_px, context);
}

// What the print of these dips will say, before anything is printed.
void warn_of(const std::vector<Finding>& told, std::size_t dips, const RunContext& context) {
  for (const Finding& finding : told) {
    const bool is_of_film = finding.key == "tears" || finding.key == "coverage";
    const std::string words = fmt::format("{}{} {} {}", is_of_film ? "" : finding.title + ": ",
                                          finding.figure, finding.text, finding.advice);
    context.warn(finding.concern != Concern::kStop ? words
                 : dips == 1 ? "The print of this dip will advise against it: " + words
                             : "The print of these dips will advise against them: " + words);
  }
}

// A plan needs no picture, its print does.
std::string printing(const SearchOutput& output) {
  const std::string file = shell_word((output.folder() / "plan.toml").string());
  // A plan.toml of its own name would share its folder with every other plan's print.
  const std::string result = shell_word(output.config().model.stem().string() + "-print");
  const PreparedObject& prepared = output.prepared();
  if (prepared.paint->says_anything())
    return fmt::format("print them all: hydrodip print {} -o {}\n", file, result);
  const bool has_uvs = !prepared.posed.object().uvs.empty();
  return fmt::format(
      "print them all, with the picture that goes on the model: hydrodip print {1} {0} -o {2}\n"
      "better say {0} to 'hydrodip plan' already: then dips are chosen by what it shows\n",
      has_uvs ? "--texture IMG" : "--art IMG", file, result);
}

}  // namespace

JobResult plan_job(const JobConfig& config, const RunContext& context, const JobConfig* to_print) {
  const RunScope scope(context.with_threads(config.threads));
  SearchOutput output(config, "plan", {"plan.toml"}, context);
  const DipPlan plan = plan_dips(config, output.prepared(), output.targets(), true, context);
  JobConfig planned = to_print != nullptr ? *to_print : config;
  planned.dips = entries_of(plan, config);
  planned.plan.dips = 0;
  planned.plan.find_pose = planned.plan.find_depth = false;
  planned.design.trajectory.depth_mm = 0;  // each has its own
  write_file(output.path("plan.toml"), job_file(planned, output.folder()));
  const PlanCoverage coverage = coverage_of(plan, config, output.prepared());
  warn_of(foretold(plan, coverage, config), plan.dips.size(), context);
  JobResult result =
      output.finish(machine_readable(config, plan, coverage), in_words(config, plan, coverage),
                    [&] { return draw(config, output.prepared(), plan, coverage, context); });
  result.text += told_places(output.prepared().artwork) + printing(output);
  return result;
}

}  // namespace hydrodip
