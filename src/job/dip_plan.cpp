#include "job/dip_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>

#include "base/error.h"
#include "dip/tear_doubt.h"
#include "job/dips_side_by_side.h"
#include "job/ways.h"
#include "plan/choice.h"
#include "plan/fit.h"
#include "plan/search.h"
#include "settings/correction_file.h"

namespace hydrodip {
namespace {

constexpr int kDirections = 74;
constexpr int kFirstElements = 5000;
// What trial dips promise finer film need not keep: so many times as many dips as are wanted are
// looked at again on the job's film, in longer steps.
constexpr int kLookedAtAgain = 3;
// Nodes of the divided surface lie so close, in parts of the overlap, as far as so many allow.
constexpr double kNodesInOverlap = 3.5;
constexpr double kLeastSpacing_mm = 0.3;
constexpr int kFewestNodes = 8000, kMostNodes = 60000;

PoseOptions pose_of(const DipEntry& entry, const PoseOptions& base) {
  PoseOptions pose = base;
  if (entry.down) pose.down = *entry.down;
  if (entry.rotate_deg) pose.rotate_deg = *entry.rotate_deg;
  return pose;
}

bool is_given(const DipEntry& entry, bool again) {
  if (entry.find_rotation && !entry.locked) return false;
  return again ? entry.locked
               : entry.rotate_deg.has_value() || entry.down.has_value() || !entry.path.empty();
}

[[noreturn]] void refuse_dip(std::size_t number, const Trial* trial, bool inside_out) {
  if (trial && inside_out)
    throw InputError(fmt::format("dip {} reaches nothing at any depth: {}; {}", number,
                                 kLooksInwards, kTurnNormals));
  throw InputError(
      fmt::format("dip {} {}: turn it with rotate_deg, or leave that out and let it be found",
                  number, trial ? "reaches nothing at any depth" : "does not fit film and bath"));
}

[[noreturn]] void refuse_correction(std::size_t number) {
  throw InputError(
      fmt::format("dip {}: its correction is of one pose: give that with rotate_deg, and where the "
                  "job is planned again say locked = true",
                  number));
}

class Planning {
 public:
  Planning(const JobConfig& config, const PreparedObject& prepared, const Targets& targets,
           bool again, const RunContext& context)
      : config_(config),
        prepared_(prepared),
        targets_(targets),
        again_(again),
        context_(context),
        wanted_(std::max(config.plan.dips, int(config.dips.size()))),
        task_(to_any_depth(job_trials(config, prepared, targets), wanted_)),
        sought_(as_sought(task_)) {}

  DipPlan run() {
    if (config_.plan.dips > 0 && config_.plan.dips < int(config_.dips.size()))
      throw InputError(
          fmt::format("plan.dips (--dips): the job has {} [[dip]] tables, so it cannot be {}: take "
                      "tables away, "
                      "or ask for as many or more",
                      config_.dips.size(), config_.plan.dips));
    std::vector<Trial> chosen = given();
    if (chosen.empty() && wanted_ == 1)
      chosen = {best_alone()};
    else if (int(chosen.size()) < wanted_)
      chosen = search(std::move(chosen), wanted_);
    if (chosen.empty())
      throw InputError(fmt::format(
          "no way to hold the object was found in which film stays whole on it{}",
          prepared_.health.inside_out
              ? fmt::format(": {}; {}", kLooksInwards, kTurnNormals)
              : ": use film that bears more (material.tear_stretch), or a smaller object"));
    dip_for_good(chosen);
    return std::move(plan_);
  }

 private:
  static TrialTask to_any_depth(TrialTask task, int dips) {
    task.depth_mm = 0;
    if (dips > 1) task.torn_price = kTornPriceAmongSeveral;
    return task;
  }
  static TrialTask as_sought(TrialTask task) {
    task.dip.step_mm = longer_step_mm(task.dip.step_mm);
    return task;
  }

  std::vector<Trial> given() {
    std::vector<Trial> given;
    for (std::size_t i = 0; i < config_.dips.size(); ++i) {
      const DipEntry& entry = config_.dips[i];
      if (!entry.correction.empty() && !is_given(entry, again_)) refuse_correction(i + 1);
      if (!is_given(entry, again_)) {
        if (entry.depth_mm && !again_) hold_best(task_to(entry), given);
        continue;
      }
      if (!entry.correction.empty()) read_correction(entry.correction);
      context_.progress("dipping what is given", double(i) / double(config_.dips.size()));
      const auto trial =
          try_pose(task_to(entry), pose_of(entry, config_.object.pose), 0, context_.quiet());
      if (!trial || !(trial->depth_mm > 0))
        refuse_dip(i + 1, trial ? &*trial : nullptr, prepared_.health.inside_out);
      given.push_back(*trial);
    }
    return given;
  }

  TrialTask task_to(const DipEntry& entry) const {
    TrialTask task = sought_;
    if (entry.depth_mm) task.depth_mm = *entry.depth_mm > 0 ? *entry.depth_mm : kWholeObject_mm;
    if (!entry.path.empty()) task.way = {.path = entry.path, .pivot_mm = task.way.pivot_mm};
    return task;
  }

  // One of which the depth alone is given: held so that it adds most to what is given so far.
  void hold_best(const TrialTask& task, std::vector<Trial>& given) {
    const PoseOptions& pose = config_.object.pose;
    const SearchResult found = search_holds(task, pose, quick_search(), context_);
    plan_.trial_dips += found.trials.size();
    const ChoiceOptions choice{.dips = int(given.size()) + 1, .kept = given, .better = false};
    const auto chosen = choose_dips(trial_task(task), found.trials, choice, context_).dips;
    if (chosen.size() == given.size()) return;
    if (auto sure = try_pose(task, chosen.back().pose, 0, context_.quiet()))
      given.push_back(std::move(*sure));
  }

  // No other brings what it tears: what `orient` recommends.
  Trial best_alone() {
    JobConfig config = config_;
    config.plan.find_depth = config.plan.find_depth || !(config.design.trajectory.depth_mm > 0);
    SearchResult found = find_holds(config, prepared_, targets_, context_);
    plan_.trial_dips += found.trials.size();
    return std::move(found.best.front());
  }

  // On the film of trial dips first; then what is chosen of those is looked at again, until it has
  // been, or enough have.
  std::vector<Trial> search(std::vector<Trial> given, int wanted) {
    TrialTask first = sought_;
    first.film.elements = std::min(first.film.elements, kFirstElements);
    SearchOptions options;
    options.confirm = false;
    options.first_elements = kFirstElements;
    options.directions = kDirections;
    // What is good alone need not be among several: those are bettered when they are chosen.
    options.refined = 0;
    SearchResult found = search_holds(first, config_.object.pose, options, context_);
    ChoiceOptions choice{.dips = wanted, .kept = std::move(given), .better = true};
    ChosenDips chosen = choose_dips(trial_task(sought_), found.trials, choice, context_);
    std::vector<Trial> hoped = std::move(found.trials);
    std::move(chosen.tried.begin(), chosen.tried.end(), std::back_inserter(hoped));
    plan_.trial_dips += hoped.size();

    choice.better = false;
    std::vector<Trial> sure;
    for (int looked_at = 0; looked_at < kLookedAtAgain * wanted;) {
      std::vector<Trial> all = sure;
      all.insert(all.end(), hoped.begin(), hoped.end());
      std::vector<Trial> next;
      for (const Trial& dip : choose_dips(sought_, all, choice, context_).dips) {
        const auto at = std::find_if(hoped.begin(), hoped.end(), [&](const Trial& other) {
          return other.pose.rotate_deg == dip.pose.rotate_deg && other.pose.down == dip.pose.down;
        });
        if (at == hoped.end()) continue;
        next.push_back(std::move(*at));
        hoped.erase(at);
      }
      if (next.empty()) break;
      looked_at += int(next.size());
      for (auto& trial : looked_at_again(next))
        if (trial) sure.push_back(std::move(*trial));
    }
    return choose_dips(sought_, sure, choice, context_).dips;
  }

  // Nothing where one cannot be computed.
  std::vector<std::optional<Trial>> looked_at_again(const std::vector<Trial>& trials) const {
    std::vector<std::optional<Trial>> sure(trials.size());
    each_of(
        trials.size(), "looking at the best again", [&](std::size_t i, const RunContext& context) {
          try {
            sure[i] =
                try_pose(sought_, trials[i].pose, trials[i].depth_mm + kDeeper_mm, context.quiet());
          } catch (const DipError&) {
            // None to recommend.
          }
        });
    return sure;
  }

  // As the job dips them, blank. What they promise counts.
  void dip_for_good(const std::vector<Trial>& chosen) {
    std::vector<std::optional<PlannedDip>> made(chosen.size());
    each_of(chosen.size(), "dipping them for good", [&](std::size_t i, const RunContext& context) {
      made[i] = made_of(chosen[i], context);
    });
    for (auto& dip : made) plan_.dips.push_back(std::move(*dip));
  }

  PlannedDip made_of(const Trial& trial, const RunContext& context) const {
    const PosedObject posed(task_.object, trial.pose);
    TrajectoryOptions way = config_.design.trajectory;
    way.depth_mm = trial.path.empty() ? trial.depth_mm : 0;
    way.path = trial.path;
    const Trajectory trajectory = make_trajectory(way, posed.mesh().positions);
    warn_if_tight(room_of(posed.mesh(), trajectory), config_.design.film, context);
    Timings unheard;
    PlannedDip dip{
        trial,
        dip_object(posed, std::make_shared<const FilmMesh>(make_film_mesh(film_of(config_, trial))),
                   trajectory, config_.design.dip, unheard, context, {},
                   {.options = config_.design.air, .found = {}})};
    dip.trial = judge_dip(task_, trial.pose, dip.blank);
    dip.trial.depth_mm = trial.depth_mm;
    dip.trial.path = trial.path;
    return dip;
  }

  // Side by side as long as their films are small beside the memory.
  void each_of(std::size_t count, const std::string& activity,
               const std::function<void(std::size_t, const RunContext&)>& dip) const {
    if (config_.design.film.elements <= kSmallFilm)
      return dip_side_by_side(count, activity, context_, dip);
    for (std::size_t i = 0; i < count; ++i) {
      context_.progress(activity, double(i) / double(count));
      const RunContext own = context_.quiet();
      dip(i, own);
      for (const std::string& warning : own.warnings())
        context_.warn(fmt::format("dip {}: {}", i + 1, warning));
    }
  }

  const JobConfig& config_;
  const PreparedObject& prepared_;
  const Targets& targets_;
  const bool again_;
  const RunContext& context_;
  const int wanted_;
  const TrialTask task_;    // as the job dips
  const TrialTask sought_;  // as dips are chosen
  DipPlan plan_;
};

}  // namespace

DipPlan plan_dips(const JobConfig& config, const PreparedObject& prepared, const Targets& targets,
                  bool again, const RunContext& context) {
  const RunScope scope(context);
  return Planning(config, prepared, targets, again, context).run();
}

std::optional<PoseOptions> told_pose(const DipEntry& entry, const PoseOptions& base) {
  if (!is_given(entry, false)) return std::nullopt;
  return pose_of(entry, base);
}

std::optional<TrajectoryOptions> told_way(const DipEntry& entry, const TrajectoryOptions& base) {
  if (!entry.path.empty()) return TrajectoryOptions{.path = entry.path, .pivot_mm = base.pivot_mm};
  if (!entry.depth_mm) return std::nullopt;
  TrajectoryOptions way = base;
  way.depth_mm = *entry.depth_mm;
  return way;
}

std::shared_ptr<const SurfaceNodes> make_nodes(const PreparedObject& prepared, double overlap_mm) {
  const double spacing_mm = std::max(kLeastSpacing_mm, overlap_mm / kNodesInOverlap);
  const double wanted = prepared.health.area_mm2 / (spacing_mm * spacing_mm);
  const int count = int(std::clamp(wanted, double(kFewestNodes), double(kMostNodes)));
  return std::make_shared<const SurfaceNodes>(spread_targets(prepared.posed.object(), count));
}

std::filesystem::path correction_of(const JobConfig& config, const Trial& trial) {
  for (const DipEntry& entry : config.dips) {
    const PoseOptions pose = pose_of(entry, config.object.pose);
    if (!entry.correction.empty() && pose.down == trial.pose.down &&
        pose.rotate_deg == trial.pose.rotate_deg)
      return entry.correction;
  }
  return {};
}

FilmOptions film_of(const JobConfig& config, const Trial& trial) {
  FilmOptions film = config.design.film;
  const std::filesystem::path file = correction_of(config, trial);
  if (!file.empty()) film.correction = read_correction_field(file);
  return film;
}

std::optional<std::size_t> dip_held_so(const JobConfig& config, const PoseOptions& pose) {
  const auto same = std::find_if(config.dips.begin(), config.dips.end(), [&](const DipEntry& dip) {
    const PoseOptions own = pose_of(dip, config.object.pose);
    return (dip.rotate_deg || dip.locked) && own.down == pose.down &&
           own.rotate_deg == pose.rotate_deg;
  });
  if (same == config.dips.end()) return std::nullopt;
  return std::size_t(same - config.dips.begin());
}

std::vector<DipEntry> entries_of(const DipPlan& plan, const JobConfig& config) {
  std::vector<DipEntry> entries;
  for (const PlannedDip& planned : plan.dips) {
    const Trial& dip = planned.trial;
    DipEntry entry;
    entry.down = dip.pose.down;
    entry.rotate_deg = dip.pose.rotate_deg;
    if (dip.path.empty()) entry.depth_mm = dip.depth_mm;
    entry.path = dip.path;
    if (const auto same = dip_held_so(config, dip.pose)) {
      const DipEntry& given = config.dips[*same];
      entry.locked = given.locked;
      entry.correction = given.correction;
      // As it was said: "the whole object" is not that many digits.
      if (given.locked && entry.depth_mm && given.depth_mm) entry.depth_mm = given.depth_mm;
    }
    entries.push_back(entry);
  }
  return entries;
}

}  // namespace hydrodip
