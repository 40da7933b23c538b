#include "studio/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

#include "base/error.h"
#include "base/run_scope.h"
#include "coat/film_paint.h"
#include "job/prepare.h"
#include "job/wanted.h"
#include "plan/fit.h"
#include "report/plain_words.h"
#include "settings/correction_file.h"
#include "studio/mends.h"

namespace hydrodip {
namespace {

[[noreturn]] void refuse(const std::string& code, const std::string& text, Json mends) {
  throw ProblemFound({code, text, std::move(mends)});
}

// What `compute` gives; what it throws is a problem that the page can show.
template <typename Compute>
auto or_refused(const Compute& compute) {
  try {
    return compute();
  } catch (const InputError& error) {
    refuse("input", in_plain_words(error.what()), Json::array());
  } catch (const DipError& error) {
    refuse("dip", in_plain_words(error.what()), Json::array());
  } catch (const std::bad_alloc&) {
    refuse("memory", "There is not enough memory for this.", Json::array());
  }
}

void require_sensible_size(const JobConfig& config, const TriangleMesh& posed) {
  if (config.object.pose.size_mm > 0 || !config.object.load.units.empty()) return;
  const double largest = posed.bounds().size().maxCoeff();
  if (largest >= kTiny_mm && largest <= kHuge_mm) return;
  refuse("input",
         fmt::format("Is it really {:.3g} mm large? Say its unit, or the size that it shall have.",
                     largest),
         size_mends());
}

void require_room(const JobConfig& config, const PosedObject& posed, const RunContext& context) {
  const TriangleMesh& mesh = posed.mesh();
  const std::string how = misfit(config, mesh);
  if (!how.empty()) refuse("input", how, room_mends(config, posed));
  const Trajectory way = make_trajectory(config.design.trajectory, mesh.positions);
  require_fit(posed.size_mm(), room_of(mesh, way), config.design.film, config.bath, context);
}

// What the print would look for: another way than the one that could be shown.
void require_known_way(const JobConfig& job, std::size_t dip) {
  const bool is_one_of_several = dip < job.dips.size();
  const bool leaves_pose = is_one_of_several ? job.dips[dip].find_rotation : job.plan.find_pose;
  if (leaves_pose || (job.plan.find_depth && !is_one_of_several))
    refuse("input",
           "This job leaves open how the object is held, or how deep it goes: look for a way, or "
           "say one.",
           is_one_of_several ? Json({orient_mend()}) : auto_mends());
}

}  // namespace

JobConfig config_of_dip(const JobConfig& config, std::size_t dip) {
  JobConfig own = config;
  own.plan.find_pose = own.plan.find_depth = false;
  own.plan.dips = 0;
  own.dips.clear();
  if (dip >= config.dips.size()) return own;
  const DipEntry& entry = config.dips[dip];
  if (entry.down) own.object.pose.down = *entry.down;
  if (entry.rotate_deg) own.object.pose.rotate_deg = *entry.rotate_deg;
  if (entry.depth_mm) own.design.trajectory.depth_mm = *entry.depth_mm;
  if (!entry.path.empty()) {
    own.design.trajectory.path = entry.path;
    own.design.trajectory.depth_mm = 0;  // a path says how deep
  }
  if (!entry.correction.empty())
    own.design.film.correction = read_correction_field(entry.correction);
  return own;
}

Look look_at_dip(Workspace& workspace, const JobConfig& job, std::size_t dip, LookQuality quality,
                 const std::vector<std::string>& known, const RunContext& context) {
  const RunScope scope(context);
  if (job.model.empty())
    refuse("no-model", "There is no model yet: drop one here, or open a sample.", Json::array());
  require_known_way(job, dip);
  return or_refused([&] {
    Look look;
    look.config = config_of_dip(job, dip);
    look.dip = dip;
    look.dips = std::max<std::size_t>(1, job.dips.size());
    look.quality = quality;
    const Project project = project_of(look.config, quality);
    look.model = workspace.model(project, context);
    const auto posed = workspace.posed(project, context);
    require_sensible_size(look.config, posed->mesh());
    require_room(look.config, *posed, context);
    look.paint = workspace.paint(project, quality_of(quality), context);
    look.artwork = workspace.laid(project, quality_of(quality), context);
    look.made = workspace.designed(project, quality_of(quality), context);
    look.paint = paint_as_dipped(look.paint, look.made->dipped);
    look.dry = dry_layers(look.artwork, look.made->dipped, points_of(quality));
    look.warnings = known;
    std::vector<std::string> dry;
    if (look.dips == 1)
      for (const DryLayer& layer : look.dry) dry.push_back(layer.told);
    for (const auto& list : {look.model->health.findings(), context.warnings(), dry})
      for (const std::string& warning : list)
        if (std::find(look.warnings.begin(), look.warnings.end(), warning) == look.warnings.end())
          look.warnings.push_back(warning);
    return look;
  });
}

DipsTogether look_at_dips(Workspace& workspace, const JobConfig& job, int texture_px,
                          const RunContext& context) {
  const RunScope scope(context);
  return or_refused([&] {
    JobConfig config = job;
    config.plan.find_pose = config.plan.find_depth = false;
    const Project project = project_of(config, LookQuality::kDraft);
    const auto model = workspace.model(project, context);
    const auto posed = workspace.posed(project, context);
    MeshHealth health = model->health;
    health.area_mm2 *= posed->scale() * posed->scale();
    config.design = draft_of(project.design);
    const PreparedObject prepared{.posed = *posed,
                                  .paint = workspace.paint(project, Quality::kDraft, context),
                                  .health = std::move(health),
                                  .units = model->units,
                                  .files = {},
                                  .artwork = workspace.laid(project, Quality::kDraft, context),
                                  .picture_problems = {}};
    return put_together(config, prepared, texture_px, context.quiet());
  });
}

}  // namespace hydrodip
