#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "base/run_scope.h"
#include "job/command_text.h"
#include "job/print_dips.h"
#include "job/search_output.h"
#include "job/ways.h"
#include "plan/hold.h"
#include "plan/trial.h"
#include "render/hold_pictures.h"
#include "transfer/film_map.h"

namespace hydrodip {
namespace {

using json = nlohmann::ordered_json;

constexpr LinearColor kTorn{0.55F, 0.02F, 0.02F, 1};

// What to do with ways to hold it: print, or where there is nothing to print, look.
class Commands {
 public:
  Commands(const JobConfig& config, const PreparedObject& prepared, const RunContext& context)
      : begin_(command_text(config, prepared.paint->says_anything() ? "print" : "simulate")),
        end_(artwork_options(config, prepared, context)) {}
  std::string options(const Trial& trial) const { return trial_options(trial) + end_; }
  std::string command(const Trial& trial) const { return begin_ + " " + options(trial); }

 private:
  std::string begin_, end_;
};

json pose_json(const JobConfig& config, const Commands& commands, const Trial& trial) {
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
          {"command", commands.command(trial)}};
}

std::string machine_readable(const JobConfig& config, const Commands& commands,
                             const SearchResult& found) {
  json all = {{"schema_version", 1},
              {"command", "orient"},
              {"model", config.model.string()},
              {"trial_dips", found.trials.size()},
              {"poses", json::array()}};
  for (const Trial& trial : found.best) all["poses"].push_back(pose_json(config, commands, trial));
  return json_text(all);
}

std::string figures_text(const Trial& trial) {
  const TrialFigures& f = trial.figures;
  std::string text = fmt::format("{:.1f} % covered, {:.1f} % torn, {:.1f} % doubtful",
                                 100 * f.covered_share, 100 * f.torn_share, 100 * f.doubtful_share);
  if (f.air_mm2 > 0) text += fmt::format(", {:.0f} mm2 under trapped air", f.air_mm2);
  return text + fmt::format(", score {:.3f}", f.score);
}

// Where its film lies in the wanted colours, or in one where none are wanted.
Image draw_holds(const JobConfig& config, const PreparedObject& prepared, const Commands& commands,
                 const std::vector<Trial>& best, const RunContext& context) {
  const Paint& paint = *prepared.paint;
  std::vector<PosedObject> posed;
  posed.reserve(best.size());
  for (const Trial& trial : best) posed.emplace_back(prepared.posed.shared_object(), trial.pose);
  std::vector<FilmMap> maps;
  for (std::size_t i = 0; i < best.size(); ++i)
    maps.emplace_back(posed[i].mesh(), posed[i].surface(), *best[i].film);
  std::vector<HoldPicture> pictures;
  for (std::size_t i = 0; i < best.size(); ++i) {
    const auto look = [&paint, &map = maps[i]](const SurfacePoint& point, const Vec3& position,
                                               const Vec3& normal) {
      if (map.to_film(position, normal))
        return paint.says_anything() ? paint.color_at(point) : kHoldCovered;
      return map.torn_at(position, normal) ? kTorn : kHoldBare;
    };
    pictures.push_back({posed[i].mesh(), posed[i].surface(), look, best[i].depth_mm,
                        fmt::format("{}. {}, {:.4g} mm deep", i + 1,
                                    describe_hold(best[i].pose, way_up(config)), best[i].depth_mm),
                        figures_text(best[i]) + ": " + commands.options(best[i])});
  }
  return render_holds(pictures, config.preview_width_px, context);
}

std::string in_words(const JobConfig& config, const Commands& commands, const SearchResult& found) {
  std::string text = fmt::format("{} ways to hold it were tried; the best:\n", found.trials.size());
  for (std::size_t i = 0; i < found.best.size(); ++i)
    text +=
        fmt::format("{}. {}\n   {}\n   {}\n", i + 1, describe_trial(found.best[i], way_up(config)),
                    figures_text(found.best[i]), commands.command(found.best[i]));
  return text;
}

}  // namespace

JobResult orient_job(const JobConfig& given, const RunContext& context) {
  JobConfig config = given;
  config.plan.dips = 0;  // of another command
  require_one_dip(config,
                  "orient looks for ways to make one dip; 'hydrodip plan' looks for theirs");
  config.plan.find_depth = config.plan.find_depth || !(config.design.trajectory.depth_mm > 0);
  const RunScope scope(context.with_threads(config.threads));
  SearchOutput output(config, "orient", {}, context);
  const SearchResult found = find_holds(config, output.prepared(), output.targets(), context);
  const Commands commands(config, output.prepared(), context);
  return output.finish(
      machine_readable(config, commands, found), in_words(config, commands, found),
      [&] { return draw_holds(config, output.prepared(), commands, found.best, context); });
}

}  // namespace hydrodip
