#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "coat/film_paint.h"
#include "job/job_record.h"
#include "job/jobs.h"
#include "job/output.h"
#include "job/prepare.h"
#include "job/print_dips.h"
#include "job/sheet_of.h"
#include "job/wanted.h"
#include "job/ways.h"
#include "report/findings.h"
#include "report/report.h"
#include "session/sheet_files.h"

namespace hydrodip {
namespace {

// A sheet without a drop on it is never what was meant.
void require_ink(const Designed& designed, const JobConfig& config) {
  const auto& laid = designed.ink.ink.inking.inks.cmyk;
  if (std::any_of(laid.begin(), laid.end(), [](std::uint8_t value) { return value != 0; })) return;
  const Coverage& coverage = designed.dipped.coverage;
  throw InputError(fmt::format(
      "{}: the sheet would be blank. {}", config.model.string(),
      coverage.film_on_object_mm2 > 0
          ? "What the film reaches of the model is white, transparent or of the object's own "
            "colour; check its texture and colours, which side enters the water (--down), and "
            "--depth."
          : plain_verdict(coverage)));
}

}  // namespace

JobResult print_job(const JobConfig& given, const RunContext& context) {
  if (asks_for_several_dips(given)) return print_dips(given, context);
  JobConfig config = given;
  const RunScope scope(context.with_threads(config.threads));
  require_memory(config.design);
  OutputFolder folder(config.output, config.earlier_result);
  Timings times;

  PreparedObject prepared = times.measure("load", [&] {
    return prepare_object(config.model, config.object, context, config.design.dpi,
                          config.design.inverse.samples_per_axis);
  });
  require_size(prepared.posed, config.object, config.model);
  require_appearance(prepared, config.model);
  if (config.plan.find_pose || config.plan.find_depth)
    times.measure("find", [&] { find_what_is_asked(config, prepared, context); });
  const DesignOptions& options = config.design;
  const TriangleMesh& mesh = prepared.posed.mesh();
  const Trajectory trajectory = make_trajectory(options.trajectory, mesh.positions);
  require_fit(mesh, room_of(mesh, trajectory), options.film, config.bath, context);
  const Printer printer = make_printer(config.printer);
  const std::vector<ReportInput> inputs = describe_inputs(config, prepared, printer);
  announce_outputs(folder, "print", config, inputs);

  const Designed designed = design(
      {prepared.posed, *prepared.paint, Allotment(), *printer.model, options}, times, context);
  require_ink(designed, config);
  const Finish finish(paint_as_dipped(prepared.paint, designed.dipped),
                      {{designed.dipped, designed.raster,
                        std::make_shared<const Image>(designed.ink.ink.on_object)}});
  JobRecord record{"print", config,        prepared,
                   inputs,  finish,        times,
                   context, &designed.ink, printer.model->name()};
  record.wanted = wanted_coverage(designed.dipped, finish.paint());
  const Report first_look = make_report(record);
  const bool stop = concern_of(findings(first_look)) == Concern::kStop;
  if (stop)
    record.better_way = times.measure(
        "find", [&] { return better_way(config, prepared, designed.dipped, context); });
  SheetOptions sheet = sheet_of(config);
  if (stop) sheet.alarm = "DO NOT DIP: " + short_verdict(first_look);
  times.measure("sheet",
                [&] { write_sheet_files(folder, designed.ink.ink, printer, sheet, context); });

  const Previews previews =
      times.measure("preview", [&] { return write_previews(folder, record); });
  return finish_job(folder, record, previews);
}

}  // namespace hydrodip
