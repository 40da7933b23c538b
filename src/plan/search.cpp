#include "plan/search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/run_scope.h"
#include "coat/design.h"

namespace hydrodip {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Trial dips go by less fine steps still, in film that is as fine as a draft's.
constexpr double kTrialStep_mm = 1;

// The best are bettered by trying poses at these angles around them.
constexpr double kRings_deg[] = {14, 7, 4};
constexpr int kAround = 6;
constexpr double kTurn_deg = 30;
// One that is confirmed may go deeper than its trial by that much.
constexpr double kDeeper_mm = 3;

bool is_better(const Trial& a, const Trial& b) { return a.figures.score > b.figures.score; }

class Search {
 public:
  Search(const TrialTask& task, const PoseOptions& pose, const SearchOptions& options,
         const RunContext& context, const std::function<void(const Trial&)>& watch)
      : fine_(task),
        coarse_(trial_task(task)),
        pose_(pose),
        options_(options),
        context_(context),
        watch_(watch) {}

  SearchResult run() {
    look_around();
    std::vector<Trial> found = best_of(result_.trials, options_.refined);
    if (found.empty())
      throw InputError(
          "the object fits film and bath in none of the poses that were tried: shrink it with "
          "--size, take a larger --film, or give the size of your bath with --set "
          "bath.width_mm=..., bath.height_mm, bath.depth_mm");
    for (const double ring_deg : kRings_deg) better(found, ring_deg);
    std::stable_sort(found.begin(), found.end(), is_better);
    found = best_of(found, options_.best);
    for (const Trial& trial : found) result_.drafted.push_back(trial.figures.score);
    if (options_.confirm) confirm(found);
    result_.best = std::move(found);
    return std::move(result_);
  }

 private:
  void look_around() {
    std::vector<PoseOptions> poses;
    for (const Vec3& down : spread_directions(options_.directions)) poses.push_back(roomiest(down));
    // The first round brings an answer early.
    const std::size_t first = std::min<std::size_t>(poses.size(), 14);
    try_all({poses.begin(), poses.begin() + std::ptrdiff_t(first)}, "trying ways to hold it");
    try_all({poses.begin() + std::ptrdiff_t(first), poses.end()}, "trying more ways to hold it");
  }

  PoseOptions roomiest(const Vec3& down) const {
    PoseOptions pose = hold(pose_, down, 0);
    return hold(pose_, down, roomiest_turn_deg(coarse_.object->positions, pose, coarse_.film));
  }

  std::vector<std::optional<Trial>> try_all(const std::vector<PoseOptions>& poses,
                                            const std::string& stage) {
    std::vector<std::optional<Trial>> tried;
    constexpr std::size_t kRound = 16;
    for (std::size_t first = 0; first < poses.size(); first += kRound) {
      context_.progress(stage, double(first) / double(poses.size()));
      const std::size_t last = std::min(first + kRound, poses.size());
      for (auto& trial :
           try_poses(coarse_,
                     {poses.begin() + std::ptrdiff_t(first), poses.begin() + std::ptrdiff_t(last)},
                     context_)) {
        if (trial) result_.trials.push_back(*trial);
        tried.push_back(std::move(trial));
      }
      tell();
    }
    context_.progress(stage, 1);
    return tried;
  }

  void tell() const {
    if (!watch_ || result_.trials.empty()) return;
    watch_(*std::min_element(result_.trials.begin(), result_.trials.end(), is_better));
  }

  // The best ones that are far enough from each other, the best first.
  std::vector<Trial> best_of(std::vector<Trial> trials, int count) const {
    std::stable_sort(trials.begin(), trials.end(), is_better);
    std::vector<Trial> best;
    for (const Trial& trial : trials) {
      if (int(best.size()) >= count) break;
      const bool is_apart = std::all_of(best.begin(), best.end(), [&](const Trial& other) {
        return angle_between_deg(trial.pose, other.pose) >= options_.apart_deg;
      });
      if (is_apart) best.push_back(trial);
    }
    return best;
  }

  // Tries what lies around each of them.
  void better(std::vector<Trial>& found, double ring_deg) {
    std::vector<PoseOptions> poses;
    std::vector<std::size_t> of;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const PoseOptions& pose = found[i].pose;
      const Vec3 down = down_of(pose);
      for (const Vec3& near : directions_around(down, ring_deg, kAround)) {
        poses.push_back(hold(pose_, near, pose.rotate_deg.z()));
        of.push_back(i);
      }
      for (const double turn : {-kTurn_deg, kTurn_deg}) {
        poses.push_back(hold(pose_, down, pose.rotate_deg.z() + turn * ring_deg / kRings_deg[0]));
        of.push_back(i);
      }
    }
    const auto tried = try_all(poses, "trying poses like the best");
    for (std::size_t n = 0; n < tried.size(); ++n)
      if (tried[n] && is_better(*tried[n], found[of[n]])) found[of[n]] = *tried[n];
  }

  void confirm(std::vector<Trial>& found) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      context_.progress("dipping the best for good", double(i) / double(found.size()));
      RunContext quiet = context_.quiet();
      if (auto sure = try_pose(fine_, found[i].pose, found[i].depth_mm + kDeeper_mm, quiet))
        found[i] = std::move(*sure);
    }
    context_.progress("dipping the best for good", 1);
    std::vector<std::size_t> order(found.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return is_better(found[a], found[b]); });
    std::vector<Trial> sorted;
    std::vector<double> drafted;
    for (const std::size_t i : order) {
      sorted.push_back(std::move(found[i]));
      drafted.push_back(result_.drafted[i]);
    }
    found = std::move(sorted);
    result_.drafted = std::move(drafted);
  }

  const TrialTask fine_, coarse_;
  const PoseOptions pose_;
  const SearchOptions options_;
  const RunContext& context_;
  const std::function<void(const Trial&)>& watch_;
  SearchResult result_;
};

}  // namespace

SearchOptions quick_search() {
  return {.best = 1, .directions = 26, .refined = 2, .apart_deg = 30, .confirm = false};
}

TrialTask trial_task(TrialTask task) {
  task.object = simplified_for_trials(task.object);
  task.film.elements = std::min(task.film.elements, kDraftElements);
  task.dip.step_mm = std::max(task.dip.step_mm, kTrialStep_mm);
  return task;
}

std::vector<std::optional<Trial>> try_poses(const TrialTask& task,
                                            const std::vector<PoseOptions>& poses,
                                            const RunContext& context) {
  const RunScope scope(context);
  std::vector<std::optional<Trial>> tried(poses.size());
  parallel_for(poses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      RunContext alone = context.quiet().with_threads(1);
      try {
        tried[i] = try_pose(task, poses[i], 0, alone);
      } catch (const DipError&) {
        // One that cannot be computed is none to recommend.
      }
    }
  });
  return tried;
}

SearchResult search_holds(const TrialTask& task, const PoseOptions& pose,
                          const SearchOptions& options, const RunContext& context,
                          const std::function<void(const Trial&)>& watch) {
  const RunScope scope(context);
  return Search(task, pose, options, context, watch).run();
}

double angle_between_deg(const PoseOptions& a, const PoseOptions& b) {
  return std::acos(std::clamp(down_of(a).dot(down_of(b)), -1.0, 1.0)) / kDegree;
}

}  // namespace hydrodip
