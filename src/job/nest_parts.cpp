#include "job/nest_parts.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/timings.h"
#include "job/job_part.h"
#include "job/job_record.h"
#include "job/prepare.h"
#include "job/print_dips.h"
#include "job/wanted.h"
#include "job/ways.h"
#include "settings/params.h"

namespace hydrodip {
namespace {

// One sheet is printed and laid on the water in one way.
void require_the_sheets_own(const JobConfig& config, const JobConfig& sheet,
                            const std::string& name) {
  static const auto kOfTheSheet = std::to_array<const char*>(
      {"print.ink_side", "print.scale_x", "print.scale_y", "print.skew_deg", "print.color",
       "print.dpi", "ink.model", "ink.profile", "ink.intent", "film.swelling_x", "film.swelling_y",
       "film.margin_mm", "film.shape"});
  for (const char* of_sheet : kOfTheSheet) {
    const Parameter& p = find_parameter(of_sheet, "nest");
    const ParameterValue value = p.get(config);
    if (value == p.get(sheet) || value == p.default_value()) continue;
    throw InputError(
        fmt::format("{}: {} = {} holds for the whole sheet: give it to nest itself (--set, "
                    "--profile or --config), or take it out of the part's job",
                    name, of_sheet, show_value(p, value)));
  }
}

MadePart make_part(const NestPart& part, Timings& timings, const RunContext& context) {
  const ReadyJob& job = part.job;
  DesignedJob made = designed(job, {.wanted = false, .stretch = false}, timings, context);
  const RunContext silent = context.quiet();
  const std::vector<ReportInput> inputs;
  JobRecord record{"print", job.config,         job.prepared,
                   inputs,  made.finish,        timings,
                   silent,  &made.designed.ink, job.printer.model->name()};
  record.wanted = wanted_coverage(made.designed.dipped, *job.prepared.paint,
                                  doubtful_stretch(job.config.design.dip.material));
  for (const DryLayer& layer : dry_layers(job.prepared.artwork, made.designed.dipped)) {
    silent.warn(layer.told);  // for the report
    context.warn(layer.told);
  }
  Report report = make_report(record);
  return {std::move(made), std::move(report)};
}

// There are no options that put one on.
void require_picture(const PreparedObject& prepared, const std::filesystem::path& part,
                     const std::filesystem::path& model) {
  if (prepared.artwork.empty() && prepared.picture_problems.empty() &&
      !prepared.posed.object().has_appearance())
    throw InputError(fmt::format(
        "{}: the model has no colours, so there is nothing to print; a part's picture stands in "
        "its job file, as texture = \"IMG\" under [object] or image = \"IMG\" under [[artwork]]: "
        "{}",
        part.string(),
        part.extension() == ".toml" ? "put it there"
                                    : "write one that names the model, and nest that"));
  require_appearance(prepared, model);
}

}  // namespace

NestPart prepare_part(const NestRequest::Part& wanted, const JobConfig& sheet,
                      const Printer& printer, const RunContext& context) {
  JobConfig config = wanted.config;
  for (const std::filesystem::path& correction : {config.correction, sheet.correction})
    if (!correction.empty())
      throw InputError(fmt::format(
          "{}: a correction is of one dip on a sheet of its own, and parts that share a sheet get "
          "pieces of other sizes; leave it out, or print the part by itself",
          correction.string()));
  require_one_dip(config, "a part gets one piece of film; print it by itself");
  require_the_sheets_own(config, sheet, wanted.file.filename().string());
  config.printer = sheet.printer;
  config.design.dpi = sheet.design.dpi;
  PreparedObject prepared = prepare_object(config.model, config.object, context, config.design.dpi,
                                           config.design.inverse.samples_per_axis);
  require_picture(prepared, wanted.file, config.model);
  find_what_is_asked(config, prepared, context);
  const TriangleMesh& mesh = prepared.posed.mesh();
  Trajectory trajectory = make_trajectory(config.design.trajectory, mesh.positions);
  const Room room = room_of(mesh, trajectory);
  return {{std::move(config), std::move(prepared), std::move(trajectory), printer},
          room,
          wanted.count,
          wanted.file};
}

std::vector<MadePart> make_parts(const std::vector<NestPart>& parts, const RunContext& context) {
  std::vector<MadePart> all;
  Timings timings;
  for (const NestPart& part : parts)
    do_part(part.name(), context, [&](const RunContext& own) {
      all.push_back(make_part(part, timings, own));
      if (all.back().is_not_to_be_dipped())
        own.warn(fmt::format("do not dip it like this: {}; 'hydrodip plan' looks for ways.",
                             short_verdict(all.back().report)));
    });
  return all;
}

}  // namespace hydrodip
