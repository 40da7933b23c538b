#include "coat/dipped_object.h"

#include <algorithm>
#include <utility>

#include "base/run_scope.h"
#include "dip/tear_doubt.h"
#include "dip/wetting.h"
#include "object/append.h"

namespace hydrodip {

namespace {

// Film that is laid is as near to where it lies.
constexpr double kOnSurface_mm = 0.05;

// Air that stays is as good as solid: its lids belong to what the film meets.
std::shared_ptr<const TriangleMesh> with_lids(const TriangleMesh& object,
                                              const TriangleMesh& lids) {
  auto all = std::make_shared<TriangleMesh>(object);
  append(*all, lids);
  return all;
}

DipResult dip_around_air(const PosedObject& posed, const TriangleMesh& lids,
                         const SharedFilmMesh& film, const Trajectory& trajectory,
                         const DipOptions& options, const RunContext& context,
                         const DipObserver& observe) {
  const std::shared_ptr<const TriangleMesh> all = with_lids(posed.mesh(), lids);
  const std::size_t own = posed.mesh().triangles.size();
  const Surface surface(all);
  DipResult result =
      dip(film, all->positions, all->triangles, surface, trajectory, options, context, observe);
  // What meets a lid floats on the water in the pocket.
  DippedFilm& dipped = result.film;
  for (std::size_t v = 0; v < dipped.state.size(); ++v) {
    if (dipped.state[v] != VertexState::kAttached) continue;
    const auto on = surface.closest_point(dipped.position[v], kOnSurface_mm);
    if (on && std::size_t(on->triangle) >= own) dipped.state[v] = VertexState::kUnattached;
  }
  return result;
}

}  // namespace

std::vector<double> moved_by_tears(const DippedFilm& dipped, const PosedObject& posed,
                                   const TrappedAir& air, const Trajectory& trajectory,
                                   const DipOptions& options, const RunContext& context) {
  const TriangleMesh& mesh = posed.mesh();
  if (air.lids.triangles.empty())
    return moved_by_tears(dipped, mesh.positions, mesh.triangles, posed.surface(), trajectory,
                          options, context);
  const std::shared_ptr<const TriangleMesh> all = with_lids(mesh, air.lids);
  return moved_by_tears(dipped, all->positions, all->triangles, Surface(all), trajectory, options,
                        context);
}

// Film that never tears is never doubtful.
DoubtfulStretch doubtful_stretch(const FilmMaterial& material) {
  if (!(material.tear_stretch > 0)) return {};
  return {std::min(material.safe_stretch, material.tear_stretch),
          std::max(material.lost_stretch, material.tear_stretch)};
}

DippedObject dip_object(const PosedObject& posed, const SharedFilmMesh& film,
                        const Trajectory& trajectory, const DipOptions& options, Timings& timings,
                        const RunContext& context, const DipObserver& observe,
                        const AirSearch& air) {
  const RunScope scope(context);
  DippedObject result{.posed = posed};
  const TriangleMesh& mesh = posed.mesh();
  result.air = air.found ? air.found : timings.measure("air", [&] {
    return std::make_shared<const TrappedAir>(
        find_air(mesh, posed.surface(), trajectory, air.options, context));
  });
  timings.measure("dip", [&] {
    auto history = std::make_shared<DipHistory>();
    const DipObserver watch = [&](auto&&... state) {
      history->record(state...);
      if (observe) observe(state...);
    };
    // What tears in a dip that was told when is known from another one.
    DipOptions asking = options;
    asking.asks_what_moves = options.tears_at_mm.empty() && !options.quick_look;
    const TriangleMesh& lids = result.air->lids;
    DipResult dipped = lids.triangles.empty()
                           ? dip(film, mesh.positions, mesh.triangles, posed.surface(), trajectory,
                                 asking, context, watch)
                           : dip_around_air(posed, lids, film, trajectory, asking, context, watch);
    result.film = std::make_shared<const DippedFilm>(std::move(dipped.film));
    result.statistics = dipped.statistics;
    result.history = std::move(history);
  });
  timings.measure("map", [&] {
    context.progress("mapping", 0);
    result.map = std::make_shared<const FilmMap>(mesh, posed.surface(), *result.film);
    result.direction_at = dipping_direction(trajectory, mesh.positions, mesh.triangles);
    result.coverage = measure_coverage(mesh, posed.surface(), *result.film, result.direction_at,
                                       doubtful_stretch(options.material));
    result.angles = dip_angles(mesh, result.direction_at);
    context.progress("mapping", 1);
  });
  return result;
}

}  // namespace hydrodip
