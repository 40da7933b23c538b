#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "coat/dipped_object.h"
#include "image/files.h"
#include "job/command_text.h"
#include "job/jobs.h"
#include "job/prepare.h"
#include "job/ways.h"
#include "render/hold_pictures.h"

namespace hydrodip {
namespace {

using json = nlohmann::ordered_json;

constexpr LinearColor kTorn{0.55F, 0.02F, 0.02F, 1};

std::string command_for(const JobConfig& config, const Trial& trial) {
  return command_text(config, "print") + " " + trial_options(trial);
}

json pose_json(const JobConfig& config, const Trial& trial) {
  const Vec3& rotate = trial.pose.rotate_deg;
  const TrialFigures& f = trial.figures;
  return {{"rotate_deg", {rotate.x(), rotate.y(), rotate.z()}},
          {"down", side_name(trial.pose.down)},
          {"depth_mm", trial.depth_mm},
          {"covered_share", f.covered_share},
          {"torn_share", f.torn_share},
          {"doubtful_share", f.doubtful_share},
          {"air_mm2", f.air_mm2},
          {"score", f.score},
          {"text", describe_trial(trial, way_up(config))},
          {"command", command_for(config, trial)}};
}

std::string machine_readable(const JobConfig& config, const SearchResult& found) {
  json all = {{"schema_version", 1},
              {"command", "orient"},
              {"model", config.model.string()},
              {"trial_dips", found.trials.size()},
              {"poses", json::array()}};
  for (const Trial& trial : found.best) all["poses"].push_back(pose_json(config, trial));
  return all.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string figures_text(const Trial& trial) {
  const TrialFigures& f = trial.figures;
  return fmt::format("{:.1f} % covered, {:.1f} % torn, {:.1f} % doubtful, score {:.3f}",
                     100 * f.covered_share, 100 * f.torn_share, 100 * f.doubtful_share, f.score);
}

// The dip in that pose, for its picture.
DippedObject dip_like(const JobConfig& config, const PreparedObject& prepared, const Trial& trial,
                      const RunContext& context) {
  const DesignOptions draft = draft_of(config.design);
  Timings unheard;
  RunContext quiet = context.quiet();
  return dip_object(PosedObject(prepared.posed.shared_object(), trial.pose),
                    std::make_shared<const FilmMesh>(make_film_mesh(draft.film)),
                    Trajectory::straight_down(trial.depth_mm), draft.dip, unheard, quiet);
}

// Where film lies in the wanted colours, or in one where none are wanted.
Image draw_holds(const JobConfig& config, const PreparedObject& prepared,
                 const std::vector<Trial>& best, const RunContext& context) {
  std::vector<DippedObject> dipped;
  for (const Trial& trial : best) dipped.push_back(dip_like(config, prepared, trial, context));
  const Paint& paint = *prepared.paint;
  std::vector<HoldPicture> pictures;
  for (std::size_t i = 0; i < best.size(); ++i) {
    const DippedObject& d = dipped[i];
    const auto look = [&paint, &d](const SurfacePoint& point, const Vec3& position,
                                   const Vec3& normal) {
      if (d.map->to_film(position, normal))
        return paint.says_anything() ? paint.color_at(point) : kHoldCovered;
      return d.map->torn_at(position, normal) ? kTorn : kHoldBare;
    };
    pictures.push_back({d.posed.mesh(), d.posed.surface(), look, best[i].depth_mm,
                        fmt::format("{}. {}, {:.4g} mm deep", i + 1,
                                    describe_hold(best[i].pose, way_up(config)), best[i].depth_mm),
                        figures_text(best[i]) + ": " + trial_options(best[i])});
  }
  return render_holds(pictures, config.preview_width_px, context);
}

std::string in_words(const JobConfig& config, const SearchResult& found,
                     const std::vector<std::string>& warnings) {
  std::string text = fmt::format("{} ways to hold it were tried; the best:\n", found.trials.size());
  for (std::size_t i = 0; i < found.best.size(); ++i)
    text +=
        fmt::format("{}. {}\n   {}\n   {}\n", i + 1, describe_trial(found.best[i], way_up(config)),
                    figures_text(found.best[i]), command_for(config, found.best[i]));
  for (const std::string& warning : warnings) text += "warning: " + warning + "\n";
  return text;
}

}  // namespace

JobResult orient_job(const JobConfig& config, const RunContext& context) {
  const RunScope scope(context.with_threads(config.threads));
  OutputFolder folder(config.output, config.earlier_result);
  const PreparedObject prepared = prepare_object(config.model, config.object, context);
  require_size(prepared.posed, config.object, config.model);
  const std::vector<std::string> names = config.pictures
                                             ? std::vector<std::string>{"orient.json", "orient.png"}
                                             : std::vector<std::string>{"orient.json"};
  folder.announce(names, prepared.files);
  const Targets targets = job_targets(config, prepared, context);
  TrialTask task = job_trials(config, prepared, targets);
  if (!config.plan.find_depth) task.depth_mm = config.design.trajectory.depth_mm;

  std::string best_yet;
  const SearchResult found =
      search_holds(task, config.object.pose, {}, context, [&](const Trial& best) {
        const std::string words = describe_trial(best, way_up(config));
        if (words != best_yet) context.progress("best so far: " + words, 0);
        best_yet = words;
      });

  JobResult result;
  result.folder = folder.folder();
  result.files = names;
  result.json = machine_readable(config, found);
  result.text = in_words(config, found, context.warnings());
  write_file(folder.path("orient.json"), result.json);
  if (config.pictures) {
    const std::vector<std::uint8_t> png =
        encode_png(draw_holds(config, prepared, found.best, context));
    write_file(folder.path("orient.png"), png.data(), png.size());
  }
  context.check_cancelled();
  folder.commit();
  result.text += fmt::format("wrote to {}:", folder.folder().string());
  for (const std::string& name : names) result.text += " " + name;
  result.text += "\n";
  return result;
}

}  // namespace hydrodip
