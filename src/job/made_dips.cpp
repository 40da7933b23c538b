#include "job/made_dips.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "base/error.h"
#include "base/memory.h"
#include "base/timings.h"
#include "dip/tear_doubt.h"
#include "job/correction_fit.h"
#include "job/dips_side_by_side.h"
#include "job/job_part.h"
#include "job/ways.h"
#include "session/coat_of.h"

namespace hydrodip {
namespace {

// What film is worth that lay on the object until it got ink, beside film that lies there with it.
constexpr float kHoped = 0.3F;

JobConfig config_of(const JobConfig& config, const PreparedObject& prepared, const Trial& trial,
                    std::size_t number, std::size_t of) {
  JobConfig own = config;
  hold(own.object, prepared, trial.pose);
  own.design.trajectory.depth_mm = trial.path.empty() ? trial.depth_mm : 0;
  own.design.trajectory.path = trial.path;
  own.correction = correction_of(config, trial);
  own.design.film = film_of(config, trial);
  own.design.rounds_step_mm = longer_step_mm(own.design.dip.step_mm);
  own.design.settled_mm = std::max(own.design.settled_mm, kUnseen_mm);
  own.dips.clear();
  own.plan.dips = 0;
  const std::string name =
      config.print.job_name.empty() ? config.model.filename().string() : config.print.job_name;
  own.print.job_name = fmt::format("{}, dip {} of {}", name, number, of);
  return own;
}

int at_once(const MadeDips& all, const RunContext& context) {
  return std::min(int(all.dips.size()), context.threads());
}

// Two dips on one thread each take less time than one after the other on both, but twice the
// memory.
bool may_be_side_by_side(const MadeDips& all, const RunContext& context) {
  const DesignOptions& options = all.config.design;
  return options.film.elements <= kSmallFilm &&
         at_once(all, context) * sheet_memory_bytes(options, inkable_mm2(all.prepared, options)) <=
             0.5 * memory_limit_bytes();
}

std::vector<float> worth_at_nodes(const MadeDips& all, const MadeDip& dip, const DippedFilm& film) {
  return worth_at(job_trials(dip.config, all.prepared, all.nodes->targets()), dip.posed, film);
}

using Worth = std::vector<std::vector<float>>;  // per dip, per node

Worth worth_of_first(const MadeDips& all) {
  Worth worth;
  for (const MadeDip& dip : all.dips)
    worth.push_back(worth_at_nodes(all, dip, *dip.first.dipped.film));
  return worth;
}

SharedSurface divided(const MadeDips& all, Worth worth, const RunContext& context) {
  const Object& object = all.prepared.posed.object();
  const Surface surface(object.positions, object.triangles);
  return {{all.nodes, std::move(worth), *all.prepared.paint, surface, all.prepared.posed.scale(),
           all.config.plan.overlap_mm},
          context};
}

// Where no film with ink lies, those that lay there without: less ink than was tried may leave them
// there after all, and then they shall not be blank.
Worth with_hope(Worth inked, const Worth& blank) {
  for (std::size_t i = 0; i < inked.front().size(); ++i) {
    if (std::any_of(inked.begin(), inked.end(), [&](const auto& w) { return w[i] > 0; })) continue;
    for (std::size_t k = 0; k < inked.size(); ++k) inked[k][i] = kHoped * blank[k][i];
  }
  return inked;
}

// What each dip brings of the paint. Refers to all dips.
class Allotments {
 public:
  Allotments(const MadeDips& all, const SharedSurface& shared)
      : all_(all),
        of_(shared.allotments(std::make_shared<const TriangleMesh>(all.prepared.posed.object()))) {}

  DesignTask task(const MadeDip& dip, const Printer& printer) const {
    return {.posed = dip.posed,
            .paint = *all_.prepared.paint,
            .allotment = of_[std::size_t(dip.number - 1)],
            .model = *printer.model,
            .options = dip.config.design,
            .first = &dip.first,
            .kept = {.wanted = false}};
  }

 private:
  const MadeDips& all_;
  std::vector<Allotment> of_;
};

void for_each_dip(MadeDips& all, const std::string& activity, const RunContext& context,
                  const std::function<void(MadeDip&, const RunContext&)>& work) {
  if (may_be_side_by_side(all, context)) {
    dip_side_by_side(all.dips.size(), activity, context,
                     [&](std::size_t k, const RunContext& own) { work(all.dips[k], own); });
    return;
  }
  for (MadeDip& dip : all.dips) {
    context.log(fmt::format("dip {} of {}", dip.number, all.dips.size()));
    context.progress(activity, double(dip.number - 1) / double(all.dips.size()));
    do_part(fmt::format("dip {}", dip.number), context,
            [&](const RunContext& own) { work(dip, own); });
  }
}

// With its part of the ink.
void design_dip(MadeDip& dip, const Allotments& allotted, const Printer& printer,
                const RunContext& context) {
  Timings unheard;
  dip.made = design(allotted.task(dip, printer), unheard, context);
  const auto& laid = dip.made.ink.ink.inking.inks.cmyk;
  dip.blank = std::all_of(laid.begin(), laid.end(), [](std::uint8_t value) { return value == 0; });
}

// By gamut.policy=scale the dip that has to be lightened most decides for all: a colour looks the
// same on both sides of a seam.
void lighten_alike(MadeDips& all, const Allotments& allotted, const Printer& printer,
                   const RunContext& context) {
  const auto lightened = [](const MadeDip& dip) { return dip.made.ink.ink.inking.lightened; };
  const double least = lightened(*std::ranges::min_element(all.dips, {}, lightened));
  if (std::ranges::all_of(all.dips, [&](const auto& dip) { return lightened(dip) == least; }))
    return;
  for_each_dip(all, "lightening all dips alike", context, [&](MadeDip& dip, const RunContext& own) {
    if (lightened(dip) == least) return;
    dip.config.design.inking.lightened_most = least;
    design_dip(dip, allotted, printer, own);
  });
}

}  // namespace

void require_no_correction(const JobConfig& config) {
  if (config.design.film.correction)
    throw InputError(
        "film.correction: a correction is of one dip, and this job has several; name it in the "
        "[[dip]] table of its dip");
}

void require_no_pattern(const Paint& paint) {
  if (paint.depends_on_film())
    throw InputError(
        "artwork that is laid on the film (projection film) belongs to one dip: lay it on the "
        "object by another projection, or make it in a single dip");
}

MadeDips hang_up(const JobConfig& config, const PreparedObject& prepared, const DipPlan& plan,
                 const RunContext& context) {
  MadeDips all{config, prepared, {}, make_nodes(prepared, config.plan.overlap_mm), {}};
  warn_if_sheet_exceeds_bath(config.design.film, config.bath, context);
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    const PosedObject& posed = plan.dips[k].blank.posed;
    MadeDip dip{config_of(config, prepared, plan.dips[k].trial, k + 1, plan.dips.size()),
                plan.dips[k].trial,
                {plan.dips[k].blank, {}},
                posed,
                {DippedObject{.posed = posed}, {}, {}},
                false,
                fmt::format("dip-{}", k + 1),
                int(k) + 1};
    const Trajectory way = make_trajectory(dip.config.design.trajectory, posed.mesh().positions);
    const Room room = room_of(posed.mesh(), way);
    require_room(posed.size_mm(), room, config.design.film, config.bath);
    require_correction_fits(dip.config, posed, room.depth_mm);
    all.dips.push_back(std::move(dip));
  }
  return all;
}

SharedSurface divide(MadeDips& all, const Printer& printer, Timings& times,
                     const RunContext& context) {
  Worth blank;
  const SharedSurface by_blank = times.measure("seams", [&] {
    blank = worth_of_first(all);
    return divided(all, blank, context);
  });
  const Allotments rough(all, by_blank);
  times.measure("design", [&] {
    for_each_dip(all, "dipping with the first ink", context,
                 [&](MadeDip& dip, const RunContext& own) {
                   // What it would warn of, the dips that follow do.
                   dip.first = dip_with_first_ink(rough.task(dip, printer), own.quiet());
                 });
  });
  return times.measure(
      "seams", [&] { return divided(all, with_hope(worth_of_first(all), blank), context); });
}

Finish make_dips(MadeDips& all, const SharedSurface& shared, const Printer& printer, Timings& times,
                 const RunContext& context) {
  const Allotments allotted(all, shared);
  times.measure("design", [&] {
    for_each_dip(
        all, "making films and ink agree", context,
        [&](MadeDip& dip, const RunContext& own) { design_dip(dip, allotted, printer, own); });
    lighten_alike(all, allotted, printer, context);
    for (const MadeDip& dip : all.dips)
      context.log(fmt::format("dip {} of {}: {} rounds", dip.number, all.dips.size(),
                              dip.made.ink.rounds.size()));
  });
  // The paint does not depend on the film: require_no_pattern().
  std::vector<Coat> coats;
  for (MadeDip& dip : all.dips) {
    coats.push_back(coat_of(dip.made, coats.empty(), *printer.model));
    dip.made.ink.ink.stretch = {};
    all.worth.push_back(worth_at_nodes(all, dip, *dip.made.dipped.film));
  }
  return Finish(all.prepared.paint, std::move(coats));
}

std::vector<DryLayer> dry_layers_of(const MadeDips& all) {
  return dry_layers(all.prepared.artwork, all.nodes->targets(), [&](const Target& at) {
    return std::any_of(all.dips.begin(), all.dips.end(), [&](const MadeDip& dip) {
      const Target hung = in_pose(at, dip.posed);
      return bool(dip.made.dipped.map->to_film(hung.position, hung.normal));
    });
  });
}

}  // namespace hydrodip
