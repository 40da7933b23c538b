#include "plan/choice.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "base/parallel.h"
#include "base/run_scope.h"

namespace hydrodip {
namespace {

constexpr double kLeastGain = 1e-4;  // of the weight
constexpr int kMostExchanges = 40;
// Poses so far from the chosen ones are tried, all around, and not again near one that was.
constexpr double kRings_deg[] = {16, 12, 8, 5};
constexpr int kAround = 6;
constexpr double kNew = 0.6;  // of the ring's angle from all others

// That a place is covered at all counts for so much, and how well for the rest.
constexpr double kCovered = 0.75;

double value_of(float worth) { return worth > 0 ? kCovered + (1 - kCovered) * double(worth) : 0; }

// The best worth at each target so far, and the weights.
class Reached {
 public:
  explicit Reached(const Targets& targets) : targets_(targets), worth_(targets.list.size(), 0.0F) {}

  void add(const Trial& trial) {
    for (std::size_t i = 0; i < worth_.size(); ++i) worth_[i] = std::max(worth_[i], trial.worth[i]);
  }

  double gain_with(const Trial* trial) const {
    double sum = 0;
    for (std::size_t i = 0; i < worth_.size(); ++i) {
      const float worth = trial ? std::max(worth_[i], trial->worth[i]) : worth_[i];
      sum += targets_.list[i].area * targets_.list[i].importance * value_of(worth);
    }
    return Coverage::share(sum, targets_.weight);
  }

 private:
  const Targets& targets_;
  std::vector<float> worth_;
};

class Choosing {
 public:
  Choosing(const TrialTask& task, const std::vector<Trial>& trials, const ChoiceOptions& options,
           const RunContext& context)
      : task_(task), trials_(trials), options_(options), context_(context) {}

  std::vector<Trial> run() {
    chosen_ = options_.kept;
    while (int(chosen_.size()) < options_.dips)
      if (!add_best()) break;
    exchange();
    if (options_.better) better();
    put_in_order();
    return std::move(chosen_);
  }

 private:
  Reached all_but(std::size_t left_out) const {
    Reached reached(task_.targets);
    for (std::size_t i = 0; i < chosen_.size(); ++i)
      if (i != left_out) reached.add(chosen_[i]);
    return reached;
  }
  double gain() const { return all_but(chosen_.size()).gain_with(nullptr); }

  // Which of them adds most, and what all reach with it.
  std::pair<const Trial*, double> best_addition(const Reached& reached,
                                                const std::vector<const Trial*>& from) const {
    std::vector<double> gains(from.size());
    parallel_for(from.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) gains[i] = reached.gain_with(from[i]);
    });
    const Trial* best = nullptr;
    double most = reached.gain_with(nullptr) + kLeastGain;
    for (std::size_t i = 0; i < from.size(); ++i)
      if (gains[i] > most) {
        most = gains[i];
        best = from[i];
      }
    return {best, most};
  }

  std::vector<const Trial*> library() const {
    std::vector<const Trial*> list;
    for (const auto& trials : {std::cref(trials_), std::cref(found_)})
      for (const Trial& trial : trials.get())
        if (trial.depth_mm > 0) list.push_back(&trial);
    return list;
  }

  bool add_best() {
    const auto [best, most] = best_addition(all_but(chosen_.size()), library());
    if (!best) return false;
    chosen_.push_back(*best);
    return true;
  }

  void exchange() {
    const std::vector<const Trial*> list = library();
    double now = gain();
    for (int n = 0; n < kMostExchanges; ++n) {
      std::size_t out = chosen_.size();
      const Trial* in = nullptr;
      double most = now + kLeastGain;
      for (std::size_t i = options_.kept.size(); i < chosen_.size(); ++i) {
        const auto [best, with] = best_addition(all_but(i), list);
        if (!best || with <= most) continue;
        most = with;
        out = i;
        in = best;
      }
      if (!in) return;
      chosen_[out] = *in;
      now = most;
    }
  }

  // What is tried around one of them may do better in another's place.
  void better() {
    for (std::size_t ring = 0; ring < std::size(kRings_deg); ++ring) {
      context_.progress("trying poses like the chosen ones",
                        double(ring) / double(std::size(kRings_deg)));
      for (auto& trial : try_poses(task_, around_chosen(kRings_deg[ring]), context_))
        if (trial) found_.push_back(std::move(*trial));
      exchange();
    }
    context_.progress("trying poses like the chosen ones", 1);
  }

  std::vector<PoseOptions> around_chosen(double ring_deg) const {
    std::vector<PoseOptions> poses;
    for (std::size_t i = options_.kept.size(); i < chosen_.size(); ++i) {
      const PoseOptions& pose = chosen_[i].pose;
      for (const Vec3& near : directions_around(down_of(pose), ring_deg, kAround)) {
        const PoseOptions next = hold(pose, near, pose.rotate_deg.z());
        const auto is_near = [&](const Trial& trial) {
          return angle_between_deg(trial.pose, next) < kNew * ring_deg;
        };
        if (std::none_of(trials_.begin(), trials_.end(), is_near) &&
            std::none_of(found_.begin(), found_.end(), is_near))
          poses.push_back(next);
      }
    }
    return poses;
  }

  // So that the first few dips do as much as they can.
  void put_in_order() {
    std::vector<Trial> ordered = options_.kept;
    std::vector<Trial> left(chosen_.begin() + std::ptrdiff_t(options_.kept.size()), chosen_.end());
    Reached reached(task_.targets);
    for (const Trial& trial : ordered) reached.add(trial);
    while (!left.empty()) {
      std::size_t best = 0;
      double most = -1;
      for (std::size_t i = 0; i < left.size(); ++i) {
        const double with = reached.gain_with(&left[i]);
        if (with <= most + 1e-12) continue;
        most = with;
        best = i;
      }
      reached.add(left[best]);
      ordered.push_back(left[best]);
      left.erase(left.begin() + std::ptrdiff_t(best));
    }
    chosen_ = std::move(ordered);
  }

  const TrialTask& task_;
  const std::vector<Trial>& trials_;
  std::vector<Trial> found_;  // poses like the chosen ones
  const ChoiceOptions& options_;
  const RunContext& context_;
  std::vector<Trial> chosen_;
};

}  // namespace

double covered_share_of(const Targets& targets, const std::vector<const Trial*>& dips) {
  double covered = 0;
  for (std::size_t i = 0; i < targets.list.size(); ++i)
    if (std::any_of(dips.begin(), dips.end(), [&](const Trial* t) { return t->worth[i] > 0; }))
      covered += targets.list[i].area;
  return Coverage::share(covered, targets.area);
}

std::vector<Trial> choose_dips(const TrialTask& task, const std::vector<Trial>& trials,
                               const ChoiceOptions& options, const RunContext& context) {
  const RunScope scope(context);
  return Choosing(task, trials, options, context).run();
}

}  // namespace hydrodip
