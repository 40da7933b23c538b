// What the user asked for on the command line, parsed but not yet judged.
#pragma once

#include <string>
#include <vector>

#include "calibrate/calibrate.h"
#include "history/history_job.h"
#include "job/jobs.h"
#include "register/register.h"
#include "rig/jig.h"
#include "rig/rig_job.h"
#include "settings/settings.h"
#include "studio/studio.h"
#include "sweep/sweep_jobs.h"

namespace CLI {
class Validator;
class App;
}  // namespace CLI

namespace hydrodip {

struct Request {
  std::vector<std::string> command_line;  // as typed
  std::string model;
  std::string sample;
  std::string folder;
  std::string output;
  std::string film_image;
  std::string paper;   // of the run sheet
  std::string action;  // of the stage
  double jog_mm = 0;
  bool dry_run = false;
  bool yes = false;
  CalibrationRequest calibration;
  PrinterRequest printer;
  std::vector<std::string> photos;  // of `register`; the last one may be the job's folder
  bool calibrate_camera = false;
  RegisterRequest registration;
  CorrectRequest correction;
  JigOptions jig;
  StudioOptions studio;
  PatternRequest pattern;
  std::vector<std::string> jobs;  // of several parts
  std::optional<double> clearance_mm;
  std::string name;  // of a profile
  std::string file;  // to import
  std::vector<std::string> unset;
  std::string batch, label;  // of a piece
  HistoryRequest history;
  SweepPlanRequest sweep;
  std::string shard;
  SweepWork sweep_work;
  SettingSources sources;
  std::filesystem::path film_state;  // a profile, which wins over the others; may be empty
  bool quiet = false;
  bool strict = false;  // a verdict against the dip is a failure
  bool json = false;
};

// Groups of options, declared where a command has them.
void declare_model(CLI::App& app, Request& request);
void declare_output(CLI::App& app, Request& request, const std::string& default_folder);
void declare_no_clobber(CLI::App& app, Request& request);   // is part of declare_output
void declare_reporting(CLI::App& app, Request& request);    // --json, --quiet
void declare_report_page(CLI::App& app, Request& request);  // --for, --logo
void declare_object(CLI::App& app, Request& request);
void declare_artwork(CLI::App& app, Request& request);
void declare_film(CLI::App& app, Request& request);  // --film, --quality
void declare_film_state(CLI::App& app, Request& request, const std::string& help);  // --film-state
void declare_film_and_dip(CLI::App& app, Request& request);  // both, --depth, --method
void declare_strict(CLI::App& app, Request& request);        // --strict
void declare_dips(CLI::App& app, Request& request);          // --dips
void declare_ink(CLI::App& app, Request& request);
void declare_resolution(CLI::App& app, Request& request);
void declare_threads(CLI::App& app, Request& request);  // --threads
void declare_configuration(CLI::App& app,
                           Request& request);  // the same, --profile, --config, --set
void declare_film_image(CLI::App& app, Request& request);
void declare_pattern(CLI::App& app, Request& request);
void declare_nest(CLI::App& app, Request& request);
void declare_sample(CLI::App& app, Request& request);
void declare_folder(CLI::App& app, Request& request);
void declare_studio(CLI::App& app, Request& request);

// Of options that the last one given does not override: CLI11 is to take the same value twice, and
// two values are refused after parsing, by an InputError that says how to mend it.
void allow_same_value_twice(CLI::App& app);
void refuse_two_values(const CLI::App& app);

// The person's folder of profiles: $XDG_CONFIG_HOME/hydrodip/profiles, or below ~/.config.
std::filesystem::path profile_folder();
// "1,2,3" as given to an option, from least to most numbers. Throws InputError.
std::vector<double> numbers_of(const std::string& option, const std::string& text,
                               std::size_t least, std::size_t most);

// Refuses what is no number, or not within these.
CLI::Validator between(double low, double high);

// The options as a job's configuration. Throws InputError, and Cancelled: a file may be a pipe that
// nobody writes to.
JobConfig configure(const Request& request, const RunContext& context);
// The same with another model, or job's file, as one of several parts.
JobConfig configure_part(const Request& request, const std::string& model,
                         const RunContext& context);
// The job that `hydrodip print` left in a folder, with the options' settings. Throws as
// configure().
RigJob configure_printed(const Request& request, const std::string& folder,
                         const RunContext& context);

}  // namespace hydrodip
