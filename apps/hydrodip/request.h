// What the user asked for on the command line, parsed but not yet judged.
#pragma once

#include <string>
#include <vector>

#include "calibrate/calibrate.h"
#include "job/jobs.h"
#include "settings/settings.h"
#include "studio/studio.h"

namespace CLI {
class App;
}

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
  StudioOptions studio;
  PatternRequest pattern;
  std::vector<std::string> jobs;  // of several parts
  double clearance_mm = 0;
  SettingSources sources;
  bool quiet = false;
  bool strict = false;  // a verdict against the dip is a failure
  bool json = false;
};

// Groups of options, declared where a command has them.
void declare_model(CLI::App& app, Request& request);
void declare_output(CLI::App& app, Request& request, const std::string& default_folder);
void declare_reporting(CLI::App& app, Request& request);  // --json, --quiet
void declare_object(CLI::App& app, Request& request);
void declare_artwork(CLI::App& app, Request& request);
void declare_film(CLI::App& app, Request& request);          // --film, --quality
void declare_film_and_dip(CLI::App& app, Request& request);  // the same, --depth, --method
void declare_strict(CLI::App& app, Request& request);        // --strict
void declare_dips(CLI::App& app, Request& request);          // --dips
void declare_ink(CLI::App& app, Request& request);
void declare_resolution(CLI::App& app, Request& request);
void declare_configuration(CLI::App& app, Request& request);
void declare_film_image(CLI::App& app, Request& request);
void declare_pattern(CLI::App& app, Request& request);
void declare_nest(CLI::App& app, Request& request);
void declare_sample(CLI::App& app, Request& request);
void declare_folder(CLI::App& app, Request& request);
void declare_studio(CLI::App& app, Request& request);

// The options as a job's configuration. Throws InputError.
JobConfig configure(const Request& request);
// The same with another model, or job's file, as one of several parts.
JobConfig configure_part(const Request& request, const std::string& model);

}  // namespace hydrodip
