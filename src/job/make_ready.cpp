#include <utility>

#include "job/computed.h"
#include "job/correction_fit.h"
#include "job/ways.h"

namespace hydrodip {

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
  require_on_film(prepared, config.design.film);
  const TriangleMesh& mesh = prepared.posed.mesh();
  Trajectory trajectory = make_trajectory(config.design.trajectory, mesh.positions);
  const Room room = room_of(mesh, trajectory);
  require_fit(prepared.posed.size_mm(), room, config.design.film, config.bath, context);
  require_correction_fits(config, prepared.posed, room.depth_mm);
  Printer printer = make_printer(config.printer);
  return {std::move(config), std::move(prepared), std::move(trajectory), std::move(printer)};
}

}  // namespace hydrodip
