#include "plan/trial.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "air/air.h"
#include "base/run_scope.h"
#include "dip/measure.h"
#include "dip/tear_doubt.h"
#include "film/locate.h"
#include "plan/dip_watch.h"
#include "transfer/film_map.h"

namespace hydrodip {
namespace {

// Film is worth everything up to that part of its limit, and least at the limit.
constexpr double kEasyShare = 0.88;
constexpr double kLeastWorth = 0.6;
constexpr double kWrinkledWorth = 0.5;
// Film that never tears: from where on print blurs, and where it is worth least.
constexpr double kSharpStretch = 1.3, kBlurredStretch = kMostStretch;
// Deeper only for at least that much of the score.
constexpr double kWorthDeeper = 0.0005;
// Depths are given to a tenth.
constexpr double kDepthsPerMm = 10;

// Air that is shut in costs its area: film over it bursts, and its edge is a line of drops.
constexpr double kAirPrice = 0.5;
// Of a way that is not straight down so many depths are tried.
constexpr int kWayDepths = 6;

constexpr double kNever = DipWatch::kNever;

// Of film that never tears as well, as no film bears more than that.
double most_stretch(const FilmMaterial& material) {
  return material.tear_stretch > 0 ? material.tear_stretch : kMostStretch;
}

double worth_of(double stretch, double limit) {
  if (!(limit > 0) && stretch > kMostStretch) return 0;
  const double easy = limit > 0 ? kEasyShare * limit : kSharpStretch;
  const double least = limit > 0 ? limit : kBlurredStretch;
  const double t = std::clamp((stretch - easy) / (least - easy), 0.0, 1.0);
  return 1 - (1 - kLeastWorth) * t;
}

// A dip that was made, or given up.
struct MadeDip {
  const PosedObject& posed;
  const FilmMap& map;
  const DippedFilm& film;
  const DipWatch& watch;
  const TrappedAir* air = nullptr;
  const Coverage* coverage = nullptr;  // null: of what lay on the object at the depth in question
};

// Per target: when film landed there, and how well. The film triangle at a film coordinate is found
// by its place in the mesh.
class Landing {
 public:
  Landing(const TrialTask& task, const MadeDip& dip)
      : at_(task.targets.list.size(), kNever), worth_(task.targets.list.size(), 0) {
    const double limit = task.dip.material.tear_stretch;
    const PosedObject& posed = dip.posed;
    const Mat3 turn = posed.turn();
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const Target& target = task.targets.list[i];
      const Vec3 position = (posed.matrix() * target.position.homogeneous()).head<3>();
      const auto u = dip.map.to_film(position, turn * target.normal);
      if (!u) continue;
      const auto t = std::size_t(locate_flat(dip.film.mesh(), *u).triangle);
      if (!(dip.watch.landed_at()[t] < kNever)) continue;
      at_[i] = dip.watch.landed_at()[t];
      worth_[i] = float(worth_of(dip.watch.stretch()[t], limit));
      if (dip.film.wrinkled[t]) worth_[i] *= float(kWrinkledWorth);
    }
  }

  double at(std::size_t i) const { return at_[i]; }
  float worth(std::size_t i) const { return worth_[i]; }

 private:
  std::vector<double> at_;
  std::vector<float> worth_;
};

// What happens at a depth: surface gets film, film tears, or air is shut in.
struct Event {
  double at_mm;
  double gain;  // of the score
};

std::vector<Event> events_of(const TrialTask& task, const MadeDip& dip, const Landing& landing,
                             double object_mm2) {
  std::vector<Event> events;
  const Targets& targets = task.targets;
  for (std::size_t i = 0; i < targets.list.size(); ++i) {
    const Target& target = targets.list[i];
    if (landing.at(i) < kNever)
      events.push_back({landing.at(i), target.area * target.importance * double(landing.worth(i)) /
                                           targets.weight});
  }
  const DipWatch& watch = dip.watch;
  for (std::size_t t = 0; t < watch.torn_at().size(); ++t) {
    const double price = task.torn_price * watch.flat_mm2()[t] / object_mm2;
    if (watch.torn_at()[t] < kNever)
      events.push_back({watch.torn_at()[t], -price});
    else if (watch.torn_share()[t] > 0)
      events.push_back({watch.landed_at()[t], -price * watch.torn_share()[t]});
  }
  if (dip.air)
    for (const AirPocket& pocket : dip.air->pockets)
      events.push_back({pocket.closed_at_mm, -kAirPrice * pocket.area_mm2 / object_mm2});
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.at_mm < b.at_mm; });
  return events;
}

// What is looked for ends at a depth that a person can read: an object's own height has as many
// digits as a number can.
double readable_below(double depth_mm) {
  constexpr double kPartsPerMm = 100;
  const double parts = std::floor(depth_mm * kPartsPerMm + 1e-9);
  const double readable = parts / kPartsPerMm;
  return readable <= depth_mm ? readable : (parts - 1) / kPartsPerMm;
}

double best_depth(const std::vector<Event>& events, double reached_mm) {
  double score = 0, best = 0, best_at = 0;
  for (std::size_t i = 0; i < events.size() && events[i].at_mm <= reached_mm; ++i) {
    score += events[i].gain;
    const bool last_there = i + 1 == events.size() || events[i + 1].at_mm > events[i].at_mm;
    if (last_there && score > best + kWorthDeeper) {
      best = score;
      best_at = events[i].at_mm;
    }
  }
  const double rounded = std::ceil(best_at * kDepthsPerMm - 1e-6) / kDepthsPerMm;
  return rounded <= reached_mm ? rounded : readable_below(reached_mm);
}

// The depth at which film comes to lie that no film could be; kNever: there is none.
double overstretched_from(const TrialTask& task, const DipWatch& watch) {
  double first_mm = kNever;
  for (std::size_t t = 0; t < watch.landed_at().size(); ++t)
    if (!(task.dip.material.tear_stretch > 0) && watch.stretch()[t] > kMostStretch)
      first_mm = std::min(first_mm, watch.landed_at()[t]);
  return first_mm;
}

// At the best depth above that one, unless it is given.
Trial judged(const TrialTask& task, const PoseOptions& pose, const MadeDip& dip,
             std::optional<double> depth_mm, double deepest_mm) {
  const Landing landing(task, dip);
  const double scale = dip.posed.scale();
  const double object_mm2 = scale * scale * task.targets.area;
  const std::vector<Event> events = events_of(task, dip, landing, object_mm2);
  Trial trial{.pose = pose};
  const double first_mm = overstretched_from(task, dip.watch);
  if (first_mm <= deepest_mm)
    deepest_mm = std::max(0.0, std::ceil(first_mm * kDepthsPerMm - 1) / kDepthsPerMm);
  trial.depth_mm = depth_mm ? *depth_mm : best_depth(events, deepest_mm);
  TrialFigures& figures = trial.figures;
  for (const Event& event : events)
    if (event.at_mm <= trial.depth_mm) figures.score += event.gain;
  for (std::size_t i = 0; i < task.targets.list.size(); ++i)
    trial.worth.push_back(landing.at(i) <= trial.depth_mm ? landing.worth(i) : 0.0F);
  std::shared_ptr<const DippedFilm> film;
  if (task.keep_film || dip.coverage == nullptr)
    film = std::make_shared<const DippedFilm>(dip.watch.film_at(trial.depth_mm, dip.film));
  const Coverage coverage =
      dip.coverage != nullptr
          ? *dip.coverage
          : measure_coverage(dip.posed.mesh(), dip.posed.surface(), *film,
                             straight_down_to(trial.depth_mm), doubtful_stretch(task.dip.material));
  figures.covered_share = coverage.covered_share();
  figures.doubtful_share = coverage.doubtful_share();
  figures.torn_share = coverage.torn_share();
  if (dip.air)
    for (const AirPocket& pocket : dip.air->pockets)
      if (pocket.closed_at_mm <= trial.depth_mm) figures.air_mm2 += pocket.area_mm2;
  if (task.keep_film) trial.film = std::move(film);
  return trial;
}

// Whether it fits is all that is asked: nobody reads how its size would have to change.
constexpr double kUnspoken_mm = 0;

// The deepest at which the wetted part fits film and bath; negative if it does not even touch.
double deepest_fit(const TrialTask& task, const TriangleMesh& posed, double wanted_mm) {
  const auto fits_at = [&](double depth_mm) {
    const std::vector<RoomFit> list =
        fits(kUnspoken_mm, room_of(posed, depth_mm), task.film, task.bath);
    return std::all_of(list.begin(), list.end(),
                       [](const RoomFit& fit) { return fit.excess_mm() <= 0; });
  };
  if (fits_at(wanted_mm)) return wanted_mm;
  double low = 0, high = wanted_mm;  // low fits, or is nothing
  for (int i = 0; i < 10; ++i) {
    const double middle = 0.5 * (low + high);
    (fits_at(middle) ? low : high) = middle;
  }
  return low;
}

bool goes_straight_down(const TrajectoryOptions& way) {
  return way.path.empty() && way.tilt_deg == 0 && way.roll_deg == 0;
}

bool fits_on_its_way(const TrialTask& task, const TriangleMesh& posed, const Trajectory& way) {
  const std::vector<RoomFit> list = fits(kUnspoken_mm, room_of(posed, way), task.film, task.bath);
  return std::all_of(list.begin(), list.end(),
                     [](const RoomFit& fit) { return fit.excess_mm() <= 0; });
}

// On another way than straight down every depth is a way of its own, so that each is dipped: the
// given one, or that of a path; else some, and some more around the best.
std::optional<Trial> try_way(const TrialTask& task, const PosedObject& posed,
                             const PoseOptions& pose, double depth_most_mm,
                             const RunContext& context) {
  const TriangleMesh& mesh = posed.mesh();
  const auto film = std::make_shared<const FilmMesh>(make_film_mesh(task.film));
  std::optional<Trial> best;
  const auto dip_to = [&](double depth_mm) {
    TrajectoryOptions options = task.way;
    options.depth_mm = depth_mm;
    const Trajectory way = make_trajectory(options, mesh.positions);
    if (!fits_on_its_way(task, mesh, way)) return;
    Timings unheard;
    const DippedObject dipped = dip_object(posed, film, way, task.dip, unheard, context, {},
                                           {.options = task.air, .found = {}});
    Trial trial = judge_dip(task, pose, dipped);
    trial.path = task.way.path;
    if (depth_mm > 0 && depth_mm < kWholeObject_mm) trial.depth_mm = depth_mm;
    if (!best || trial.figures.score > best->figures.score) best = std::move(trial);
  };
  if (!task.way.path.empty() || task.depth_mm > 0) {
    dip_to(task.way.path.empty() ? task.depth_mm : 0);
    return best;
  }
  const Vec3 size = mesh.bounds().size();
  double most_mm = std::min(size.norm(), task.bath.depth_mm);
  if (depth_most_mm > 0) most_mm = std::min(most_mm, depth_most_mm);
  const auto rounded = [](double mm) {
    return std::max(1.0, std::round(mm * kDepthsPerMm)) / kDepthsPerMm;
  };
  for (int part = 1; part <= kWayDepths; ++part) dip_to(rounded(most_mm * part / kWayDepths));
  for (const double nearer : {0.5, 0.25}) {
    if (!best) return best;
    const double at = best->depth_mm;
    for (const double side : {-1.0, 1.0})
      dip_to(rounded(std::min(most_mm, at + side * nearer * most_mm / kWayDepths)));
  }
  return best;
}

// A dip straight down, and what it is worth. What moves with torn film is asked for the best depth
// alone: what lies there already does not move as the dip goes on.
class StraightTrial {
 public:
  StraightTrial(const TrialTask& task, const PoseOptions& pose, const PosedObject& posed,
                std::optional<double> depth_mm)
      : task_(task),
        pose_(pose),
        posed_(posed),
        depth_mm_(depth_mm),
        film_(std::make_shared<const FilmMesh>(make_film_mesh(task.film))),
        watch_(film_, most_stretch(task.dip.material), 1 / std::max(task.torn_price, 1e-6)) {}

  Trial run(double deepest_mm, const RunContext& context) {
    const Trajectory way = Trajectory::straight_down(deepest_mm);
    air_ = std::make_shared<const TrappedAir>(
        find_air(posed_.mesh(), posed_.surface(), way, task_.air, context));
    DippedFilm film = dipped(way, context);
    Trial trial = judge(film, film.depth_mm);
    if (!task_.asks_what_moves || !(trial.figures.score > task_.worth_asking) ||
        !(task_.dip.material.tear_stretch > 0) || first_let_go_mm(film) > trial.depth_mm)
      return trial;
    // In the steps that were made.
    const double step_mm = deepest_mm / std::ceil(deepest_mm / task_.dip.step_mm - 1e-9);
    const double asked_mm = step_mm * std::ceil(trial.depth_mm / step_mm - 1e-9);
    std::vector<double> moved = moved_by_tears(
        film, posed_, *air_, Trajectory::straight_down(std::min(asked_mm, deepest_mm)), task_.dip,
        context);
    add_moved(std::move(moved), task_.dip, film);
    watch_.take(film);
    return judge(film, trial.depth_mm);
  }

 private:
  // As far as it makes sense.
  DippedFilm dipped(const Trajectory& way, const RunContext& context) {
    DipOptions options = task_.dip;
    options.moved_mm.assign(film_->u.size(), 0);  // not asked yet
    Timings unheard;
    const DipObserver observe = [&](int, int, const Moment& moment,
                                    const std::vector<Vec3>& position,
                                    const std::vector<VertexState>& state) {
      watch_.see(moment, position, state, !depth_mm_);
    };
    try {
      const DippedObject made = dip_object(posed_, film_, way, options, unheard, context, observe,
                                           {.options = {}, .found = air_});
      watch_.take(*made.film);
      return *made.film;
    } catch (const TooMuchTorn&) {
      return watch_.stopped_film();
    }
  }

  Trial judge(const DippedFilm& film, double deepest_mm) const {
    const FilmMap map(posed_.mesh(), posed_.surface(), film);
    return judged(task_, pose_, {posed_, map, film, watch_, air_.get()}, depth_mm_, deepest_mm);
  }

  const TrialTask& task_;
  const PoseOptions& pose_;
  const PosedObject& posed_;
  const std::optional<double> depth_mm_;  // given
  const SharedFilmMesh film_;
  DipWatch watch_;
  std::shared_ptr<const TrappedAir> air_;
};

}  // namespace

std::optional<Trial> try_pose(const TrialTask& task, const PoseOptions& pose, double depth_most_mm,
                              const RunContext& context) {
  const RunScope scope(context);
  const PosedObject posed(task.object, pose);
  if (!goes_straight_down(task.way)) return try_way(task, posed, pose, depth_most_mm, context);
  const TriangleMesh& mesh = posed.mesh();
  double depth_mm = mesh.bounds().max.z();
  if (depth_most_mm > 0) depth_mm = std::min(depth_mm, depth_most_mm);
  if (task.depth_mm > 0) depth_mm = std::min(depth_mm, task.depth_mm);
  double fitting_mm = deepest_fit(task, mesh, depth_mm);
  if (!(task.depth_mm > 0)) fitting_mm = readable_below(fitting_mm);
  if (fitting_mm < (task.depth_mm > 0 ? depth_mm : 2 * task.dip.step_mm)) return std::nullopt;
  const std::optional<double> given = task.depth_mm > 0 ? std::optional(fitting_mm) : std::nullopt;
  return StraightTrial(task, pose, posed, given).run(fitting_mm, context);
}

std::vector<float> worth_at(const TrialTask& task, const PosedObject& posed,
                            const DippedFilm& film) {
  DipWatch watch(film.shared_mesh, task.dip.material.tear_stretch, 1);
  watch.take(film);
  const FilmMap map(posed.mesh(), posed.surface(), film);
  const Landing landing(task, {posed, map, film, watch});
  std::vector<float> worth(task.targets.list.size());
  for (std::size_t i = 0; i < worth.size(); ++i) worth[i] = landing.worth(i);
  return worth;
}

Trial judge_dip(const TrialTask& task, const PoseOptions& pose, const DippedObject& dipped) {
  DipWatch watch(dipped.film->shared_mesh, task.dip.material.tear_stretch, 1);
  watch.take(*dipped.film);
  return judged(
      task, pose,
      {dipped.posed, *dipped.map, *dipped.film, watch, dipped.air.get(), &dipped.coverage},
      dipped.film->depth_mm, dipped.film->depth_mm);
}

}  // namespace hydrodip
