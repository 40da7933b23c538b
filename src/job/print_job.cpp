#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/output_folder.h"
#include "base/plain_number.h"
#include "base/run_scope.h"
#include "coat/film_paint.h"
#include "job/computed.h"
#include "job/job_record.h"
#include "job/jobs.h"
#include "job/output.h"
#include "job/prepare.h"
#include "job/print_dips.h"
#include "job/sheet_of.h"
#include "job/wanted.h"
#include "job/ways.h"
#include "plan/fit.h"
#include "report/findings.h"
#include "report/report.h"
#include "session/sheet_files.h"

namespace hydrodip {
namespace {

constexpr double kFlat_mm = 0.01;

// Why no film lies on the object.
std::string why_no_film(const DippedObject& dipped, const Trajectory& trajectory,
                        const JobConfig& config, bool inside_out) {
  // What is flat as it is held only touches the film.
  const double high_mm = dipped.posed.mesh().bounds().max.z();
  if (!inside_out && trajectory.is_straight_down() && high_mm < kFlat_mm) {
    const double asked_mm = config.design.trajectory.depth_mm;
    return fmt::format(
        "The object is flat as it is held, {} mm high, and goes no deeper than that{}: it only "
        "touches the film. Tilt it (dip.tilt_deg=20, or --rotate 0,20,0), or give it a way of its "
        "own (--path).",
        plain_number(high_mm),
        asked_mm > kFlat_mm ? fmt::format(" (the depth of {:g} mm was cut to it)", asked_mm) : "");
  }
  const Room wet = room_of(dipped.posed.mesh(), trajectory);
  const double wide_mm = 2 * std::min(wet.half_width_mm, wet.half_height_mm);
  const double cell_mm = dipped.film->mesh().cell_mm;
  if (inside_out || dipped.coverage.torn_mm2 > 0 || wide_mm > 2 * cell_mm)
    return no_film_verdict(dipped.coverage, inside_out);
  return fmt::format(
      "What comes into the water of the object is {} mm wide, and the film's triangles are "
      "{} mm: raise film.elements, take a smaller --film, or dip deeper (--depth).",
      plain_number(wide_mm), plain_number(cell_mm));
}

// What film lies on the object, and yet there is no ink on it.
std::string why_no_ink(const DippedObject& dipped, const Paint& paint) {
  const std::optional<ReportWanted> wanted = wanted_coverage(dipped, paint, {});
  if (!wanted)
    return "What the film reaches of the model is white, transparent, of the object's own colour "
           "or lighter than it (object.base_color); check its texture and colours, which side "
           "enters the water (--down), and --depth.";
  if (wanted->covered_mm2 > 0)
    return "Inks only darken what they lie on: what shall be printed where film lies is lighter "
           "than "
           "the object (object.base_color), or hardly differs from it.";
  if (wanted->reached_mm2 > 0)
    return "The film tears wherever there is something to print: turn flatter sides down with "
           "--rotate or --down.";
  if (const double dry_mm2 = dipped.air->area_mm2(); dry_mm2 > 0)
    return fmt::format(
        "What shall be printed does not come to the film, and trapped air keeps {:.0f} mm2 of the "
        "object dry: turn it so that hollows open upwards (--rotate, --down; --rotate auto finds "
        "how), or move the artwork.",
        dry_mm2);
  return "What shall be printed does not come to the film: turn it down with --rotate or --down "
         "(--rotate auto finds how), dip deeper (--depth), or move the artwork.";
}

// A sheet without a drop on it is never what was meant.
void require_ink(const Designed& designed, const ReadyJob& job) {
  const auto& laid = designed.ink.ink.inking.inks.cmyk;
  if (std::any_of(laid.begin(), laid.end(), [](std::uint8_t value) { return value != 0; })) return;
  const std::string thin = told_thin(job.prepared.artwork, job.config.design.dpi);
  const bool has_film = designed.dipped.coverage.film_on_object_mm2 > 0;
  throw InputError(fmt::format("{}: the sheet would be blank. {}", job.config.model.string(),
                               !has_film ? why_no_film(designed.dipped, job.trajectory, job.config,
                                                       job.prepared.health.inside_out)
                               : thin.empty() ? why_no_ink(designed.dipped, *job.prepared.paint)
                                              : thin));
}

}  // namespace

DesignedJob designed(const ReadyJob& job, const KeptImages& kept, Timings& times,
                     const RunContext& context) {
  const PreparedObject& prepared = job.prepared;
  Designed made = design({.posed = prepared.posed,
                          .paint = *prepared.paint,
                          .allotment = Allotment(),
                          .model = *job.printer.model,
                          .options = job.config.design,
                          .kept = kept},
                         times, context);
  require_ink(made, job);
  // Held once, by the finish.
  auto look = std::make_shared<const Image>(std::move(made.ink.ink.on_object));
  Finish finish(paint_as_dipped(prepared.paint, made.dipped),
                {{made.dipped, made.raster, std::move(look)}});
  return {std::move(made), std::move(finish)};
}

JobResult print_job(const JobConfig& given, const RunContext& context, const std::string& command) {
  if (asks_for_several_dips(given)) return print_dips(given, context);
  const RunScope scope(context.with_threads(given.threads));
  OutputFolder folder(given.output, given.earlier_result);
  Timings times;

  const ReadyJob job = make_ready(given, true, times, context);
  const JobConfig& config = job.config;
  const std::vector<ReportInput> inputs = describe_inputs(config, job.prepared, job.printer);
  announce_outputs(folder, command, config, inputs);
  folder.supersede(sheets_of_other_prints(0));

  DesignedJob made = designed(job, {.wanted = false, .stretch = false}, times, context);
  const DippedObject& dipped = made.designed.dipped;
  const InkResult& ink = made.designed.ink;
  warn_of(dry_layers(job.prepared.artwork, dipped), context);
  JobRecord record{command, config,      job.prepared,
                   inputs,  made.finish, times,
                   context, &ink,        job.printer.model->name()};
  record.wanted =
      wanted_coverage(dipped, *job.prepared.paint, doubtful_stretch(config.design.dip.material));
  const Report first_look = make_report(record);
  if (config.plan.suggest && concern_of(findings(first_look)) == Concern::kStop)
    record.better_way = times.measure(
        "find", [&] { return better_way(config, job.prepared, dipped, record.wanted, context); });
  const SheetOptions sheet = sheet_of(config, job.prepared.posed, first_look);
  Inking& laid = made.designed.ink.ink.inking;
  record.laid = ink_amounts(laid.inks, config.design.inking.limit);
  times.measure("sheet", [&] {
    write_sheet_files(folder, std::move(laid.inks), laid.printed, job.printer, sheet, context);
  });

  const Previews previews =
      times.measure("preview", [&] { return write_previews(folder, record); });
  return finish_job(folder, record, previews);
}

}  // namespace hydrodip
