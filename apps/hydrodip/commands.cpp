#include "commands.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "calibrate_commands.h"
#include "console.h"
#include "register_commands.h"
#include "rig/rig.h"
#include "rig_commands.h"
#include "samples/samples.h"
#include "settings/params.h"
#include "shop_commands.h"

namespace hydrodip {
namespace {

// With a model, named by itself or by the job's files.
JobConfig configure_job(const Request& request, const std::string& command,
                        const RunContext& context) {
  JobConfig config = configure(request, context);
  if (config.model.empty())
    throw InputError("name the model to " + command + ", as in 'hydrodip " + command +
                     " mask.obj'; 'hydrodip sample' makes one to try");
  return config;
}

// "models/spot.obj" goes to "spot-print" unless a folder is named.
std::filesystem::path output_folder(const Request& request, const JobConfig& config,
                                    const std::string& command) {
  if (!request.output.empty()) return request.output;
  const std::filesystem::path named =
      request.model.empty() ? config.model : std::filesystem::path(request.model);
  return named.stem().string() + "-" + command;
}

// One for each of several dips, beside its sheet.
void add_run_sheets(JobResult& result, const RunContext& context) {
  for (const std::string& dip : result.dips) {
    context.progress("drawing the run sheets", 0);
    const RunContext quiet = context.quiet();
    rig_sheet(load_rig_job(result.folder / dip, {}), "", {}, quiet);
    result.files.push_back(dip + "/run-sheet.pdf");
  }
  if (!result.dips.empty())
    result.text += "and a run sheet for each dip: " + result.dips.front() + "/run-sheet.pdf ...\n";
}

void declare_print(CLI::App& app, Request& request) {
  declare_model(app, request);
  declare_output(app, request, "MODEL-print");
  declare_reporting(app, request);
  declare_report_page(app, request);
  declare_strict(app, request);
  declare_object(app, request);
  declare_artwork(app, request);
  declare_film_image(app, request);
  declare_film_and_dip(app, request);
  declare_dips(app, request);
  declare_ink(app, request);
  declare_resolution(app, request);
  declare_configuration(app, request);
}

// A finished sheet leaves nothing to lay on the model.
void require_no_artwork_option(const Request& request) {
  for (const Setting& option : request.sources.options)
    if (option.name.starts_with("art."))
      throw InputError(fmt::format(
          "{} puts a picture on the model, and --film-image is the finished sheet, which "
          "is printed as it is: give one of the two",
          option.origin));
}

JobResult run_print(const Request& request, const RunContext& context) {
  JobConfig config = configure_job(request, "print", context);
  config.output = output_folder(request, config, "print");
  if (!config.film_image.empty()) {
    require_no_artwork_option(request);
    return print_film_image_job(config, context);
  }
  JobResult result = print_job(config, context);
  add_run_sheets(result, context);
  return result;
}

void declare_pattern_command(CLI::App& app, Request& request) {
  declare_model(app, request);
  declare_output(app, request, "MODEL-pattern");
  declare_reporting(app, request);
  declare_report_page(app, request);
  declare_strict(app, request);
  declare_pattern(app, request);
  declare_object(app, request);
  declare_film_and_dip(app, request);
  declare_ink(app, request);
  declare_resolution(app, request);
  declare_configuration(app, request);
}

JobResult run_pattern(const Request& request, const RunContext& context) {
  JobConfig config = configure_job(request, "pattern", context);
  if (request.pattern.tile.empty() || !(request.pattern.tile_mm > 0))
    throw InputError(
        "name the pattern and its true width, as in 'hydrodip pattern grip.stl --tile camo.png "
        "--tile-mm 80'");
  if (!(request.pattern.tile_mm >= 1 && request.pattern.tile_mm <= 3000))
    throw InputError("--tile-mm: must be a width from 1 to 3000 mm");
  config.output = output_folder(request, config, "pattern");
  return pattern_job(config, request.pattern, context);
}

void declare_nest_command(CLI::App& app, Request& request) {
  declare_nest(app, request);
  declare_output(app, request, "nest");
  declare_reporting(app, request);
  declare_strict(app, request);
  declare_film(app, request);
  declare_ink(app, request);
  declare_resolution(app, request);
  declare_configuration(app, request);
}

// Copies of one part are one part.
std::vector<NestRequest::Part> parts_of(const Request& request, const JobConfig& sheet,
                                        const RunContext& context) {
  std::vector<PartEntry> entries = sheet.parts;
  for (const std::string& job : request.jobs) {
    const auto known = std::find_if(entries.begin(), entries.end(),
                                    [&](const PartEntry& entry) { return entry.job == job; });
    if (known == entries.end())
      entries.push_back({job, 1});
    else
      ++known->count;
  }
  std::vector<NestRequest::Part> parts;
  parts.reserve(entries.size());
  for (const PartEntry& entry : entries) {
    if (entry.job.empty())
      throw InputError(
          "a [[part]] table names no job: give it job = \"FILE\", a model or a job's TOML");
    parts.push_back({configure_part(request, entry.job.string(), context), entry.count, entry.job});
  }
  return parts;
}

JobResult run_nest(const Request& request, const RunContext& context) {
  JobConfig sheet = configure(request, context);
  sheet.output = request.output.empty() ? "nest" : request.output;
  const NestRequest nest{parts_of(request, sheet, context), request.clearance_mm};
  if (nest.parts.empty())
    throw InputError(
        "name the parts to nest, as in 'hydrodip nest a.toml b.toml b.toml --film a3'");
  return nest_job(sheet, nest, context);
}

void declare_simulate(CLI::App& app, Request& request) {
  declare_model(app, request);
  declare_output(app, request, "MODEL-simulate");
  declare_reporting(app, request);
  declare_report_page(app, request);
  declare_strict(app, request);
  declare_object(app, request);
  declare_artwork(app, request);
  declare_film_image(app, request);
  declare_film_and_dip(app, request);
  declare_ink(app, request);
  declare_configuration(app, request);
}

JobResult run_simulate(const Request& request, const RunContext& context) {
  JobConfig config = configure_job(request, "simulate", context);
  config.output = output_folder(request, config, "simulate");
  return simulate_job(config, context);
}

void declare_inspect(CLI::App& app, Request& request) {
  declare_model(app, request);
  declare_output(app, request, "none, nothing is written");
  declare_reporting(app, request);
  declare_object(app, request);
  declare_film_and_dip(app, request);
  declare_configuration(app, request);
}

JobResult run_inspect(const Request& request, const RunContext& context) {
  return inspect_job(configure_job(request, "inspect", context), context);
}

void declare_orient(CLI::App& app, Request& request) {
  declare_model(app, request);
  declare_output(app, request, "MODEL-orient");
  declare_reporting(app, request);
  declare_object(app, request);
  declare_artwork(app, request);
  declare_film_and_dip(app, request);
  declare_configuration(app, request);
}

JobResult run_orient(const Request& request, const RunContext& context) {
  JobConfig config = configure_job(request, "orient", context);
  config.output = output_folder(request, config, "orient");
  return orient_job(config, context);
}

void declare_plan(CLI::App& app, Request& request) {
  declare_model(app, request);
  declare_output(app, request, "MODEL-plan");
  declare_reporting(app, request);
  declare_object(app, request);
  declare_artwork(app, request);
  declare_film_and_dip(app, request);
  declare_dips(app, request);
  declare_configuration(app, request);
}

JobResult run_plan(const Request& request, const RunContext& context) {
  JobConfig config = configure_job(request, "plan", context);
  if (config.plan.dips == 0 && config.dips.empty())
    throw InputError("say how many dips to plan, as in 'hydrodip plan " + config.model.string() +
                     " --dips 4'");
  config.output = output_folder(request, config, "plan");
  // A look in haste makes no sheets in haste: --quality is for this run, not for the plan's prints.
  Request without = request;
  without.sources.quality.clear();
  const JobConfig to_print = configure(without, context);
  return plan_job(config, context, &to_print);
}

void declare_view(CLI::App& app, Request& request) {
  declare_folder(app, request);
  declare_reporting(app, request);
}

JobResult run_view(const Request& request, const RunContext&) {
  if (request.folder.empty())
    throw InputError("name the folder to view, as in 'hydrodip view mask-print'");
  return view_job(request.folder);
}

void declare_sample_command(CLI::App& app, Request& request) {
  declare_sample(app, request);
  declare_output(app, request, "the current folder");
  declare_reporting(app, request);
}

JobResult run_sample(const Request& request, const RunContext& context) {
  if (request.sample.empty()) return list_samples();
  return sample_job(request.sample, request.output.empty() ? "." : request.output, context,
                    configure(request, context).earlier_result);
}

std::vector<std::string> sample_names() {
  std::vector<std::string> names;
  for (const SampleInfo& sample : samples()) names.push_back(sample.name);
  return names;
}

JobResult run_params(const Request&, const RunContext&) {
  JobResult result;
  result.text = parameters_table();
  result.json = parameters_json();
  return result;
}

JobResult run_studio(const Request& request, const RunContext& context) {
  StudioOptions options = request.studio;
  options.file = request.model;
  options.profiles = profile_folder();
  options.announce = [](const std::string& address) {
    print_result("the studio is at " + address + "\nCtrl-C ends it\n");
    finish_results();
  };
  return studio_job(options, context);
}

std::vector<Command> own_commands() {
  return {
      {"print", "from a textured model to a film image, ready to print and dip",
       "Writes print.pdf (print it at 100 %, no scaling), print.png, print.tif, film.ply,\n"
       "preview.png, maps.png, gamut.png, preview.glb, report.json and report.html.\n"
       "'hydrodip view DIR' opens the report.",
       declare_print, run_print},
      {"simulate", "where the film goes, and what an image on it would look like",
       "Writes film.ply, preview.png, maps.png, preview.glb, report.json and report.html.\n"
       "'hydrodip view DIR' opens the report.",
       declare_simulate, run_simulate},
      {"pattern", "pattern film on a part: where it goes, and the film image",
       "The pattern lies on the film at its true size and is stretched with it; its place is\n"
       "searched so that detail and seams stay away from stretched film and from --keep spots.\n"
       "Writes the same files as 'hydrodip print'.",
       declare_pattern_command, run_pattern},
      {"nest",
       "several parts on one sheet of film, each with the film that it needs",
       "Writes print.pdf, print.png and print.tif of the whole sheet with lines to cut along,\n"
       "nest.html (the run sheet: which part where), nest.json and a picture of each part.",
       declare_nest_command,
       run_nest,
       {},
       "[PART...]"},
      {"inspect", "size, mesh health, dip angles, what fits the film; no simulation",
       "With -o it writes angles.png and report.json.", declare_inspect, run_inspect},
      {"orient", "the best ways to hold the model and how deep to dip it, found by trial dips",
       "Prints the best few with their figures and ready commands; writes orient.json and\n"
       "orient.png. 'hydrodip print MODEL --rotate auto --depth auto' takes the best one.",
       declare_orient, run_orient},
      {"plan", "several dips: how to hold it for each, and how deep",
       "Prints what is covered after each dip; writes plan.toml, plan.json and plan.png.\n"
       "'hydrodip print plan.toml' makes a sheet for each, with seams that are hard to see.",
       declare_plan, run_plan},
      {"studio",
       "all of it in the browser: turn it, put a picture on, watch the dip, print",
       "Serves a page on this machine alone, and works without a network. What is not saved is\n"
       "kept and found again. See docs/studio.md.",
       declare_studio,
       run_studio,
       {},
       "[MODEL]"},
      {"view", "open a job's report in the browser",
       "Where there is no browser, the report's path is printed.", declare_view, run_view},
      {"sample", "write a built-in sample model with its texture", "", declare_sample_command,
       run_sample, sample_names(), "[NAME]"},
      {"params", "list every parameter: name, default, range, what it does", "", declare_reporting,
       run_params},
  };
}

}  // namespace

const std::vector<Command>& commands() {
  static const std::vector<Command> table = [] {
    std::vector<Command> all = own_commands();
    for (const auto& more :
         {calibrate_commands(), register_commands(), rig_commands(), shop_commands()})
      all.insert(all.end() - 1, more.begin(), more.end());  // params stays last
    return all;
  }();
  return table;
}

}  // namespace hydrodip
