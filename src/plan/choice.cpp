#include "plan/choice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <random>

#include "base/parallel.h"
#include "base/run_scope.h"
#include "plan/hold.h"
#include "plan/search.h"

namespace hydrodip {
namespace {

// What is reached is counted in whole parts of the weight, so that sums are exact in any order.
constexpr double kParts = 1e8;
constexpr std::int32_t kLeastGain = std::int32_t(1e-4 * kParts);
constexpr int kMostExchanges = 40;
// Exchanging one at a time ends where no single one helps: so it is begun from as many random
// choices as well.
constexpr int kRandomBeginnings = 15;
// Poses so far from the chosen ones are tried, all around, and not again near one that was.
constexpr double kRings_deg[] = {15, 10, 6};
constexpr int kAround = 6;
constexpr double kNew = 0.6;  // of the ring's angle from all others

// That a place is covered at all counts for so much, and how well for the rest.
constexpr double kCovered = 0.85;

using Values = std::vector<std::int32_t>;  // per target

Values values_of(const Targets& targets, const Trial& trial) {
  Values values(targets.list.size(), 0);
  if (!(targets.weight > 0)) return values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double worth = trial.worth[i];
    if (!(worth > 0)) continue;
    const double share = targets.list[i].area * targets.list[i].importance / targets.weight;
    values[i] = std::int32_t(std::lround(kParts * share * (kCovered + (1 - kCovered) * worth)));
  }
  return values;
}

void reach(Values& reached, const Values& more) {
  for (std::size_t i = 0; i < reached.size(); ++i) reached[i] = std::max(reached[i], more[i]);
}

std::int32_t sum_with(const Values& reached, const Values& more) {
  std::int32_t sum = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) sum += std::max(reached[i], more[i]);
  return sum;
}

// Trials by number, and what is chosen of them: numbers too.
class Pool {
 public:
  explicit Pool(const Targets& targets) : targets_(targets) {}

  void add(const Trial& trial) {
    trials_.push_back(trial);
    values_.push_back(values_of(targets_, trial));
  }
  std::size_t size() const { return trials_.size(); }
  const Trial& trial(std::size_t n) const { return trials_[n]; }

  Values reached_by(const std::vector<std::size_t>& chosen, std::size_t left_out) const {
    Values reached(targets_.list.size(), 0);
    for (std::size_t k = 0; k < chosen.size(); ++k)
      if (k != left_out) reach(reached, values_[chosen[k]]);
    return reached;
  }
  std::int32_t gain(const std::vector<std::size_t>& chosen) const {
    const Values none(targets_.list.size(), 0);
    return sum_with(reached_by(chosen, chosen.size()), none);
  }

  struct Addition {
    std::size_t number = 0;
    std::int32_t gain = -1;  // of all with it
  };
  // Which of the numbers adds most; the first of several.
  template <class Numbers>
  Addition best_addition(const Values& reached, const Numbers& numbers) const {
    Addition best;
    for (const std::size_t n : numbers) {
      const std::int32_t with = sum_with(reached, values_[n]);
      if (with > best.gain) best = {n, with};
    }
    return best;
  }

 private:
  const Targets& targets_;
  std::vector<Trial> trials_;
  std::vector<Values> values_;
};

class Choosing {
 public:
  Choosing(const TrialTask& task, const std::vector<Trial>& trials, const ChoiceOptions& options,
           const RunContext& context)
      : task_(task), options_(options), context_(context), pool_(task.targets) {
    for (const Trial& trial : options.kept) pool_.add(trial);
    for (std::size_t n = 0; n < pool_.size(); ++n) kept_.push_back(n);
    for (const Trial& trial : trials) add(trial);
  }

  ChosenDips run() {
    choose();
    if (options_.better) better();
    ChosenDips result;
    for (const std::size_t n : in_order()) result.dips.push_back(pool_.trial(n));
    result.tried = std::move(tried_);
    return result;
  }

 private:
  struct Chosen {
    std::vector<std::size_t> numbers;  // the kept ones first
    std::int32_t gain = -1;
  };

  void add(const Trial& trial) {
    if (!(trial.depth_mm > 0)) return;
    pool_.add(trial);
    free_.push_back(pool_.size() - 1);
  }

  void choose() {
    const std::size_t wanted = std::size_t(std::max(options_.dips, 0));
    std::vector<Chosen> ends(1 + kRandomBeginnings);
    parallel_for(ends.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Chosen& chosen = ends[i];
        chosen.numbers = kept_;
        if (i > 0) add_any(chosen, wanted, std::uint32_t(i));
        add_best(chosen, wanted);
        exchange(chosen);
        leave_out_idle(chosen);
      }
    });
    for (Chosen& end : ends)
      if (end.gain > chosen_.gain) chosen_ = std::move(end);
  }

  void add_any(Chosen& chosen, std::size_t wanted, std::uint32_t beginning) const {
    if (free_.empty()) return;
    std::mt19937 random(beginning);
    while (chosen.numbers.size() < wanted) chosen.numbers.push_back(free_[random() % free_.size()]);
  }

  void add_best(Chosen& chosen, std::size_t wanted) const {
    chosen.gain = pool_.gain(chosen.numbers);
    while (chosen.numbers.size() < wanted) {
      const auto best =
          pool_.best_addition(pool_.reached_by(chosen.numbers, chosen.numbers.size()), free_);
      if (best.gain <= chosen.gain + kLeastGain) return;
      chosen.numbers.push_back(best.number);
      chosen.gain = best.gain;
    }
  }

  // One for another, as long as that helps, and always where it helps most.
  void exchange(Chosen& chosen) const {
    for (int n = 0; n < kMostExchanges; ++n) {
      std::size_t out = chosen.numbers.size();
      Pool::Addition in{0, chosen.gain + kLeastGain};
      for (std::size_t k = kept_.size(); k < chosen.numbers.size(); ++k) {
        const auto best = pool_.best_addition(pool_.reached_by(chosen.numbers, k), free_);
        if (best.gain <= in.gain) continue;
        in = best;
        out = k;
      }
      if (out == chosen.numbers.size()) return;
      chosen.numbers[out] = in.number;
      chosen.gain = in.gain;
    }
  }

  // A dip more is work: not for nothing.
  void leave_out_idle(Chosen& chosen) const {
    const Values none(task_.targets.list.size(), 0);
    for (std::size_t k = chosen.numbers.size(); k-- > kept_.size();) {
      const std::int32_t without = sum_with(pool_.reached_by(chosen.numbers, k), none);
      if (without + kLeastGain < chosen.gain) continue;
      chosen.numbers.erase(chosen.numbers.begin() + std::ptrdiff_t(k));
      chosen.gain = without;
    }
  }

  // What is tried around one of them may do better in another's place.
  void better() {
    const std::string activity = "trying poses like the chosen ones";
    for (std::size_t ring = 0; ring < std::size(kRings_deg); ++ring) {
      context_.progress(activity, double(ring) / double(std::size(kRings_deg)));
      for (auto& trial : try_poses(task_, around_chosen(kRings_deg[ring]), context_)) {
        if (!trial) continue;
        add(*trial);
        tried_.push_back(std::move(*trial));
      }
      choose();
    }
    context_.progress(activity, 1);
  }

  std::vector<PoseOptions> around_chosen(double ring_deg) const {
    std::vector<PoseOptions> poses;
    for (std::size_t k = kept_.size(); k < chosen_.numbers.size(); ++k) {
      const PoseOptions& pose = pool_.trial(chosen_.numbers[k]).pose;
      for (const Vec3& near : directions_around(down_of(pose), ring_deg, kAround)) {
        const PoseOptions next = hold(pose, near, pose.rotate_deg.z());
        if (std::none_of(free_.begin(), free_.end(), [&](std::size_t n) {
              return angle_between_deg(pool_.trial(n).pose, next) < kNew * ring_deg;
            }))
          poses.push_back(next);
      }
    }
    return poses;
  }

  // So that the first few dips do as much as they can.
  std::vector<std::size_t> in_order() const {
    std::vector<std::size_t> ordered = kept_;
    std::vector<std::size_t> left(chosen_.numbers.begin() + std::ptrdiff_t(kept_.size()),
                                  chosen_.numbers.end());
    while (!left.empty()) {
      const auto best = pool_.best_addition(pool_.reached_by(ordered, ordered.size()), left);
      ordered.push_back(best.number);
      left.erase(std::find(left.begin(), left.end(), best.number));
    }
    return ordered;
  }

  const TrialTask& task_;
  const ChoiceOptions& options_;
  const RunContext& context_;
  Pool pool_;
  std::vector<std::size_t> kept_, free_;  // numbers in the pool: given, and to choose from
  Chosen chosen_;
  std::vector<Trial> tried_;
};

}  // namespace

double covered_share_of(const Targets& targets, const std::vector<const Trial*>& dips) {
  double covered = 0;
  for (std::size_t i = 0; i < targets.list.size(); ++i)
    if (std::any_of(dips.begin(), dips.end(), [&](const Trial* t) { return t->worth[i] > 0; }))
      covered += targets.list[i].area;
  return Coverage::share(covered, targets.area);
}

ChosenDips choose_dips(const TrialTask& task, const std::vector<Trial>& trials,
                       const ChoiceOptions& options, const RunContext& context) {
  const RunScope scope(context);
  return Choosing(task, trials, options, context).run();
}

}  // namespace hydrodip
