#include "job/print_dips.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "export/film_ply.h"
#include "export/preview_glb.h"
#include "hydrodip/hydrodip.h"
#include "image/resize.h"
#include "job/dip_plan.h"
#include "job/dips_pictures.h"
#include "job/dips_report.h"
#include "job/job_record.h"
#include "job/logo.h"
#include "job/output.h"
#include "job/sheet_of.h"
#include "job/wanted.h"
#include "job/ways.h"
#include "object/bake.h"
#include "report/findings.h"
#include "session/sheet_files.h"

namespace hydrodip {
namespace {

void require_some_ink(const MadeDips& all) {
  if (!std::ranges::all_of(all.dips, &MadeDip::blank)) return;
  const std::string thin = told_thin(all.prepared.artwork, all.config.design.dpi);
  const auto gets_film = [](const MadeDip& dip) {
    return dip.made.dipped.coverage.film_on_object_mm2 > 0;
  };
  const bool inside_out =
      all.prepared.health.inside_out && std::ranges::none_of(all.dips, gets_film);
  throw InputError(fmt::format(
      "{}: all sheets would be blank: {}", all.config.model.string(),
      inside_out ? fmt::format("no film stays on the object: {}; {}", kLooksInwards, kTurnNormals)
      : !thin.empty() ? thin
                      : "what the films reach of the model is white, transparent, of the object's "
                        "own colour or lighter than it (object.base_color); check its texture and "
                        "colours"));
}

// What the wet bench needs of one dip, whose inks are spent on it. `painted`: the object in any
// pose.
void write_dip(OutputFolder& folder, MadeDip& dip, const MadeDips& all, const Object& painted,
               const std::vector<ReportInput>& inputs, const Printer& printer, const Timings& times,
               const RunContext& context) {
  const std::string inside = dip.folder + "/";
  Inking& laid = dip.made.ink.ink.inking;
  write_film_ply(folder.path(inside + "film.ply"), *dip.made.dipped.film);
  const PosedObject& posed = dip.made.dipped.posed;
  const int texture_px = dip.config.preview_texture_px;
  Object looks = painted;
  looks.positions = posed.mesh().positions;
  write_preview_glb(folder.path(inside + "preview.glb"), looks, posed.surface(),
                    *dip.made.dipped.film, shrink_to(dip.made.ink.ink.on_object, 2 * texture_px),
                    dip.made.raster.width_mm, dip.made.raster.height_mm, all.prepared.paint->base(),
                    texture_px);
  const Finish alone(all.prepared.paint,
                     {{dip.made.dipped, dip.made.raster,
                       std::make_shared<const Image>(dip.made.ink.ink.on_object)}});
  JobRecord record{"print", dip.config,    all.prepared,         inputs, alone, times,
                   context, &dip.made.ink, printer.model->name()};
  record.laid = ink_amounts(laid.inks, dip.config.design.inking.limit);
  Report report = make_report(record);
  report.warnings.clear();
  report.dip_number = dip.number;
  report.dip_of = int(all.dips.size());
  write_sheet_files(folder, std::move(laid.inks), laid.printed, printer,
                    sheet_of(dip.config, dip.made.dipped.posed, report), context, inside);
  write_report_json(folder.path(inside + "report.json"), report);
}

void write_bytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  write_file(path, bytes.data(), bytes.size());
}

// What took how long, until now.
void add_times(Report& report, const Timings& times) {
  report.total_seconds = times.total_s();
  report.stages.clear();
  for (const Timing& time : times.list()) report.stages.push_back({time.what, time.seconds});
}

}  // namespace

bool asks_for_several_dips(const JobConfig& config) {
  return config.plan.dips > 1 || !config.dips.empty();
}

void require_one_dip(const JobConfig& config, const std::string& why) {
  if (asks_for_several_dips(config))
    throw InputError(fmt::format("{}: this job is of several dips ({}): {}", config.model.string(),
                                 config.dips.empty() ? "plan.dips" : "[[dip]] tables", why));
}

JobResult print_dips(const JobConfig& config, const RunContext& context) {
  const RunScope scope(context.with_threads(config.threads));
  require_no_correction(config);
  OutputFolder folder(config.output, config.earlier_result);
  Timings times;
  const PreparedObject prepared = times.measure("load", [&] {
    return prepare_object(config.model, config.object, context, config.design.dpi,
                          config.design.inverse.samples_per_axis);
  });
  require_size(prepared.posed, config.object, config.model);
  require_appearance(prepared, config.model);
  require_no_pattern(*prepared.paint);
  require_memory(config.design, inkable_mm2(prepared, config.design));
  warn_if_draft(config.design, context);
  const Printer printer = make_printer(config.printer);
  const std::vector<ReportInput> inputs = describe_inputs(config, prepared, printer);

  const DipPlan plan = times.measure("plan", [&] {
    const Targets targets = job_targets(config, prepared, context);
    return plan_dips(config, prepared, targets, false, context);
  });
  MadeDips all = hang_up(config, prepared, plan, context);
  std::vector<std::filesystem::path> input_files;
  input_files.reserve(inputs.size());
  for (const ReportInput& input : inputs) input_files.emplace_back(input.path);
  folder.announce(file_names(all), input_files);
  folder.supersede(sheets_of_other_prints(all.dips.size()));

  const SharedSurface shared = divide(all, printer, times, context);
  const Finish finish = make_dips(all, shared, printer, times, context);
  require_some_ink(all);
  warn_of(dry_layers_of(all), context);
  times.measure("sheet", [&] {
    const Object painted =
        painted_object(prepared.posed.mesh(), *prepared.paint,
                       {.most_px = config.preview_texture_px, .finest = kFinestTexels_per_mm});
    for (MadeDip& dip : all.dips)
      write_dip(folder, dip, all, painted, inputs, printer, times, context);
  });
  const FinishCheck check =
      times.measure("check", [&] { return FinishCheck(finish, shared, context); });
  Report report = report_on(all, shared, check,
                            {"print", config, prepared, inputs, finish, times, context,
                             &all.dips.front().made.ink, printer.model->name()});
  ReportPictures pictures;
  if (config.pictures) {
    DipsPictures drawn = times.measure("preview", [&] {
      return draw_dips(all, shared, finish, check,
                       headline(concern_of(findings(report))) + ": " + verdict_of(report), context);
    });
    write_bytes(folder.path("preview.png"), drawn.preview_png);
    write_bytes(folder.path("dips.png"), drawn.dips_png);
    pictures.preview_png = std::move(drawn.preview_png);
    pictures.dips_png = std::move(drawn.dips_png);
    pictures.scene = std::move(drawn.scene);
  }
  add_times(report, times);
  write_report_json(folder.path("report.json"), report);
  pictures.logo_png = logo_png(config.report.logo);
  write_report_html(folder.path("report.html"), report, pictures);
  context.check_cancelled();
  folder.commit();
  JobResult result = describe_result(report, folder.folder(), told_places(prepared.artwork));
  result.files = file_names(all);
  for (const MadeDip& dip : all.dips) result.dips.push_back(dip.folder);
  result.text = folder.told_replaced() + result.text;
  return result;
}

}  // namespace hydrodip
