#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "image/files.h"
#include "job/command_text.h"
#include "job/dip_plan.h"
#include "job/jobs.h"
#include "render/hold_pictures.h"
#include "settings/job_file.h"

namespace hydrodip {
namespace {

using json = nlohmann::ordered_json;

constexpr LinearColor kEarlier{0.33F, 0.42F, 0.5F, 1};

double gained(const DipPlan& plan, std::size_t k) {
  return plan.covered_after[k] - (k > 0 ? plan.covered_after[k - 1] : 0);
}

json path_json(const std::vector<Keyframe>& path) {
  if (path.empty()) return nullptr;
  json rows = json::array();
  for (const Keyframe& k : path)
    rows.push_back(
        {k.lower_mm, k.shift_x_mm, k.shift_y_mm, k.turn_x_deg, k.turn_y_deg, k.turn_z_deg});
  return rows;
}

std::string machine_readable(const JobConfig& config, const DipPlan& plan) {
  json dips = json::array(), counts = json::array();
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    const Trial& dip = plan.dips[k];
    const Vec3& rotate = dip.pose.rotate_deg;
    dips.push_back({{"down", side_name(dip.pose.down)},
                    {"rotate_deg", {rotate.x(), rotate.y(), rotate.z()}},
                    {"depth_mm", dip.depth_mm},
                    {"path", path_json(dip.path)},
                    {"gained_share", gained(plan, k)},
                    {"covered_share", plan.covered_after[k]},
                    {"torn_share", dip.figures.torn_share},
                    {"text", describe_trial(dip, way_up(config))}});
    counts.push_back({{"dips", k + 1}, {"covered_share", plan.covered_after[k]}});
  }
  const json all = {
      {"schema_version", 1},           {"command", "plan"},  {"model", config.model.string()},
      {"trial_dips", plan.trial_dips}, {"coverage", counts}, {"dips", dips}};
  return all.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string in_words(const JobConfig& config, const DipPlan& plan,
                     const std::vector<std::string>& warnings) {
  std::string text = "covered after so many dips:";
  for (std::size_t k = 0; k < plan.dips.size(); ++k)
    text += fmt::format("{} {}: {:.0f} %", k > 0 ? "," : "", k + 1, 100 * plan.covered_after[k]);
  text += "\n";
  for (std::size_t k = 0; k < plan.dips.size(); ++k)
    text += fmt::format("{}. {}\n   {}\n", k + 1, describe_trial(plan.dips[k], way_up(config)),
                        trial_options(plan.dips[k]));
  for (const std::string& warning : warnings) text += "warning: " + warning + "\n";
  return text;
}

Trajectory way_of(const JobConfig& config, const Trial& dip, const PreparedObject& prepared) {
  if (dip.path.empty()) return Trajectory::straight_down(dip.depth_mm);
  TrajectoryOptions way = config.design.trajectory;
  way.path = dip.path;
  return make_trajectory(way,
                         PosedObject(prepared.posed.shared_object(), dip.pose).mesh().positions);
}

// Each dip as it hangs: what it covers anew in the wanted colours, what an earlier one does in grey
// blue.
Image draw(const JobConfig& config, const PreparedObject& prepared, const DipPlan& plan,
           const RunContext& context) {
  const DesignOptions draft = draft_of(config.design);
  const auto film = std::make_shared<const FilmMesh>(make_film_mesh(draft.film));
  std::vector<DippedObject> dipped;
  for (const Trial& dip : plan.dips) {
    Timings unheard;
    RunContext quiet = context.quiet();
    dipped.push_back(dip_object(PosedObject(prepared.posed.shared_object(), dip.pose), film,
                                way_of(config, dip, prepared), draft.dip, unheard, quiet));
  }
  const Paint& paint = *prepared.paint;
  std::vector<HoldPicture> pictures;
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    const auto look = [&paint, &dipped, k](const SurfacePoint& point, const Vec3&, const Vec3&) {
      const auto lies = [&](const DippedObject& d) {
        return d.map
            ->to_film(position_at(d.posed.mesh(), point),
                      face_normal(d.posed.mesh(), point.triangle))
            .has_value();
      };
      for (std::size_t j = 0; j < k; ++j)
        if (lies(dipped[j])) return kEarlier;
      if (!lies(dipped[k])) return kHoldBare;
      return paint.says_anything() ? paint.color_at(point) : kHoldCovered;
    };
    const Trial& dip = plan.dips[k];
    pictures.push_back(
        {dipped[k].posed.mesh(), dipped[k].posed.surface(), look, dip.depth_mm,
         fmt::format("dip {}: {}, {:.4g} mm deep", k + 1, describe_hold(dip.pose, way_up(config)),
                     dip.depth_mm),
         fmt::format("adds {:.1f} %, {:.1f} % are covered after it; blue: done before",
                     100 * gained(plan, k), 100 * plan.covered_after[k])});
  }
  return render_holds(pictures, config.preview_width_px, context);
}

}  // namespace

JobResult plan_job(const JobConfig& config, const RunContext& context) {
  const RunScope scope(context.with_threads(config.threads));
  OutputFolder folder(config.output, config.earlier_result);
  const PreparedObject prepared = prepare_object(config.model, config.object, context);
  require_size(prepared.posed, config.object, config.model);
  std::vector<std::string> names = {"plan.toml", "plan.json"};
  if (config.pictures) names.emplace_back("plan.png");
  std::vector<std::filesystem::path> inputs = prepared.files;
  inputs.insert(inputs.end(), config.settings_files.begin(), config.settings_files.end());
  folder.announce(names, inputs);
  const Targets targets = job_targets(config, prepared, context);
  const DipPlan plan = plan_dips(config, prepared, targets, true, context);

  JobResult result;
  result.folder = folder.folder();
  result.files = names;
  result.json = machine_readable(config, plan);
  result.text = in_words(config, plan, context.warnings());
  write_file(folder.path("plan.json"), result.json);
  JobConfig planned = config;
  planned.dips = entries_of(plan, config.dips);
  planned.plan.dips = 0;
  planned.plan.find_pose = planned.plan.find_depth = false;
  write_file(folder.path("plan.toml"), job_file(planned, folder.folder()));
  if (config.pictures) {
    const std::vector<std::uint8_t> png = encode_png(draw(config, prepared, plan, context));
    write_file(folder.path("plan.png"), png.data(), png.size());
  }
  context.check_cancelled();
  folder.commit();
  result.text += fmt::format("wrote to {}:", folder.folder().string());
  for (const std::string& name : names) result.text += " " + name;
  result.text += fmt::format("\nprint them all: hydrodip print {}\n",
                             (folder.folder() / "plan.toml").string());
  return result;
}

}  // namespace hydrodip
