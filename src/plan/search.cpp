#include "plan/search.h"
#include "plan/hold.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/run_scope.h"
#include "coat/design.h"

namespace hydrodip {
namespace {

// Trial dips go by less fine steps still, in film that is as fine as a draft's.
constexpr double kTrialStep_mm = 1;

// The best are bettered by trying poses at these angles around them; the last only around the very
// best.
constexpr double kRings_deg[] = {14, 7, 4};
constexpr int kAround = 6;
constexpr double kTurn_deg = 30;
// Hollows are looked for in so many cells.
constexpr int kTrialAirCells = 20000;
// What reaches less than that part of the best is none to choose from, and none to better.
constexpr double kWorthShowing = 0.25, kWorthBettering = 0.45;

bool is_better(const Trial& a, const Trial& b) { return a.figures.score > b.figures.score; }

class Search {
 public:
  Search(const TrialTask& task, const PoseOptions& pose, const SearchOptions& options,
         const RunContext& context, const std::function<void(const Trial&)>& watch)
      : fine_(task),
        coarse_(trial_task(task)),
        rough_(coarse_),
        pose_(pose),
        options_(options),
        context_(context),
        watch_(watch) {
    rough_.film.elements = std::min(coarse_.film.elements, options.first_elements);
    // Where only what to look at again is chosen, nobody asks what is promised.
    rough_.asks_what_moves = rough_.film.elements == coarse_.film.elements;
  }

  SearchResult run() {
    look_around();
    std::vector<Trial> found =
        best_of(result_.trials, options_.refined > 0 ? options_.refined : options_.best);
    if (found.empty())
      throw InputError(
          "the object fits film and bath in none of the poses that were tried: shrink it with "
          "--size, take a larger --film, or give the size of your bath with --set "
          "bath.width_mm=..., bath.height_mm, bath.depth_mm");
    // By what film covers, before it is asked what moves: that jumps from pose to pose.
    leave_out_poor(found, kWorthBettering);
    if (rough_.film.elements < coarse_.film.elements) dip_again(found);
    if (options_.refined > 0) {
      for (const double ring_deg : kRings_deg) {
        better(found, ring_deg == kRings_deg[std::size(kRings_deg) - 1] ? 1 : found.size(),
               ring_deg);
        // Those that fall behind are not followed any further.
        found = best_of(found, std::max(options_.best, int(found.size()) - 1));
      }
    }
    found = best_of(found, options_.best);
    leave_out_poor(found, kWorthShowing);
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
    try_all(rough_, {poses.begin(), poses.begin() + std::ptrdiff_t(first)},
            "trying ways to hold it");
    try_all(rough_, {poses.begin() + std::ptrdiff_t(first), poses.end()},
            "trying more ways to hold it");
  }

  PoseOptions roomiest(const Vec3& down) const {
    PoseOptions pose = hold(pose_, down, 0);
    return hold(pose_, down, roomiest_turn_deg(coarse_.object->positions, pose, coarse_.film));
  }

  std::vector<std::optional<Trial>> try_all(const TrialTask& task,
                                            const std::vector<PoseOptions>& poses,
                                            const std::string& stage,
                                            const std::vector<double>& worth_asking = {}) {
    std::vector<std::optional<Trial>> tried;
    constexpr std::size_t kRound = 16;
    for (std::size_t first = 0; first < poses.size(); first += kRound) {
      context_.progress(stage, double(first) / double(poses.size()));
      const std::size_t last = std::min(first + kRound, poses.size());
      const auto from = std::ptrdiff_t(first), to = std::ptrdiff_t(last);
      std::vector<double> least;
      if (!worth_asking.empty())
        least.assign(worth_asking.begin() + from, worth_asking.begin() + to);
      for (auto& trial :
           try_poses(task, {poses.begin() + from, poses.begin() + to}, context_, least)) {
        if (trial) result_.trials.push_back(*trial);
        tried.push_back(std::move(trial));
      }
      tell();
    }
    context_.progress(stage, 1);
    return tried;
  }

  void tell() const {
    if (!watch_ || result_.trials.size() == outdone_) return;
    watch_(*std::min_element(result_.trials.begin() + std::ptrdiff_t(outdone_),
                             result_.trials.end(), is_better));
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

  static void leave_out_poor(std::vector<Trial>& found, double share) {
    if (found.empty()) return;
    const double best = std::min_element(found.begin(), found.end(), is_better)->figures.score;
    if (!(best > 0)) return;
    const double least = share * best;
    std::erase_if(found, [&](const Trial& trial) { return trial.figures.score < least; });
  }

  // Those that were looked at on rougher film, on that of the others.
  void dip_again(std::vector<Trial>& found) {
    std::vector<PoseOptions> poses;
    poses.reserve(found.size());
    for (const Trial& trial : found) poses.push_back(trial.pose);
    found.clear();
    outdone_ = result_.trials.size();
    for (auto& trial : try_all(coarse_, poses, "trying the best again"))
      if (trial) found.push_back(std::move(*trial));
  }

  // Tries what lies around each of the first so many. What is no better even before it is asked
  // what moves is not asked.
  void better(std::vector<Trial>& found, std::size_t first, double ring_deg) {
    std::vector<PoseOptions> poses;
    std::vector<std::size_t> of;
    std::vector<double> to_beat;
    for (std::size_t i = 0; i < std::min(first, found.size()); ++i) {
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
    to_beat.reserve(of.size());
    for (const std::size_t i : of) to_beat.push_back(found[i].figures.score);
    const auto tried = try_all(coarse_, poses, "trying poses like the best", to_beat);
    for (std::size_t n = 0; n < tried.size(); ++n)
      if (tried[n] && is_better(*tried[n], found[of[n]])) found[of[n]] = *tried[n];
  }

  // As finely as the job, each of them: trial dips make out neither how much tears nor which is the
  // best.
  void confirm(std::vector<Trial>& found) {
    std::vector<Trial> sure;
    for (std::size_t i = 0; i < found.size(); ++i) {
      context_.progress("dipping the best for good", double(i) / double(found.size()));
      try {
        if (auto again =
                try_pose(fine_, found[i].pose, found[i].depth_mm + kDeeper_mm, context_.quiet()))
          sure.push_back(std::move(*again));
      } catch (const DipError&) {
        // One that cannot be computed so is none to recommend.
      }
    }
    context_.progress("dipping the best for good", 1);
    if (sure.empty())
      throw DipError("none of the best ways to hold it could be computed with the job's film");
    std::stable_sort(sure.begin(), sure.end(), is_better);
    found = std::move(sure);
  }

  const TrialTask fine_, coarse_;
  TrialTask rough_;
  const PoseOptions pose_;
  const SearchOptions options_;
  const RunContext& context_;
  const std::function<void(const Trial&)>& watch_;
  SearchResult result_;
  std::size_t outdone_ = 0;  // so many trials promise more than the later ones
};

}  // namespace

SearchOptions quick_search() {
  return {.best = 1, .directions = 26, .refined = 2, .confirm = false};
}

TrialTask trial_task(TrialTask task) {
  task.object = simplified_for_trials(task.object);
  task.film.elements = std::min(task.film.elements, kDraftElements);
  task.dip.step_mm = std::max(task.dip.step_mm, kTrialStep_mm);
  task.air.cells = std::min(task.air.cells, kTrialAirCells);
  task.keep_film = false;
  return task;
}

std::vector<std::optional<Trial>> try_poses(const TrialTask& task,
                                            const std::vector<PoseOptions>& poses,
                                            const RunContext& context,
                                            const std::vector<double>& worth_asking) {
  const RunScope scope(context);
  std::vector<std::optional<Trial>> tried(poses.size());
  parallel_for(poses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      RunContext alone = context.quiet().with_threads(1);
      TrialTask own = task;
      if (!worth_asking.empty()) own.worth_asking = worth_asking[i];
      try {
        tried[i] = try_pose(own, poses[i], 0, alone);
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
