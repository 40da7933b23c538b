#include "coat/dipped_object.h"

#include <utility>

#include "base/run_scope.h"
#include "dip/wetting.h"

namespace hydrodip {

DippedObject dip_object(const PosedObject& posed, const SharedFilmMesh& film,
                        const Trajectory& trajectory, const DipOptions& options, Timings& timings,
                        const RunContext& context, const DipObserver& observe) {
  const RunScope scope(context);
  DippedObject result{.posed = posed};
  const TriangleMesh& mesh = posed.mesh();
  timings.measure("dip", [&] {
    auto history = std::make_shared<DipHistory>();
    DipResult dipped = dip(film, mesh.positions, mesh.triangles, posed.surface(), trajectory,
                           options, context, [&](auto&&... state) {
                             history->record(state...);
                             if (observe) observe(state...);
                           });
    result.film = std::make_shared<const DippedFilm>(std::move(dipped.film));
    result.statistics = dipped.statistics;
    result.history = std::move(history);
  });
  timings.measure("map", [&] {
    context.progress("mapping", 0);
    result.map = std::make_shared<const FilmMap>(mesh, posed.surface(), *result.film);
    result.direction_at = dipping_direction(trajectory, mesh.positions, mesh.triangles);
    result.coverage = measure_coverage(mesh, *result.film, result.direction_at);
    result.angles = dip_angles(mesh, result.direction_at);
    context.progress("mapping", 1);
  });
  return result;
}

}  // namespace hydrodip
