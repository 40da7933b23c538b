#include "plan/trial.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "base/run_scope.h"
#include "film/locate.h"
#include "transfer/film_map.h"

namespace hydrodip {
namespace {

// Film is worth everything up to that part of its limit, and least at the limit.
constexpr double kEasyShare = 0.88;
constexpr double kLeastWorth = 0.6;
constexpr double kDoubtfulShare = 0.95;
// Film that never tears: from where on print blurs, and where it is worth least.
constexpr double kSharpStretch = 1.3, kBlurredStretch = 2;
// Deeper only for at least that much of the score.
constexpr double kWorthDeeper = 0.0005;
// A depth is given to a tenth, and rounded down.
constexpr double kDepthStep_mm = 0.1;

constexpr double kNever = std::numeric_limits<double>::infinity();

struct TooMuchTorn {};

double worth_of(double stretch, double limit) {
  const double easy = limit > 0 ? kEasyShare * limit : kSharpStretch;
  const double least = limit > 0 ? limit : kBlurredStretch;
  const double t = std::clamp((stretch - easy) / (least - easy), 0.0, 1.0);
  return 1 - (1 - kLeastWorth) * t;
}

// Follows a dip: when each film triangle came to lie on the object, and when it tore.
class Watch {
 public:
  // Given up where torn film costs more than all whole film can be worth.
  Watch(const FilmMesh& film, const TrialTask& task)
      : film_(film),
        limit_(task.dip.material.tear_stretch),
        hopeless_share_(1 / std::max(task.torn_price, 1e-6)),
        landed_at_(film.triangles.size(), kNever),
        torn_at_(film.triangles.size(), kNever),
        stretch_(film.triangles.size(), 1),
        flat_mm2_(film.triangles.size(), 0) {
    for (std::size_t t = 0; t < film.triangles.size(); ++t)
      flat_mm2_[t] = 0.5 * std::abs(twice_area(t));
  }

  void see(const Moment& moment, const std::vector<Vec3>& position,
           const std::vector<VertexState>& state, bool may_stop) {
    for (std::size_t t = 0; t < landed_at_.size(); ++t) {
      if (landed_at_[t] < kNever || torn_at_[t] < kNever) continue;
      int attached = 0;
      for (const std::int32_t v : film_.triangles[t])
        attached += state[std::size_t(v)] == VertexState::kAttached ? 1 : 0;
      if (attached == 0) continue;
      stretch_[t] = stretch_of(t, position);
      if (limit_ > 0 && stretch_[t] > limit_) {
        torn_at_[t] = moment.travelled_mm;
        torn_mm2_ += flat_mm2_[t];
      } else if (attached == 3) {
        landed_at_[t] = moment.travelled_mm;
        landed_mm2_ += flat_mm2_[t];
      }
    }
    if (may_stop && torn_mm2_ > hopeless_share_ * landed_mm2_ && moment.travelled_mm > 2) {
      stopped_ = {position, state, moment.travelled_mm};
      throw TooMuchTorn();
    }
  }

  // What the whole dip says of it is better known than what was seen on its way.
  void take(const DippedFilm& film) {
    for (std::size_t t = 0; t < landed_at_.size(); ++t) {
      torn_at_[t] = film.torn[t] ? film.torn_at_mm[t] : kNever;
      if (film.torn[t] && !(torn_at_[t] < kNever)) torn_at_[t] = film.depth_mm;
      if (!film.lies_on_object(t)) {
        landed_at_[t] = kNever;
        continue;
      }
      landed_at_[t] = std::min(landed_at_[t], film.depth_mm);
      stretch_[t] = stretch_of(t, film.position);
    }
  }

  // The film at the moment when the watch was given up.
  DippedFilm stopped_film(const SharedFilmMesh& mesh) const {
    DippedFilm film;
    film.shared_mesh = mesh;
    film.position = stopped_.position;
    film.state = stopped_.state;
    film.area_ratio.assign(film.position.size(), 1);
    film.stretch.assign(film.position.size(), 1);
    film.torn_at_mm = torn_at_;
    for (const double at : torn_at_) film.torn.push_back(at < kNever);
    film.depth_mm = stopped_.depth_mm;
    return film;
  }

  const std::vector<double>& landed_at() const { return landed_at_; }
  const std::vector<double>& torn_at() const { return torn_at_; }
  const std::vector<double>& stretch() const { return stretch_; }
  const std::vector<double>& flat_mm2() const { return flat_mm2_; }

 private:
  double twice_area(std::size_t t) const {
    const Triangle& v = film_.triangles[t];
    const Vec2& a = film_.u[std::size_t(v[0])];
    return cross2(film_.u[std::size_t(v[1])] - a, film_.u[std::size_t(v[2])] - a);
  }

  // Largest singular value of the flat triangle's deformation.
  double stretch_of(std::size_t t, const std::vector<Vec3>& position) const {
    const Triangle& v = film_.triangles[t];
    const Vec2& a = film_.u[std::size_t(v[0])];
    const Vec2 p = film_.u[std::size_t(v[1])] - a, q = film_.u[std::size_t(v[2])] - a;
    const Vec3& x = position[std::size_t(v[0])];
    const Vec3 P = position[std::size_t(v[1])] - x, Q = position[std::size_t(v[2])] - x;
    const double twice = cross2(p, q);
    const Vec3 along_x = (q.y() * P - p.y() * Q) / twice, along_y = (p.x() * Q - q.x() * P) / twice;
    const double xx = along_x.squaredNorm(), yy = along_y.squaredNorm(), xy = along_x.dot(along_y);
    return std::sqrt(0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy));
  }

  struct Stopped {
    std::vector<Vec3> position;
    std::vector<VertexState> state;
    double depth_mm = 0;
  };

  const FilmMesh& film_;
  double limit_, hopeless_share_;
  std::vector<double> landed_at_, torn_at_, stretch_, flat_mm2_;
  double landed_mm2_ = 0, torn_mm2_ = 0;
  Stopped stopped_;
};

// The film triangle at a film coordinate is found by FilmMap; which one, by its place in the mesh.
class Landing {
 public:
  Landing(const TrialTask& task, const PosedObject& posed, const DippedFilm& film,
          const Watch& watch)
      : at_(task.targets.list.size(), kNever),
        worth_(task.targets.list.size(), 0),
        stretch_(worth_) {
    const FilmMap map(posed.mesh(), posed.surface(), film);
    const double limit = task.dip.material.tear_stretch;
    const Mat3 turn = posed.matrix().topLeftCorner<3, 3>() / posed.scale();
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const Target& target = task.targets.list[i];
      const Vec3 position = (posed.matrix() * target.position.homogeneous()).head<3>();
      const auto u = map.to_film(position, turn * target.normal);
      if (!u) continue;
      const FilmLocation where = locate_flat(film.mesh(), *u);
      const auto t = std::size_t(where.triangle);
      if (!(watch.landed_at()[t] < kNever)) continue;
      at_[i] = watch.landed_at()[t];
      stretch_[i] = float(watch.stretch()[t]);
      worth_[i] = float(worth_of(watch.stretch()[t], limit));
    }
  }

  double at(std::size_t i) const { return at_[i]; }
  float worth(std::size_t i) const { return worth_[i]; }
  float stretch(std::size_t i) const { return stretch_[i]; }

 private:
  std::vector<double> at_;
  std::vector<float> worth_, stretch_;
};

// What happens at a depth: surface gets film, or film tears.
struct Event {
  double at_mm;
  double gain;  // of the score
};

double best_depth(const TrialTask& task, const Landing& landing, const Watch& watch,
                  double object_mm2, double reached_mm) {
  std::vector<Event> events;
  const Targets& targets = task.targets;
  for (std::size_t i = 0; i < targets.list.size(); ++i) {
    const Target& target = targets.list[i];
    if (landing.at(i) < kNever)
      events.push_back({landing.at(i), target.area * target.importance * double(landing.worth(i)) /
                                           targets.weight});
  }
  for (std::size_t t = 0; t < watch.torn_at().size(); ++t)
    if (watch.torn_at()[t] < kNever)
      events.push_back({watch.torn_at()[t], -task.torn_price * watch.flat_mm2()[t] / object_mm2});
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.at_mm < b.at_mm; });
  double score = 0, best = 0, best_at = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    score += events[i].gain;
    const bool last_there = i + 1 == events.size() || events[i + 1].at_mm > events[i].at_mm;
    if (last_there && score > best + kWorthDeeper) {
      best = score;
      best_at = events[i].at_mm;
    }
  }
  const double rounded = std::ceil(best_at / kDepthStep_mm - 1e-6) * kDepthStep_mm;
  return std::min(rounded, reached_mm);
}

Trial judged(const TrialTask& task, const PosedObject& posed, const PoseOptions& pose,
             const DippedFilm& film, const Watch& watch, std::optional<double> depth_mm) {
  const Landing landing(task, posed, film, watch);
  const Targets& targets = task.targets;
  const double scale = posed.scale();
  const double object_mm2 = scale * scale * targets.area;
  Trial trial{.pose = pose};
  trial.depth_mm =
      depth_mm ? *depth_mm : best_depth(task, landing, watch, object_mm2, film.depth_mm);
  const double limit = task.dip.material.tear_stretch;
  double torn_mm2 = 0, landed_mm2 = 0, gained = 0;
  for (std::size_t t = 0; t < watch.torn_at().size(); ++t) {
    if (watch.torn_at()[t] <= trial.depth_mm)
      torn_mm2 += watch.flat_mm2()[t];
    else if (watch.landed_at()[t] <= trial.depth_mm)
      landed_mm2 += watch.flat_mm2()[t];
  }
  for (std::size_t i = 0; i < targets.list.size(); ++i) {
    const Target& target = targets.list[i];
    const bool lies = landing.at(i) <= trial.depth_mm;
    trial.worth.push_back(lies ? landing.worth(i) : 0.0F);
    if (!lies) continue;
    trial.figures.covered_share += target.area / targets.area;
    gained += target.area * target.importance * double(landing.worth(i));
    if (limit > 0 && double(landing.stretch(i)) > kDoubtfulShare * limit)
      trial.figures.doubtful_share += target.area / targets.area;
  }
  trial.figures.torn_share = Coverage::share(torn_mm2, torn_mm2 + landed_mm2);
  trial.figures.score =
      Coverage::share(gained, targets.weight) - task.torn_price * torn_mm2 / object_mm2;
  return trial;
}

// Vertices that share a cell of a grid become one, in their middle.
std::shared_ptr<const Object> drawn_together(const Object& object, double cells_across) {
  const Box3 box = object.bounds();
  const double cell = std::max(box.size().maxCoeff() / cells_across, 1e-12);
  auto simple = std::make_shared<Object>();
  std::unordered_map<std::uint64_t, std::int32_t> vertex_in;
  std::vector<std::int32_t> moved(object.positions.size());
  std::vector<double> count;
  CheckEvery check(1 << 14);
  for (std::size_t v = 0; v < object.positions.size(); ++v) {
    check();
    const Vec3 at = (object.positions[v] - box.min) / cell;
    const std::uint64_t key =
        (std::uint64_t(at.x()) << 40) | (std::uint64_t(at.y()) << 20) | std::uint64_t(at.z());
    const auto [found, is_new] = vertex_in.emplace(key, std::int32_t(simple->positions.size()));
    if (is_new) {
      simple->positions.push_back(Vec3::Zero());
      count.push_back(0);
    }
    moved[v] = found->second;
    simple->positions[std::size_t(found->second)] += object.positions[v];
    count[std::size_t(found->second)] += 1;
  }
  for (std::size_t v = 0; v < count.size(); ++v) simple->positions[v] /= count[v];
  for (const Triangle& t : object.triangles) {
    const Triangle turned = {moved[std::size_t(t[0])], moved[std::size_t(t[1])],
                             moved[std::size_t(t[2])]};
    if (turned[0] == turned[1] || turned[1] == turned[2] || turned[2] == turned[0]) continue;
    simple->triangles.push_back(turned);
  }
  simple->material_of.assign(simple->triangles.size(), 0);
  simple->materials.emplace_back();
  return simple;
}

// The deepest at which the wetted part fits film and bath; negative if it does not even touch.
double deepest_fit(const TrialTask& task, const TriangleMesh& posed, double wanted_mm) {
  const auto fits_at = [&](double depth_mm) {
    const std::vector<RoomFit> list = fits(posed, room_of(posed, depth_mm), task.film, task.bath);
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

}  // namespace

std::optional<Trial> try_pose(const TrialTask& task, const PoseOptions& pose, double depth_most_mm,
                              const RunContext& context) {
  const RunScope scope(context);
  const PosedObject posed(task.object, pose);
  const TriangleMesh& mesh = posed.mesh();
  double depth_mm = mesh.bounds().max.z();
  if (depth_most_mm > 0) depth_mm = std::min(depth_mm, depth_most_mm);
  if (task.depth_mm > 0) depth_mm = std::min(depth_mm, task.depth_mm);
  const double fitting_mm = deepest_fit(task, mesh, depth_mm);
  if (fitting_mm < (task.depth_mm > 0 ? depth_mm : 2 * task.dip.step_mm)) return std::nullopt;
  const auto film = std::make_shared<const FilmMesh>(make_film_mesh(task.film));
  Watch watch(*film, task);
  const std::optional<double> given = task.depth_mm > 0 ? std::optional(fitting_mm) : std::nullopt;
  try {
    const DipResult dipped = dip(
        film, mesh.positions, mesh.triangles, posed.surface(),
        Trajectory::straight_down(fitting_mm), task.dip, context,
        [&](int, int, const Moment& moment, const std::vector<Vec3>& position,
            const std::vector<VertexState>& state) { watch.see(moment, position, state, !given); });
    watch.take(dipped.film);
    return judged(task, posed, pose, dipped.film, watch, given);
  } catch (const TooMuchTorn&) {
    return judged(task, posed, pose, watch.stopped_film(film), watch, given);
  }
}

Trial judge_dip(const TrialTask& task, const PoseOptions& pose, const DippedObject& dipped) {
  Watch watch(dipped.film->mesh(), task);
  watch.take(*dipped.film);
  Trial trial = judged(task, dipped.posed, pose, *dipped.film, watch, dipped.film->depth_mm);
  if (dipped.air) trial.figures.air_mm2 = dipped.air->area_mm2();
  return trial;
}

std::shared_ptr<const Object> simplified_for_trials(std::shared_ptr<const Object> object) {
  constexpr std::size_t kMany = 60000;
  std::shared_ptr<const Object> simple = object;
  for (double cells = 200; simple->triangles.size() > kMany && cells > 20; cells /= 1.4)
    simple = drawn_together(*object, cells);
  return simple;
}

}  // namespace hydrodip
