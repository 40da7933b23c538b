#include "dip/dip.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/awake_threads.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/plain_number.h"
#include "dip/measure.h"
#include "dip/scheme.h"
#include "dip/tear_doubt.h"

namespace hydrodip {

namespace {

// How far before and behind its straight way a point looks for contact, so that nothing slips
// between two steps or through single precision.
constexpr double kContactSlack_mm = 1e-3;

// A face that rises by less than this is flat.
constexpr double kFlat = 0.02;

// A path is cut into so many parts to see whether the object comes to the rim.
constexpr int kRimParts = 64;

// From this high above the water on film counts as lifted out.
constexpr double kLifted_mm = 0.1;

// Half a pixel at 600 dpi.
constexpr double kVisible_mm = 0.02;

// How much longer than dip.step_mm steps may grow, and up to which length.
constexpr double kLonger = 4;
constexpr double kLongest_mm = 0.4;
// So often one looks at least, as long as there are so many steps.
constexpr int kLeastLooks = 40;

void check(const DipOptions& options, const FilmMesh& film) {
  const auto refuse = [](const std::string& what) { throw InputError(what); };
  if (!(options.step_mm > 0)) refuse("dip.step_mm must be above 0");
  if (!(options.material.poisson > -1 && options.material.poisson < 0.5))
    refuse("material.poisson must be above -1 and below 0.5");
  if (!(options.material.z_stretch >= 0)) refuse("material.z_stretch must not be negative");
  if (options.material.law) check_law(*options.material.law);
  if (!options.modulus.empty() && options.modulus.size() != film.triangles.size())
    refuse("the stiffness field does not fit the film's mesh");
  if (!options.moved_mm.empty() && options.moved_mm.size() != film.u.size())
    refuse("how far the film moves was found on another mesh");
  if (!std::is_sorted(options.steps_at_mm.begin(), options.steps_at_mm.end()))
    refuse("the given steps do not follow each other");
  if (!options.tears_at_mm.empty() && options.tears_at_mm.size() != film.triangles.size())
    refuse("the given tears do not fit the film's mesh");
}

void check(const Trajectory& trajectory, const DipOptions& options) {
  if (trajectory.is_straight_down()) return;
  if (options.method != DipMethod::kFull || options.scheme != DipScheme::kContactLine)
    throw InputError(
        "dip.method=single-step, dip.method=projection and dip.scheme=paper only know the way "
        "straight down: leave out the path, or take the default method and scheme");
}

DipState floating_film(const FilmMesh& film) {
  DipState state;
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    state.position.emplace_back(film.u[v].x(), film.u[v].y(), 0.0);
    state.state.push_back(film.on_rim[v] ? VertexState::kClamped : VertexState::kUnattached);
  }
  state.torn.assign(film.triangles.size(), 0);
  state.lifted.assign(film.u.size(), 0);
  state.torn_at_mm.assign(film.triangles.size(), std::numeric_limits<double>::infinity());
  return state;
}

// Whether the object meets a point that stays in the bath where it is.
bool meets(const Surface& surface, const Travel& travel, const Vec2& place) {
  if (travel.trajectory().is_straight_down())
    return surface.is_hit(Vec3(place.x(), place.y(), -1), Vec3(0, 0, 1), 0, travel.length_mm() + 1);
  const auto seen = [&](int part) {
    const Moment moment = travel.at(travel.length_mm() * part / kRimParts);
    return moment.afloat(place);
  };
  for (int part = 1; part <= kRimParts; ++part)
    if (first_contact(surface, seen(part - 1), seen(part))) return true;
  return false;
}

void check_rim(const FilmMesh& film, const Surface& surface, const Travel& travel,
               const RunContext& context) {
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    if (!film.on_rim[v] || !meets(surface, travel, film.u[v])) continue;
    context.warn(
        "the object touches the film's taped rim, where the film cannot follow: use a larger film, "
        "a smaller object or another pose");
    return;
  }
}

// Below the water.
double deepest(const Moment& moment, const std::vector<Vec3>& positions) {
  double depth = 0;
  for (const Vec3& p : positions) depth = std::max(depth, -moment.height(p));
  return depth;
}

// Film that is laid and comes out of the water again.
void mark_lifted(DipState& state) {
  for (std::size_t v = 0; v < state.state.size(); ++v)
    if (state.state[v] == VertexState::kAttached &&
        state.moment.height(state.position[v]) > kLifted_mm)
      state.lifted[v] = 1;
}

std::unique_ptr<Scheme> make_scheme(const DipSetting& setting, DipState& state) {
  switch (setting.options.method) {
    case DipMethod::kProjection:
      return make_projection(setting, state);
    case DipMethod::kSingleStep:
      return make_single_step(setting, state);
    case DipMethod::kFull:
      break;
  }
  return setting.options.scheme == DipScheme::kPaper ? make_paper_scheme(setting, state)
                                                     : make_contact_line_scheme(setting, state);
}

void check_solved(double failed_mm, double length_mm, const DipOptions& options) {
  if (failed_mm <= options.failed_share_max * length_mm) return;
  throw DipError(fmt::format("the film's equilibrium was not found on {:.3g} mm of a way of {:.4g}",
                             failed_mm, length_mm));
}

// Whether film tears, in a scheme in which that makes a difference.
bool may_move(const DippedFilm& film, const DipOptions& options) {
  return options.material.tear_stretch > 0 && options.method == DipMethod::kFull &&
         options.scheme == DipScheme::kContactLine && std::isfinite(first_let_go_mm(film));
}

// How often somebody looks, evenly over the way.
int number_of_looks(const Travel& travel, const DipOptions& options) {
  if (options.method != DipMethod::kFull) return 1;
  const auto every = [&](double step_mm) {
    return std::max(1, static_cast<int>(std::ceil(travel.length_mm() / step_mm - 1e-9)));
  };
  return std::max(every(longest_step_mm(options, travel.trajectory())),
                  std::min(every(options.step_mm), kLeastLooks));
}

// Of film that floated as `wet`: what a millimetre of the printed sheet became.
void measure_from_print(const SharedFilmMesh& mesh, DippedFilm& film) {
  const auto area = [&](const std::vector<Vec2>& u, std::int32_t triangle) {
    const Triangle& t = mesh->triangles[std::size_t(triangle)];
    const Vec2& a = u[std::size_t(t[0])];
    return cross2(u[std::size_t(t[1])] - a, u[std::size_t(t[2])] - a);
  };
  for (std::size_t v = 0; v < mesh->u.size(); ++v) {
    double printed = 0, wet = 0;
    for (auto n = mesh->incident_begin[v]; n < mesh->incident_begin[v + 1]; ++n) {
      printed += area(mesh->u, mesh->incident[std::size_t(n)]);
      wet += area(mesh->wet, mesh->incident[std::size_t(n)]);
    }
    film.area_ratio[v] *= wet / printed;
  }
  film.shared_mesh = mesh;
}

DipResult dip_floating(const SharedFilmMesh& mesh, const std::vector<Vec3>& positions,
                       const std::vector<Triangle>& triangles, const Surface& surface,
                       const Trajectory& trajectory, const DipOptions& options,
                       const RunContext& context, const DipObserver& observe);

}  // namespace

double longest_step_mm(const DipOptions& options, const Trajectory& trajectory) {
  if (options.even_steps || options.scheme != DipScheme::kContactLine ||
      options.method != DipMethod::kFull || !trajectory.is_straight_down())
    return options.step_mm;
  return std::max(options.step_mm, std::min(kLonger * options.step_mm, kLongest_mm));
}

void relax_film(Relaxation& relaxation, const std::vector<std::uint8_t>& is_free, VertexVector& u,
                DipStatistics& statistics, const RelaxationOptions& options) {
  count(relaxation.run(is_free, options, u), u, statistics);
}

void count(const RelaxationResult& result, const VertexVector& u, DipStatistics& statistics) {
  statistics.iterations += result.iterations;
  if (!result.converged) ++statistics.unconverged_steps;
  const bool near = result.iterations > 0 && result.last_update_mm < kVisible_mm;
  if (!result.converged && !near) ++statistics.failed_steps;
  statistics.largest_residual_mm = std::max(statistics.largest_residual_mm, result.last_update_mm);
  parallel_for(u.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (!u[v].allFinite()) throw DipError("the film's equilibrium has no finite solution");
  });
}

std::optional<Contact> first_contact(const Surface& surface, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double length = way.norm();
  if (!(length > 0 && std::isfinite(length))) return std::nullopt;
  const double slack = kContactSlack_mm / length;
  const auto hit = surface.first_hit(from, way, -slack, 1 + slack);
  if (!hit) return std::nullopt;
  return Contact{surface.position(*hit), surface.normal(*hit)};
}

std::optional<Contact> first_touch(const Surface& surface, const Vec2& start, const Moment& from,
                                   const Vec2& end, const Moment& to) {
  auto contact = first_contact(surface, from.afloat(start), to.afloat(end));
  if (!contact || to.height(contact->position) < -kReached_mm) return contact;
  const Vec3 normal = to.direction_to_sinking(contact->normal);
  if (normal.head<2>().norm() < kFlat * std::abs(normal.z())) contact.reset();
  return contact;
}

DipResult dip(const SharedFilmMesh& mesh, const std::vector<Vec3>& positions,
              const std::vector<Triangle>& triangles, const Surface& surface,
              const Trajectory& trajectory, const DipOptions& options, const RunContext& context,
              const DipObserver& observe) {
  const RunScope scope(context);
  if (mesh->wet.empty())
    return dip_floating(mesh, positions, triangles, surface, trajectory, options, context, observe);
  DipResult result = dip_floating(std::make_shared<const FilmMesh>(floating_mesh(*mesh)), positions,
                                  triangles, surface, trajectory, options, context, observe);
  measure_from_print(mesh, result.film);
  return result;
}

namespace {

DipResult dip_floating(const SharedFilmMesh& mesh, const std::vector<Vec3>& positions,
                       const std::vector<Triangle>& triangles, const Surface& surface,
                       const Trajectory& trajectory, const DipOptions& options,
                       const RunContext& context, const DipObserver& observe) {
  const FilmMesh& film = *mesh;
  check(options, film);
  check(trajectory, options);
  const Travel travel(trajectory, positions, triangles);
  check_rim(film, surface, travel, context);
  DipState state = floating_film(film);
  state.moment = travel.at(0);
  const DipSetting setting{film, positions, triangles, surface, options, travel, context};
  const auto scheme = make_scheme(setting, state);
  const AwakeThreads awake;  // a step is some hundred short loops

  DipStatistics& statistics = state.statistics;
  const int looks = number_of_looks(travel, options);
  double failed_mm = 0;  // on so much of the way the film was not found
  if (observe) observe(0, looks, state.moment, state.position, state.state);
  for (int look = 1; look <= looks; ++look) {
    context.progress("dipping", double(look - 1) / looks);
    const double from_mm = state.moment.travelled_mm;
    const long failed = statistics.failed_steps;
    const std::size_t steps = statistics.steps_at_mm.size();
    // Rounding may not make the way longer than it is.
    scheme->advance(
        travel.at(look < looks ? travel.length_mm() * look / looks : travel.length_mm()));
    if (state.moment.moved) mark_lifted(state);
    // Some schemes count no steps: theirs are the looks.
    const auto made = std::max<std::size_t>(1, statistics.steps_at_mm.size() - steps);
    failed_mm += (state.moment.travelled_mm - from_mm) * double(statistics.failed_steps - failed) /
                 double(made);
    check_solved(failed_mm, travel.length_mm(), options);
    if (!observe && look < looks) continue;
    scheme->write_positions();
    if (observe) observe(look, looks, state.moment, state.position, state.state);
  }
  context.progress("dipping", 1);
  statistics.steps = statistics.steps_at_mm.empty() ? looks : int(statistics.steps_at_mm.size());
  if (statistics.unconverged_steps > 0)
    context.warn(fmt::format("in {} of {} steps the film's equilibrium was found only to {} mm",
                             statistics.unconverged_steps, statistics.steps,
                             plain_number(statistics.largest_residual_mm)));
  DippedFilm dipped = measured(mesh, state, options, surface);
  if (state.moment.moved) dipped.depth_mm = deepest(state.moment, positions);
  if (!options.moved_mm.empty())
    add_moved(options.moved_mm, options, dipped);
  else if (options.asks_what_moves && may_move(dipped, options))
    add_moved(moved_by_tears(dipped, positions, triangles, surface, trajectory, options, context),
              options, dipped);
  return {std::move(dipped), state.statistics};
}

}  // namespace
}  // namespace hydrodip
