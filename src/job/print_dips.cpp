#include "job/print_dips.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
#include "job/sheet_of.h"
#include "object/bake.h"
#include "report/findings.h"
#include "session/sheet_files.h"

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

// The planned dips, hung up.
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

// The surface divided by the films as they lie without ink.
SharedSurface divide(const MadeDips& all, const RunContext& context) {
  std::vector<std::vector<float>> worth;
  for (const MadeDip& dip : all.dips) worth.push_back(worth_at_nodes(all, dip, *dip.trial.film));
  const Object& object = all.prepared.posed.object();
  const Surface surface(object.positions, object.triangles);
  return {{all.nodes, std::move(worth), *all.prepared.paint, surface, all.prepared.posed.scale(),
           all.config.plan.overlap_mm},
          context};
}

void require_some_ink(const MadeDips& all) {
  const bool any = std::any_of(all.dips.begin(), all.dips.end(), [](const MadeDip& dip) {
    const auto& laid = dip.made.ink.ink.inking.inks.cmyk;
    return std::any_of(laid.begin(), laid.end(), [](std::uint8_t value) { return value != 0; });
  });
  if (!any)
    throw InputError(fmt::format(
        "{}: all sheets would be blank: what the films reach of the model is white, transparent or "
        "of the object's own colour; check its texture and colours",
        all.config.model.string()));
}

// Each dip with its part of the ink, and what comes of all of them.
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
  require_some_ink(all);
  return finish(all.prepared.paint, designs, printer);
}

// What the wet bench needs of one dip.
void write_dip(OutputFolder& folder, const MadeDip& dip, const MadeDips& all,
               const std::vector<ReportInput>& inputs, const Printer& printer, const Timings& times,
               const RunContext& context) {
  const std::string inside = dip.folder + "/";
  write_sheet_files(folder, dip.made.ink.ink, printer, sheet_of(dip.config), context, inside);
  write_film_ply(folder.path(inside + "film.ply"), *dip.made.dipped.film);
  const PosedObject& posed = dip.made.dipped.posed;
  const int texture_px = dip.config.preview_texture_px;
  const Object looks = painted_object(posed.mesh(), *all.prepared.paint);
  write_preview_glb(folder.path(inside + "preview.glb"), looks, posed.surface(),
                    *dip.made.dipped.film, shrink_to(dip.made.ink.ink.on_object, 2 * texture_px),
                    dip.made.raster.width_mm, dip.made.raster.height_mm, all.prepared.paint->base(),
                    texture_px);
  const Finish alone(all.prepared.paint,
                     {{dip.made.dipped, dip.made.raster,
                       std::make_shared<const Image>(dip.made.ink.ink.on_object)}});
  const JobRecord record{"print", dip.config,    all.prepared,         inputs, alone, times,
                         context, &dip.made.ink, printer.model->name()};
  Report report = make_report(record);
  report.warnings.clear();
  report.dip_number = dip.number;
  report.dip_of = int(all.dips.size());
  write_report_json(folder.path(inside + "report.json"), report);
}

void write_bytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  write_file(path, bytes.data(), bytes.size());
}

Report report_on(const MadeDips& all, const SharedSurface& shared, const FinishCheck& check,
                 const JobRecord& record) {
  Report report = make_report(record);
  report.coverage = coverage_together(all);
  report.angles.reset();
  report.figures.clear();
  report.rounds.clear();
  report.dips = report_dips(all, shared);
  report.verdict = several_dips_verdict(*report.coverage, all.dips.size());
  report.colors = check.colors();
  report.seams = ReportSeams{shared.seam_mm(), all.config.plan.overlap_mm, check.seam_error(),
                             FinishCheck::kOff_mm, check.seam_error_off()};
  report.outputs = outputs_of(all);
  return report;
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

JobResult print_dips(const JobConfig& config, const RunContext& context) {
  const RunScope scope(context.with_threads(config.threads));
  require_memory(config.design);
  OutputFolder folder(config.output, config.earlier_result);
  Timings times;
  const PreparedObject prepared = times.measure("load", [&] {
    return prepare_object(config.model, config.object, context, config.design.dpi,
                          config.design.inverse.samples_per_axis);
  });
  require_size(prepared.posed, config.object, config.model);
  require_appearance(prepared, config.model);
  if (prepared.paint->depends_on_film())
    throw InputError(
        "artwork that is laid on the film (projection film) belongs to one dip: give it another "
        "projection, or leave out --dips and [[dip]]");
  const Printer printer = make_printer(config.printer);
  const std::vector<ReportInput> inputs = describe_inputs(config, prepared, printer);

  if (config.design.film.correction)
    throw InputError(
        "film.correction: a correction is of one dip, and this job has several; leave it out");
  const DipPlan plan = times.measure("plan", [&] {
    const Targets targets = job_targets(config, prepared, context);
    return plan_dips(config, prepared, targets, false, context);
  });
  MadeDips all = hang_up(config, prepared, plan, context);
  std::vector<std::filesystem::path> input_files;
  for (const ReportInput& input : inputs) input_files.emplace_back(input.path);
  folder.announce(file_names(all), input_files);

  const SharedSurface shared = times.measure("seams", [&] { return divide(all, context); });
  const Finish finish = make_dips(all, shared, printer, times, context);
  times.measure("sheet", [&] {
    for (const MadeDip& dip : all.dips)
      write_dip(folder, dip, all, inputs, printer, times, context);
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
                       headline(concern_of(findings(report))) + ": " + report.verdict, context);
    });
    write_bytes(folder.path("preview.png"), drawn.preview_png);
    write_bytes(folder.path("dips.png"), drawn.dips_png);
    pictures.preview_png = std::move(drawn.preview_png);
    pictures.dips_png = std::move(drawn.dips_png);
    pictures.scene = std::move(drawn.scene);
  }
  add_times(report, times);
  write_report_json(folder.path("report.json"), report);
  write_report_html(folder.path("report.html"), report, pictures);
  context.check_cancelled();
  folder.commit();
  JobResult result = describe_result(report, folder.folder());
  result.files = file_names(all);
  for (const MadeDip& dip : all.dips) result.dips.push_back(dip.folder);
  if (folder.replaced_earlier()) result.text = "replaced the earlier result there\n" + result.text;
  return result;
}

}  // namespace hydrodip
