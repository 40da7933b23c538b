#include "rig_commands.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>

#include "base/error.h"
#include "rig/rig.h"
#include "terminal_operator.h"

namespace hydrodip {
namespace {

void declare_job(CLI::App& app, Request& request) {
  app.add_option("JOB_DIR", request.model, "folder that 'hydrodip print' wrote")->type_name("");
}

void declare_port(CLI::App& app, Request& request) {
  app.add_option_function<std::string>(
         "--port",
         [&request](const std::string& port) {
           request.sources.options.push_back(
               {"stage.port", port, false, "'" + port + "'", "--port"});
         },
         "serial port of the stage, as in /dev/ttyUSB0")
      ->group("Stage")
      ->type_name("PORT");
}

void declare_piece(CLI::App& app, Request& request) {
  app.add_option("--batch", request.batch, "that the piece belongs to")
      ->group("Piece")
      ->type_name("NAME");
  app.add_option("--label", request.label, "of the piece, as in 7 or A-12")
      ->group("Piece")
      ->type_name("NAME");
}

RigJob load_job(const Request& request, const std::string& command, const RunContext& context) {
  if (request.model.empty())
    throw InputError("name the job's folder, as in 'hydrodip " + command + " mask-print'");
  RigJob job = configure_printed(request, request.model, context);
  job.batch = request.batch;
  job.label = request.label;
  return job;
}

void declare_sheet(CLI::App& app, Request& request) {
  declare_job(app, request);
  app.add_option("-o,--output", request.output, "PDF to write (default: JOB_DIR/run-sheet.pdf)")
      ->group("Output")
      ->type_name("FILE.pdf");
  app.add_option("--paper", request.paper, "default: letter for letter film, else a4")
      ->group("Output")
      ->type_name("a4|letter");
  declare_piece(app, request);
  declare_reporting(app, request);
  declare_configuration(app, request);
}

JobResult run_sheet(const Request& request, const RunContext& context) {
  return rig_sheet(load_job(request, "rig sheet", context), request.paper, request.output, context);
}

// The real bench: this computer's clock, ports and terminal.
struct RealBench {
  explicit RealBench(const Request& request, const RunContext& context)
      : clock(system_clock()), person(*clock, context) {
    bench.yes_given = request.yes;
  }

  std::unique_ptr<Clock> clock;
  TerminalOperator person;
  Bench bench{person, *clock, [this](const StageOptions& stage) {
                return open_serial(stage.port, stage.baud, *clock);
              }};
};

void declare_guide(CLI::App& app, Request& request) {
  declare_job(app, request);
  declare_piece(app, request);
  declare_port(app, request);
  declare_reporting(app, request);
  declare_configuration(app, request);
}

JobResult run_guide(const Request& request, const RunContext& context) {
  const RigJob job = load_job(request, "rig guide", context);
  RealBench real(request, context);
  return rig_guide(job, real.bench, context);
}

void declare_jig(CLI::App& app, Request& request) {
  declare_job(app, request);
  declare_output(app, request, "JOB_DIR/jig");
  app.add_option_function<std::string>(
         "--bed",
         [&request](const std::string& text) {
           const std::vector<double> mm = numbers_of("--bed", text, 3, 3);
           constexpr double kLeast_mm = 50;
           if (!(*std::min_element(mm.begin(), mm.end()) >= kLeast_mm))
             throw InputError(fmt::format(
                 "--bed: give the printer's bed and height in mm, {:g} or more each, not '{}'",
                 kLeast_mm, text));
           request.jig.bed_mm = {mm[0], mm[1], mm[2]};
         },
         "of the 3D printer (default: 220,220,250)")
      ->group("Jig")
      ->type_name("X,Y,Z");
  app.add_option("--clearance", request.jig.clearance_mm,
                 "between parts, and between object and socket (default: 0.3)")
      ->group("Jig")
      ->type_name("MM")
      ->check(between(0.0, 3.0));
  declare_reporting(app, request);
  declare_configuration(app, request);
}

JobResult run_jig(const Request& request, const RunContext& context) {
  const RigJob job = load_job(request, "rig jig", context);
  return jig_job(
      job, request.jig,
      request.output.empty() ? job.folder / "jig" : std::filesystem::path(request.output), context);
}

void declare_stage(CLI::App& app, Request& request) {
  app.add_option("ACTION", request.action, "find, status, home, jog, approach, dip or retract")
      ->type_name("");
  declare_job(app, request);
  declare_port(app, request);
  app.add_option("--by", request.jog_mm, "of jog: how far down; negative lifts")
      ->check(between(-2000, 2000))
      ->group("Stage")
      ->type_name("MM");
  app.add_flag("--dry-run", request.dry_run, "print the plan of movements and move nothing")
      ->group("Stage");
  app.add_flag("--yes", request.yes, "do not ask before moving: nobody is near")->group("Stage");
  declare_reporting(app, request);
  declare_configuration(app, request);
}

JobResult run_stage(const Request& request, const RunContext& context) {
  if (request.action.empty())
    throw InputError(
        "name what the stage is to do: find, status, home, jog, approach, dip or retract");
  std::optional<RigJob> job;
  if (!request.model.empty()) job = configure_printed(request, request.model, context);
  const StageOptions stage = job ? job->config.stage : configure(request, context).stage;
  if (request.action == "jog" && request.jog_mm == 0)
    throw InputError("rig stage jog: say how far with --by, as in --by 10 (down) or --by -10 (up)");
  if (request.action != "jog" && request.jog_mm != 0)
    throw InputError(fmt::format("rig stage {}: --by says how far a jog goes; leave it out, or jog",
                                 request.action));
  RealBench real(request, context);
  return rig_stage({request.action, request.jog_mm, request.dry_run}, job ? &*job : nullptr, stage,
                   real.bench, context);
}

}  // namespace

std::vector<Command> rig_commands() {
  return {
      {"rig sheet", "a run sheet for the wet bench: pose, film, figures, boxes to tick",
       "Figures come from the job's report.json; --profile and --set change process.* values.",
       declare_sheet, run_sheet},
      {"rig guide", "lead through a dip step by step, with countdowns, log and stage",
       "Without --port the object is dipped by hand. Writes JOB_DIR/rig-N. Ctrl-C stops the stage\n"
       "softly, a second one at once.",
       declare_guide, run_guide},
      {"rig jig", "frame and mount to 3D-print: they hold film and object where they belong",
       "Writes mount.stl, bar.stl, frame.stl (or frame-1.stl to frame-4.stl, where the bed is "
       "small)\n"
       "and jig.png. See docs/registration.md.",
       declare_jig, run_jig},
      {"rig stage",
       "drive a Zaber stage or a Marlin printer's Z axis",
       "find      what answers on the serial ports\n"
       "status    where the stage is\n"
       "home      move to its home\n"
       "jog       move by --by MM\n"
       "approach  find the water level by hand and keep it for the job\n"
       "dip       approach, dip by the job's depth, dwell\n"
       "retract   lift the object out\n"
       "Nothing moves before a yes. Ctrl-C stops softly, a second one at once. See docs/rig.md.",
       declare_stage,
       run_stage,
       {"find", "status", "home", "jog", "approach", "dip", "retract"},
       "ACTION [JOB_DIR]"},
  };
}

}  // namespace hydrodip
