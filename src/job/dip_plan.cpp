#include "job/dip_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"

namespace hydrodip {
namespace {

// Ink stiffens film, and what is next to it stretches more: planned dips count film as torn that
// much below what it bears, so that what is counted on stays whole with its ink.
constexpr double kStretchKept = 0.96;
constexpr double kDeeper_mm = 3;
constexpr int kDirections = 98;
// Triangles: from there on film is dipped by all threads, one at a time.
constexpr int kSmallFilm = 100000;

PoseOptions pose_of(const DipEntry& entry, const PoseOptions& base) {
  PoseOptions pose = base;
  if (entry.down) pose.down = *entry.down;
  if (entry.rotate_deg) pose.rotate_deg = *entry.rotate_deg;
  return pose;
}

bool is_given(const DipEntry& entry, bool again) {
  return again ? entry.locked
               : entry.rotate_deg.has_value() || entry.down.has_value() || !entry.path.empty();
}

[[noreturn]] void refuse_dip(std::size_t number, const Trial* trial) {
  throw InputError(
      fmt::format("dip {} {}: turn it with rotate_deg, or leave that out and let it be found",
                  number, trial ? "reaches nothing at any depth" : "does not fit film and bath"));
}

class Planning {
 public:
  Planning(const JobConfig& config, const PreparedObject& prepared, const Targets& targets,
           bool again, const RunContext& context)
      : config_(config),
        again_(again),
        context_(context),
        task_(job_trials(config, prepared, targets)) {
    task_.depth_mm = 0;
    task_.keep_film = true;
    task_.torn_price = kTornPriceAmongSeveral;
    task_.dip.material.tear_stretch *= kStretchKept;
  }

  DipPlan run() {
    find_given();
    const int wanted = std::max(config_.plan.dips, int(config_.dips.size()));
    if (int(given_.size()) < wanted)
      search(wanted);
    else
      plan_.dips = given_;
    if (plan_.dips.empty())
      throw InputError(
          "no way to hold the object was found in which film stays whole on it: use film that "
          "bears more (material.tear_stretch), or a smaller object");
    count_up();
    return std::move(plan_);
  }

 private:
  void find_given() {
    for (std::size_t i = 0; i < config_.dips.size(); ++i) {
      const DipEntry& entry = config_.dips[i];
      if (!is_given(entry, again_)) {
        if (entry.depth_mm && !again_) hold_best(task_to(entry));
        continue;
      }
      context_.progress("dipping what is given", double(i) / double(config_.dips.size()));
      const TrialTask task = task_to(entry);
      const auto trial = fine(task, pose_of(entry, config_.object.pose), 0);
      if (!trial || !(trial->depth_mm > 0)) refuse_dip(i + 1, trial ? &*trial : nullptr);
      given_.push_back(*trial);
    }
  }

  TrialTask task_to(const DipEntry& entry) const {
    TrialTask task = task_;
    if (entry.depth_mm) task.depth_mm = *entry.depth_mm > 0 ? *entry.depth_mm : kWholeObject_mm;
    if (!entry.path.empty()) task.way = {.path = entry.path, .pivot_mm = task.way.pivot_mm};
    return task;
  }

  // One of which the depth alone is given: held so that it adds most to what is given so far.
  void hold_best(const TrialTask& task) {
    const PoseOptions& pose = config_.object.pose;
    const SearchResult found = search_holds(task, pose, quick_search(), context_);
    plan_.trial_dips += found.trials.size();
    const ChoiceOptions choice{.dips = int(given_.size()) + 1, .kept = given_, .better = false};
    const std::vector<Trial> chosen = choose_dips(trial_task(task), found.trials, choice, context_);
    if (chosen.size() == given_.size()) return;
    if (auto sure = fine(task, chosen.back().pose, 0)) given_.push_back(std::move(*sure));
  }

  std::optional<Trial> fine(const TrialTask& task, const PoseOptions& pose, double depth_most_mm) {
    RunContext quiet = context_.quiet();
    return try_pose(task, pose, depth_most_mm, quiet);
  }

  void search(int wanted) {
    SearchOptions options;
    options.confirm = false;
    options.first_elements = kDraftElements;
    options.directions = kDirections;
    // What is good alone need not be among several: those are bettered when they are chosen.
    options.refined = 0;
    const SearchResult found = search_holds(task_, config_.object.pose, options, context_);
    plan_.trial_dips += found.trials.size();
    const TrialTask coarse = trial_task(task_);
    ChoiceOptions choice;
    choice.dips = wanted;
    choice.kept = given_;
    choice.kept = choose_dips(coarse, found.trials, choice, context_);
    // What trial dips promise the job's own need not keep: as many again are there to choose from.
    choice.dips = 2 * wanted;
    choice.better = false;
    std::vector<Trial> sure;
    for (auto& dip : dipped_for_good(choose_dips(coarse, found.trials, choice, context_)))
      if (dip) sure.push_back(std::move(*dip));
    const ChoiceOptions last{.dips = wanted, .kept = given_, .better = false};
    plan_.dips = choose_dips(task_, sure, last, context_);
  }

  // Those that are not given; nothing where one cannot be computed. Side by side as long as their
  // films are small beside the memory.
  std::vector<std::optional<Trial>> dipped_for_good(const std::vector<Trial>& chosen) const {
    std::vector<std::optional<Trial>> sure(chosen.size());
    const bool side_by_side = task_.film.elements <= kSmallFilm;
    const auto dip_one = [&](std::size_t i, const RunContext& context) {
      try {
        sure[i] = try_pose(task_, chosen[i].pose, chosen[i].depth_mm + kDeeper_mm, context);
      } catch (const DipError&) {
        // None to recommend.
      }
    };
    context_.progress("dipping them for good", 0);
    if (side_by_side)
      parallel_for(chosen.size() - given_.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
          dip_one(given_.size() + n, context_.quiet().with_threads(1));
      });
    for (std::size_t i = given_.size(); i < chosen.size() && !side_by_side; ++i) {
      context_.progress("dipping them for good", double(i) / double(chosen.size()));
      dip_one(i, context_.quiet());
    }
    context_.progress("dipping them for good", 1);
    return sure;
  }

  void count_up() {
    std::vector<const Trial*> so_far;
    for (const Trial& dip : plan_.dips) {
      so_far.push_back(&dip);
      plan_.covered_after.push_back(covered_share_of(task_.targets, so_far));
    }
  }

  const JobConfig& config_;
  const bool again_;
  const RunContext& context_;
  TrialTask task_;
  std::vector<Trial> given_;
  DipPlan plan_;
};

}  // namespace

DipPlan plan_dips(const JobConfig& config, const PreparedObject& prepared, const Targets& targets,
                  bool again, const RunContext& context) {
  const RunScope scope(context);
  return Planning(config, prepared, targets, again, context).run();
}

std::vector<DipEntry> entries_of(const DipPlan& plan, const std::vector<DipEntry>& earlier) {
  std::vector<DipEntry> entries;
  for (const Trial& dip : plan.dips) {
    DipEntry entry;
    entry.down = dip.pose.down;
    entry.rotate_deg = dip.pose.rotate_deg;
    if (dip.path.empty()) entry.depth_mm = dip.depth_mm;
    entry.path = dip.path;
    entry.locked = std::any_of(earlier.begin(), earlier.end(), [&](const DipEntry& other) {
      return other.locked && other.rotate_deg && *other.rotate_deg == *entry.rotate_deg;
    });
    entries.push_back(entry);
  }
  return entries;
}

}  // namespace hydrodip
