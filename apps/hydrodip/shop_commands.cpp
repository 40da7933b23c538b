#include "shop_commands.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "base/error.h"
#include "base/run_scope.h"
#include "build_version.h"
#include "job/profile_jobs.h"
#include "rig/link.h"

namespace hydrodip {
namespace {

constexpr const char* kSweepGroup = "Sweep";

void declare_name(CLI::App& app, Request& request) {
  app.add_option("NAME", request.name, "of the profile")->type_name("");
}

void require_name(const Request& request, const std::string& command) {
  if (request.name.empty())
    throw InputError("name the profile, as in 'hydrodip profile " + command + " shop'");
}

JobResult run_profile_list(const Request&, const RunContext&) {
  return list_profiles(profile_folder());
}

void declare_profile_show(CLI::App& app, Request& request) {
  declare_name(app, request);
  declare_reporting(app, request);
}

JobResult run_profile_show(const Request& request, const RunContext&) {
  require_name(request, "show");
  return show_profile(profile_folder(), request.name);
}

void declare_profile_save(CLI::App& app, Request& request) {
  declare_name(app, request);
  app.add_option("--unset", request.unset, "a parameter that the profile is no longer to set")
      ->group("Configuration")
      ->type_name("NAME")
      ->allow_extra_args(false);
  declare_no_clobber(app, request);
  declare_reporting(app, request);
  declare_film_and_dip(app, request);
  declare_ink(app, request);
  declare_resolution(app, request);
  declare_configuration(app, request);
}

JobResult run_profile_save(const Request& request, const RunContext& context) {
  const RunScope scope(context);
  require_name(request, "save");
  const SettingSources& add = request.sources;
  if (add.quality.empty() && add.profiles.empty() && add.configs.empty() && add.options.empty() &&
      add.sets.empty() && request.unset.empty())
    throw InputError("say what the profile is to set, as in 'hydrodip profile save " +
                     request.name + " --film a3 --set film.margin_mm=12'");
  return save_profile(profile_folder(), request.name, {add, request.unset});
}

void declare_profile_import(CLI::App& app, Request& request) {
  app.add_option("FILE", request.file, "TOML file of a profile")->type_name("");
  declare_name(app, request);
  declare_reporting(app, request);
}

JobResult run_profile_import(const Request& request, const RunContext& context) {
  const RunScope scope(context);
  if (request.file.empty())
    throw InputError("name the file, as in 'hydrodip profile import a-friends.toml'");
  return import_profile(profile_folder(), request.file, request.name);
}

// "28.5" or "28.5,28". A decimal comma would make two of one, and no bath cools so much in a dip.
void take_water(RunFields& fields, const std::string& text) {
  constexpr double kMostChange_c = 10;
  const std::vector<double> c = numbers_of("--water", text, 1, 2);
  if (c.size() > 1 && std::abs(c[1] - c[0]) > kMostChange_c)
    throw InputError(fmt::format(
        "--water {}: that would be {:g} C before and {:g} C after the dip; write a temperature "
        "with a point, as in 28.5",
        text, c[0], c[1]));
  fields["water_before_c"] = fmt::format("{}", c[0]);
  if (c.size() > 1) fields["water_after_c"] = fmt::format("{}", c[1]);
}

void declare_history(CLI::App& app, Request& request) {
  constexpr const char* kRun = "A dip";
  HistoryRequest& history = request.history;
  app.add_option("JOB_DIR", request.model, "folder that 'hydrodip print' wrote")->type_name("");
  app.add_flag("--add", history.add, "a dip that was made without 'hydrodip rig guide'")
      ->group(kRun);
  app.add_option("--run", history.amend_run, "the dip that the following is about, as in rig-3")
      ->group(kRun)
      ->type_name("RUN");
  app.add_option("--remove", history.remove_run, "takes a dip away that --add told of by mistake")
      ->group(kRun)
      ->type_name("RUN");
  const auto add = [&](const char* option, const char* field, const char* type, const char* help) {
    app.add_option_function<std::string>(
           option, [&history, field](const std::string& value) { history.fields[field] = value; },
           help)
        ->group(kRun)
        ->type_name(type);
  };
  add("--outcome", "outcome", "good|failed", "what became of the piece");
  add("--batch", "batch", "NAME", "its batch; alone: shows only this batch");
  add("--label", "label", "NAME", "its label");
  app.add_option_function<std::string>(
         "--water", [&history](const std::string& text) { take_water(history.fields, text); },
         "temperature of the water before, and after")
      ->group(kRun)
      ->type_name("C[,C]");
  add("--soak", "soak_s", "S", "how long the film lay on the water");
  add("--activator", "activator_g", "G", "activator used");
  app.add_option_function<std::string>(
         "--registration",
         [&history](const std::string& text) {
           const std::vector<double> n = numbers_of("--registration", text, 2, 3);
           history.fields["registration_x_mm"] = std::to_string(n[0]);
           history.fields["registration_y_mm"] = std::to_string(n[1]);
           if (n.size() > 2) history.fields["registration_deg"] = std::to_string(n[2]);
         },
         "how far the film lay off its place: mm, and degrees")
      ->group(kRun)
      ->type_name("X,Y[,DEG]");
  add("--notes", "notes", "TEXT", "whatever is worth keeping");
  app.add_option("--settings", history.settings_run,
                 "prints the report.json that this dip was made by")
      ->group(kRun)
      ->type_name("RUN");
  declare_reporting(app, request);
  declare_configuration(app, request);
}

// --batch alone chooses what is shown.
HistoryRequest history_request(const Request& request) {
  HistoryRequest history = request.history;
  const bool changes = history.add || !history.amend_run.empty();
  if (int(history.add) + int(!history.amend_run.empty()) + int(!history.remove_run.empty()) > 1)
    throw InputError(
        "--add is a new dip, --run corrects one, --remove takes one away: give one of them");
  if (!history.remove_run.empty() && !history.fields.empty())
    throw InputError("--remove takes all of a dip away: leave out what else is said of it");
  if (changes && !history.add && history.fields.empty())
    throw InputError("--run: say what of it is to change, as in --outcome good");
  if (!changes) {
    const auto batch = history.fields.find("batch");
    if (batch != history.fields.end()) history.batch_only = batch->second;
    if (history.fields.size() > (batch != history.fields.end() ? 1U : 0U))
      throw InputError("say which dip that is about: --run RUN, or --add for a new one");
  }
  return history;
}

JobResult run_history(const Request& request, const RunContext& context) {
  if (request.model.empty())
    throw InputError("name the job's folder, as in 'hydrodip history mask-print'");
  const HistoryRequest history = history_request(request);
  return history_job(configure_printed(request, request.model, context), history, *system_clock());
}

void declare_sweep_folder(CLI::App& app, Request& request) {
  app.add_option("DIR", request.folder, "folder that 'hydrodip sweep plan' made")->type_name("");
}

void declare_sweep_plan(CLI::App& app, Request& request) {
  app.add_option("FILE", request.file, "TOML file that says what is varied; see docs/sweeps.md")
      ->type_name("");
  app.add_option("-o,--output", request.output, "folder of the sweep (default: FILE-sweep)")
      ->group("Output")
      ->type_name("DIR");
  app.add_option("--tasks", request.sweep.tasks,
                 "tasks of the scripts' arrays (default: so many that each lasts two minutes)")
      ->group(kSweepGroup)
      ->type_name("N")
      ->check(CLI::Range(1, 100000).description(""));
  app.add_flag_callback(
         "--no-trial", [&request] { request.sweep.trial = false; },
         "do not try the first run, which shows that it works and how long one takes")
      ->group(kSweepGroup);
  declare_reporting(app, request);
}

JobResult run_sweep_plan(const Request& request, const RunContext& context) {
  if (request.file.empty())
    throw InputError("name the sweep's file, as in 'hydrodip sweep plan stretch.toml -o stretch'");
  SweepPlanRequest sweep = request.sweep;
  sweep.file = request.file;
  sweep.folder = request.output.empty() ? sweep.file.stem().string() + "-sweep" : request.output;
  sweep.version = build_version();
  return sweep_plan_job(sweep, context);
}

void declare_sweep_run(CLI::App& app, Request& request) {
  declare_sweep_folder(app, request);
  app.add_option("--shard", request.shard, "the I-th of N equal parts of the runs")
      ->group(kSweepGroup)
      ->type_name("I/N");
  app.add_option("--task", request.sweep_work.id, "one run alone, by its id")
      ->group(kSweepGroup)
      ->type_name("ID");
  app.add_flag("--again", request.sweep_work.again,
               "also do runs once more that failed or that another version of the program did")
      ->group(kSweepGroup);
  declare_reporting(app, request);
  declare_threads(app, request);
}

// The place in an array of Slurm's. Empty: not in one.
std::optional<Shard> slurm_shard() {
  const auto number = [](const char* variable, int otherwise) {
    const char* text = std::getenv(variable);
    int value = otherwise;
    if (text != nullptr) std::from_chars(text, text + std::strlen(text), value);
    return value;
  };
  if (std::getenv("SLURM_ARRAY_TASK_ID") == nullptr) return {};
  const int least = number("SLURM_ARRAY_TASK_MIN", 1);
  const int step = std::max(1, number("SLURM_ARRAY_TASK_STEP", 1));
  const Shard shard{(number("SLURM_ARRAY_TASK_ID", least) - least) / step + 1,
                    number("SLURM_ARRAY_TASK_COUNT", 1)};
  return shard.number >= 1 && shard.number <= shard.of ? std::optional(shard) : std::nullopt;
}

JobResult run_sweep_run(const Request& request, const RunContext& context) {
  if (request.folder.empty())
    throw InputError("name the sweep's folder, as in 'hydrodip sweep run stretch'");
  SweepWork work = request.sweep_work;
  work.version = build_version();
  if (!request.shard.empty() && !work.id.empty())
    throw InputError("--task is one run, --shard a part of all: give one of them");
  if (!request.shard.empty())
    work.shard = parse_shard(request.shard);
  else if (const auto shard = slurm_shard(); shard && work.id.empty())
    work.shard = *shard;
  return sweep_run_job(request.folder, work,
                       context.with_threads(configure(request, context).threads));
}

void declare_sweep_collect(CLI::App& app, Request& request) {
  declare_sweep_folder(app, request);
  declare_reporting(app, request);
}

JobResult run_sweep_collect(const Request& request, const RunContext& context) {
  if (request.folder.empty())
    throw InputError("name the sweep's folder, as in 'hydrodip sweep collect stretch'");
  return sweep_collect_job(request.folder, context);
}

}  // namespace

std::vector<Command> shop_commands() {
  return {
      {"profile list", "the profiles that you keep, and what each sets", "", declare_reporting,
       run_profile_list},
      {"profile show", "one profile, as a file", "", declare_profile_show, run_profile_show},
      {"profile save", "make a profile, or change single values of one",
       "Values that are not named stay as they are. Use it with --profile NAME.",
       declare_profile_save, run_profile_save},
      {"profile import",
       "keep a profile that somebody else made",
       "",
       declare_profile_import,
       run_profile_import,
       {},
       "FILE [NAME]"},
      {"history", "every dip of a job: readings, outcome, what a good piece costs",
       "'hydrodip rig guide' keeps what it asks; the rest can be told later:\n"
       "  hydrodip history mask-print --run rig-3 --outcome failed --notes 'film slid'\n"
       "Prices: cost.film_per_m2 and others, best in a profile.",
       declare_history, run_history},
      {"sweep plan", "many runs with other values each: which they are",
       "Writes DIR/sweep.json and scripts for GNU parallel and Slurm. See docs/sweeps.md.",
       declare_sweep_plan, run_sweep_plan},
      {"sweep run", "do a sweep's runs, all or a part of them",
       "Runs that are done are not done again, and several of these may work at once, also on "
       "other\n"
       "machines that see the folder. In an array of Slurm's each task takes its own part.",
       declare_sweep_run, run_sweep_run},
      {"sweep collect", "one table of a sweep's results, and pictures",
       "Writes table.csv, table.json and response.svg into DIR.", declare_sweep_collect,
       run_sweep_collect},
  };
}

}  // namespace hydrodip
