// Trial dips: what one way to hold an object is worth, and how deep it should go.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "base/context.h"
#include "coat/dipped_object.h"
#include "film/film.h"
#include "plan/fit.h"
#include "plan/targets.h"

namespace hydrodip {

// The first three as Coverage has them.
struct TrialFigures {
  double covered_share = 0;
  double doubtful_share = 0;
  double torn_share = 0;
  double air_mm2 = 0;  // surface under trapped air
  // How much of what is wanted lands well: 1 is everything; below 0 more is spoilt than gained.
  double score = 0;
};

struct Trial {
  PoseOptions pose;
  double depth_mm = 0;
  std::vector<Keyframe> path = {};  // the way in, of a dip that was given one; empty: straight down
  TrialFigures figures = {};
  // Per target: what the film there is worth; 0: none, 1: whole and little stretched.
  std::vector<float> worth = {};
  // As it lies at that depth, where the task keeps it.
  std::shared_ptr<const DippedFilm> film = {};
};

// A depth that no object reaches: all of it goes in.
inline constexpr double kWholeObject_mm = 1e9;

// Of a single dip. Among several another one does what torn film leaves, which is blank and does no
// harm: it only costs film.
inline constexpr double kTornPrice = 3;
inline constexpr double kTornPriceAmongSeveral = 0.02;

// What all trials of an object have in common. Refers to what it does not share.
struct TrialTask {
  std::shared_ptr<const Object> object;
  const Targets& targets;  // of the object's triangles, in its own frame
  FilmOptions film;
  DipOptions dip;
  BathOptions bath;
  double depth_mm = 0;  // 0: the best one is looked for
  // Other ways in than straight down: a path, which says the depth too; tilt or roll, whose depth
  // is as above.
  TrajectoryOptions way = {};
  AirOptions air = {.cells = 0};
  // Torn film costs so many times its area: its flaps spoil what lies around, and are cleaned off.
  double torn_price = kTornPrice;
  // Film whose place depends on how torn film falls is worth nothing.
  bool asks_what_moves = true;
  // Asking lowers a score: straight down, what is not above that one before is not asked.
  double worth_asking = -std::numeric_limits<double>::infinity();
  bool keep_film = false;
};

// One dip in that pose, as deep as makes sense, and the best depth on its way: film that has
// touched stays, so that the dip passes through every shallower one. Nothing if the object fits
// neither film nor bath like that. `depth_most_mm` bounds the depth; 0: it does not.
std::optional<Trial> try_pose(const TrialTask& task, const PoseOptions& pose, double depth_most_mm,
                              const RunContext& context);

// The same of a dip that was made, at its own depth.
Trial judge_dip(const TrialTask& task, const PoseOptions& pose, const DippedObject& dipped);

// Per target: what film that lies on the object is worth there; 0: none.
std::vector<float> worth_at(const TrialTask& task, const PosedObject& posed,
                            const DippedFilm& film);

// The object with as many triangles as trial dips can make out, for a large scan; else itself.
std::shared_ptr<const Object> simplified_for_trials(std::shared_ptr<const Object> object);

}  // namespace hydrodip
