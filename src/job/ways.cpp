#include "job/ways.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "base/error.h"
#include "image/files.h"
#include "job/wanted.h"
#include "plan/hold.h"
#include "report/shares.h"

namespace hydrodip {
namespace {

// A better way has to be that much better to be worth a word.
constexpr double kWorthSaying = 0.02;
// Shorter than that is nothing torn, for people.
constexpr double kHardlyTorn = 0.0005;
constexpr double kSomeAir_mm2 = 1;

std::shared_ptr<const Paint> importance_paint(const std::filesystem::path& file,
                                              const Object& model) {
  if (model.uvs.empty())
    throw InputError(fmt::format(
        "{}: plan.importance is laid on by the model's texture coordinates, and it has none",
        file.string()));
  auto object = std::make_shared<Object>(model);
  object->textures = {std::make_shared<const Image>(load_image(file))};
  object->colors.clear();
  object->materials.assign(1, Material{.name = "importance", .texture = 0});
  object->material_of.assign(object->triangles.size(), 0);
  return model_paint(object);
}

// Of what shall be printed; nothing where that is everywhere, or unknown.
std::optional<double> wanted_share(const Trial& trial, const Targets& targets,
                                   const std::vector<std::uint8_t>& is_wanted) {
  if (is_wanted.size() != targets.list.size() || trial.worth.size() != is_wanted.size())
    return std::nullopt;
  double wanted = 0, covered = 0;
  for (std::size_t i = 0; i < is_wanted.size(); ++i) {
    if (!is_wanted[i]) continue;
    wanted += targets.list[i].area;
    covered += trial.worth[i] > 0 ? targets.list[i].area : 0;
  }
  return Coverage::share(covered, wanted);
}

// "about 97 % of what shall be printed covered (now 86 %), about 1.5 % torn (now 23 %)": the
// measures of the verdict, which is of the job's own film with its ink, and not of a trial's.
std::string compared(const TrialFigures& trial, std::optional<double> trial_wanted,
                     const Coverage& now, const std::optional<ReportWanted>& now_wanted) {
  const bool by_wanted = trial_wanted && now_wanted;
  return fmt::format("about {} of {} covered (now {}), about {} of the film torn (now {})",
                     percent(by_wanted ? *trial_wanted : trial.covered_share),
                     by_wanted ? "what shall be printed" : "the surface",
                     percent(by_wanted ? now_wanted->covered_share() : now.covered_share()),
                     trial.torn_share > kHardlyTorn ? percent(trial.torn_share) : "0 %",
                     now.torn_share() > kHardlyTorn ? percent(now.torn_share()) : "0 %");
}

std::string told_air(const TrialFigures& figures) {
  if (figures.air_mm2 < kSomeAir_mm2) return "";
  return fmt::format(", {:.0f} mm2 under trapped air", figures.air_mm2);
}

bool lays_film(const Trial& trial) { return trial.depth_mm > 0 && trial.figures.covered_share > 0; }

// Blank film may promise more than what was printed on it keeps, however it is held.
bool is_held_so(const Trial& trial, const Trial& made) {
  constexpr double kSame_mm = 0.5;
  return trial.pose.down == made.pose.down &&
         trial.pose.rotate_deg.isApprox(made.pose.rotate_deg) &&
         std::abs(trial.depth_mm - made.depth_mm) < kSame_mm;
}

}  // namespace

Targets job_targets(const JobConfig& config, const PreparedObject& prepared,
                    const RunContext& context) {
  const RunScope scope(context);
  const Object& object = prepared.posed.object();
  Targets targets = spread_targets(object);
  if (!(targets.area > 0))
    throw InputError(fmt::format("{}: the model has no surface to dip", config.model.string()));
  if (config.plan.importance.empty())
    weigh_by_paint(targets, *prepared.paint);
  else
    weigh_by_picture(targets, *importance_paint(config.plan.importance, object));
  return targets;
}

TrialTask job_trials(const JobConfig& config, const PreparedObject& prepared,
                     const Targets& targets) {
  TrialTask task{prepared.posed.shared_object(), targets, config.design.film, config.design.dip,
                 config.bath};
  task.way = config.design.trajectory;
  task.way.depth_mm = 0;
  task.air.cells = std::min(config.design.air.cells, kDraftAirCells);
  if (!config.plan.find_depth)
    task.depth_mm =
        config.design.trajectory.depth_mm > 0 ? config.design.trajectory.depth_mm : kWholeObject_mm;
  return task;
}

SearchResult find_holds(const JobConfig& config, const PreparedObject& prepared,
                        const Targets& targets, const RunContext& context) {
  TrialTask task = job_trials(config, prepared, targets);
  task.keep_film = true;
  std::string best_yet;
  SearchResult found = search_holds(task, config.object.pose, {}, context, [&](const Trial& best) {
    if (!lays_film(best)) return;
    const std::string words = describe_trial(best, way_up(config));
    if (words != best_yet) context.progress("best so far: " + words, 0);
    best_yet = words;
  });
  std::erase_if(found.best, [](const Trial& trial) { return !lays_film(trial); });
  if (found.best.empty())
    throw InputError(fmt::format(
        "{}: no way to hold it was found in which whole film comes to lie on it{}",
        config.model.string(),
        prepared.health.inside_out
            ? fmt::format(": {}; {}", kLooksInwards, kTurnNormals)
            : "; use a smaller object, or film that bears more (material.tear_stretch)"));
  return found;
}

ModelSide way_up(const JobConfig& config) {
  for (const ModelSide side : {ModelSide::kMinusX, ModelSide::kPlusX, ModelSide::kMinusY,
                               ModelSide::kPlusY, ModelSide::kMinusZ, ModelSide::kPlusZ})
    if (config.up == side_name(side)) return side;
  std::string extension = config.model.extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  // What the exporters of modelling programs do; glTF's y is turned up on loading.
  return extension == ".obj" ? ModelSide::kPlusY : ModelSide::kPlusZ;
}

void find_what_is_asked(JobConfig& config, PreparedObject& prepared, const RunContext& context) {
  if (!config.plan.find_pose && !config.plan.find_depth) return;
  if (config.plan.find_depth && !config.design.trajectory.path.empty())
    throw InputError("a path says how deep it goes: leave out --depth auto");
  const RunScope scope(context);
  const Targets targets = job_targets(config, prepared, context);
  const TrialTask task = job_trials(config, prepared, targets);
  std::optional<Trial> found;
  if (config.plan.find_pose) {
    found = find_holds(config, prepared, targets, context).best.front();
  } else {
    context.progress("looking for the depth", 0);
    RunContext quiet = context.quiet();
    found = try_pose(task, config.object.pose, 0, quiet);
    context.progress("looking for the depth", 1);
  }
  if (!found || !(found->depth_mm > 0))
    throw InputError(fmt::format(
        "{}: no depth was found at which film lies on the object held like this; turn it with "
        "--rotate, or let --rotate auto find out how",
        config.model.string()));
  context.log("found: " + describe_trial(*found, way_up(config)));
  hold(config.object, prepared, found->pose);
  if (config.plan.find_depth) config.design.trajectory.depth_mm = found->depth_mm;
  config.plan.found_pose = config.plan.find_pose;
  config.plan.found_depth = config.plan.find_depth;
  config.plan.find_pose = config.plan.find_depth = false;
  prepared.posed = PosedObject(prepared.posed.shared_object(), config.object.pose);
}

bool is_best_found(const JobConfig& config) {
  return config.plan.found_pose &&
         (config.plan.found_depth || !config.design.trajectory.path.empty());
}

std::string describe_trial(const Trial& trial, ModelSide up) {
  const TrialFigures& figures = trial.figures;
  const std::string text =
      fmt::format("{}, {:.4g} mm deep: {} of the surface covered, {}",
                  describe_hold(trial.pose, up), trial.depth_mm, percent(figures.covered_share),
                  figures.torn_share > kHardlyTorn ? percent(figures.torn_share) + " torn"
                                                   : std::string("nothing torn"));
  return text + told_air(figures);
}

std::string trial_options(const Trial& trial) {
  if (!trial.path.empty()) return hold_options(trial.pose);
  return fmt::format("{} --depth {:.6g}", hold_options(trial.pose), trial.depth_mm);
}

namespace {

std::string figures_of(const Vec3& place) {
  return fmt::format("{:.4g},{:.4g},{:.4g}", place.x(), place.y(), place.z());
}

}  // namespace

std::string artwork_options(const JobConfig& config, const PreparedObject& prepared,
                            const RunContext& context) {
  std::string options;
  for (std::size_t n = 0; n < prepared.artwork.size(); ++n) {
    const ArtworkLayer& given = config.object.artwork[n];
    const ArtworkLayer& laid = prepared.artwork[n].layer;
    const bool toward = !given.toward && laid.toward, at = !given.at_mm && laid.at_mm;
    if (!toward && !at) continue;
    const std::string figures = figures_of(toward ? *laid.toward : *laid.at_mm);
    if (n + 1 == prepared.artwork.size())
      options = fmt::format(" {} {}", toward ? "--art-toward" : "--art-at", figures);
    else
      context.warn(fmt::format(
          "{}: it goes to another side when the object is held otherwise; it stays where it is "
          "with {} = [{}] in its [[artwork]] table",
          prepared.artwork[n].name, toward ? "toward" : "at_mm", figures));
  }
  return options;
}

std::string told_places(const std::vector<LaidLayer>& layers) {
  std::string text;
  for (std::size_t n = 0; n < layers.size(); ++n) {
    if (!layers[n].has_chosen_place) continue;
    const ArtworkLayer& laid = layers[n].layer;
    const bool by_option = n + 1 == layers.size();
    const std::string toward = by_option ? "--art-toward" : "toward",
                      at = by_option ? "--art-at" : "at_mm",
                      where = by_option ? "" : " in its [[artwork]] table";
    text += laid.toward ? fmt::format(
                              "{}: no place is said, so it lies on the side that enters the water "
                              "first ({} {}); that or {}{} lays it elsewhere\n",
                              layers[n].name, toward, figures_of(*laid.toward), at, where)
                        : fmt::format(
                              "{}: no place is said, so it lies around {} ({}); that{} lays it "
                              "elsewhere\n",
                              layers[n].name, figures_of(*laid.at_mm), at, where);
  }
  return text;
}

std::string better_way(const JobConfig& config, const PreparedObject& prepared,
                       const DippedObject& dipped, const std::optional<ReportWanted>& wanted,
                       const RunContext& context) {
  // A short search finds nothing better than the long one did, and turning mends no normals.
  if (is_best_found(config) ||
      (prepared.health.inside_out && !(dipped.coverage.film_on_object_mm2 > 0)))
    return "";
  const Targets targets = job_targets(config, prepared, context);
  TrialTask task = job_trials(config, prepared, targets);
  task.depth_mm = 0;
  const Trial made = judge_dip(task, config.object.pose, dipped);
  try {
    const Trial best = search_holds(task, config.object.pose, quick_search(), context).best.front();
    if (!lays_film(best) || best.figures.score < made.figures.score + kWorthSaying) return "";
    if (is_held_so(best, made)) return "";
    const std::optional<double> share =
        wanted_share(best, targets, wanted_at(targets, *prepared.paint));
    return fmt::format(
        "{}, {:.4g} mm deep: {}{}, as blank film ({}{})", describe_hold(best.pose, way_up(config)),
        best.depth_mm, compared(best.figures, share, dipped.coverage, wanted),
        told_air(best.figures), trial_options(best), artwork_options(config, prepared, context));
  } catch (const InputError&) {
    return "";  // it fits in no other way
  }
}

}  // namespace hydrodip
