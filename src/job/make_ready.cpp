#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "artwork/layer.h"
#include "base/error.h"
#include "job/computed.h"
#include "job/correction_fit.h"
#include "job/ways.h"

namespace hydrodip {
namespace {

// A picture that is left on the film may lie beside it.
void require_on_film(const PreparedObject& prepared, const JobConfig& config) {
  const FilmOptions& film = config.design.film;
  for (std::size_t k = 0; k < prepared.artwork.size(); ++k) {
    const ArtworkLayer& layer = config.object.artwork[k];
    if (layer.projection != Projection::kFilm || layer.repeat != Repeat::kOnce || !layer.at_mm)
      continue;
    const double reach = 0.5 * prepared.artwork[k].size_mm.norm();
    if (std::abs(layer.at_mm->x()) - reach < 0.5 * film.width_mm &&
        std::abs(layer.at_mm->y()) - reach < 0.5 * film.height_mm)
      continue;
    throw InputError(fmt::format(
        "{}: the artwork lies beside the sheet, which reaches {:g} x {:g} mm from its middle; move "
        "it with --art-at",
        name_of(layer), 0.5 * film.width_mm, 0.5 * film.height_mm));
  }
}

}  // namespace

ReadyJob make_ready(const JobConfig& given, bool to_print, Timings& times,
                    const RunContext& context) {
  JobConfig config = given;
  PreparedObject prepared = times.measure("load", [&] {
    return prepare_object(config.model, config.object, context, config.design.dpi,
                          config.design.inverse.samples_per_axis);
  });
  require_size(prepared.posed, config.object, config.model);
  if (to_print) {
    require_appearance(prepared, config.model);
    require_memory(config.design, inkable_mm2(prepared, config.design));
    warn_if_draft(config.design, context);
  }
  if (config.plan.find_pose || config.plan.find_depth)
    times.measure("find", [&] { find_what_is_asked(config, prepared, context); });
  require_on_film(prepared, config);
  const TriangleMesh& mesh = prepared.posed.mesh();
  Trajectory trajectory = make_trajectory(config.design.trajectory, mesh.positions);
  const Room room = room_of(mesh, trajectory);
  require_fit(mesh, room, config.design.film, config.bath, context);
  require_correction_fits(config, prepared.posed, room.depth_mm);
  Printer printer = make_printer(config.printer);
  return {std::move(config), std::move(prepared), std::move(trajectory), std::move(printer)};
}

}  // namespace hydrodip
