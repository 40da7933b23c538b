#include "job/made_dips.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/timings.h"
#include "hydrodip/hydrodip.h"
#include "job/ways.h"

namespace hydrodip {
namespace {

// Nodes of the divided surface lie so close, in parts of the overlap, as far as so many allow.
constexpr double kNodesInOverlap = 3.5;
constexpr double kLeastSpacing_mm = 0.3;
constexpr int kFewestNodes = 8000, kMostNodes = 60000;

JobConfig config_of(const JobConfig& config, const Trial& trial, std::size_t number,
                    std::size_t of) {
  JobConfig own = config;
  own.object.pose = trial.pose;
  own.design.trajectory.depth_mm = trial.path.empty() ? trial.depth_mm : 0;
  own.design.trajectory.path = trial.path;
  own.dips.clear();
  own.plan.dips = 0;
  const std::string name =
      config.print.job_name.empty() ? config.model.filename().string() : config.print.job_name;
  own.print.job_name = fmt::format("{}, dip {} of {}", name, number, of);
  return own;
}

std::shared_ptr<const SurfaceNodes> make_nodes(const PreparedObject& prepared, double overlap_mm) {
  const double spacing_mm = std::max(kLeastSpacing_mm, overlap_mm / kNodesInOverlap);
  const double wanted = prepared.health.area_mm2 / (spacing_mm * spacing_mm);
  const int count = int(std::clamp(wanted, double(kFewestNodes), double(kMostNodes)));
  return std::make_shared<const SurfaceNodes>(spread_targets(prepared.posed.object(), count));
}

std::vector<float> worth_at_nodes(const MadeDips& all, const MadeDip& dip, const DippedFilm& film) {
  return worth_at(job_trials(dip.config, all.prepared, all.nodes->targets()), dip.posed, film);
}

}  // namespace

void require_no_correction(const JobConfig& config) {
  if (config.design.film.correction)
    throw InputError(
        "film.correction: a correction is of one dip, and this job has several; leave it out");
}

MadeDips hang_up(const JobConfig& config, const PreparedObject& prepared, const DipPlan& plan,
                 const RunContext& context) {
  MadeDips all{config, prepared, {}, make_nodes(prepared, config.plan.overlap_mm), {}};
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    const PosedObject posed(prepared.posed.shared_object(), plan.dips[k].pose);
    MadeDip dip{config_of(config, plan.dips[k], k + 1, plan.dips.size()),
                plan.dips[k],
                posed,
                {DippedObject{.posed = posed}, {}, {}},
                fmt::format("dip-{}", k + 1),
                int(k) + 1};
    const Trajectory way = make_trajectory(dip.config.design.trajectory, posed.mesh().positions);
    require_fit(posed.mesh(), room_of(posed.mesh(), way), config.design.film, config.bath, context);
    all.dips.push_back(std::move(dip));
  }
  return all;
}

SharedSurface divide(const MadeDips& all, const RunContext& context) {
  std::vector<std::vector<float>> worth;
  for (const MadeDip& dip : all.dips) worth.push_back(worth_at_nodes(all, dip, *dip.trial.film));
  const Object& object = all.prepared.posed.object();
  const Surface surface(object.positions, object.triangles);
  return {{all.nodes, std::move(worth), *all.prepared.paint, surface, all.prepared.posed.scale(),
           all.config.plan.overlap_mm},
          context};
}

Finish make_dips(MadeDips& all, const SharedSurface& shared, const Printer& printer, Timings& times,
                 const RunContext& context) {
  const auto mesh = std::make_shared<const TriangleMesh>(all.prepared.posed.object());
  std::vector<Designed> designs;
  for (std::size_t k = 0; k < all.dips.size(); ++k) {
    MadeDip& dip = all.dips[k];
    context.log(fmt::format("dip {} of {}", k + 1, all.dips.size()));
    dip.made = design({dip.posed, *all.prepared.paint, shared.allotment(k, mesh), *printer.model,
                       dip.config.design},
                      times, context);
    designs.push_back(dip.made);
    all.worth.push_back(worth_at_nodes(all, dip, *dip.made.dipped.film));
  }
  return finish(all.prepared.paint, designs, printer);
}

}  // namespace hydrodip
