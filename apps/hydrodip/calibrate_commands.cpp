#include "calibrate_commands.h"

#include <CLI/CLI.hpp>

#include "base/error.h"
#include "calibrate/checkerboard_dip.h"

namespace hydrodip {
namespace {

constexpr const char* kScanGroup = "Scans";
constexpr const char* kSearchGroup = "Search";

void declare_scans(CLI::App& app, Request& request) {
  app.add_option(
         "OBJECT=SCAN", request.calibration.scans,
         "sphere-90, pyramid-90, ellipsoid-135 (the kit's), sphere, pyramid, ellipsoid (the "
         "samples) or a model file, with @DEPTH in mm if it was dipped "
         "deeper or less than the kit says; quad mesh (OBJ, PLY) or table (CSV). Or a dip that "
         "'calibrate pack' made (ZIP)")
      ->type_name("");
}

void declare_objects(CLI::App& app, Request& request) {
  app.add_option("OBJECT", request.calibration.scans,
                 "the shapes of 'calibrate', or a model file, with @DEPTH in mm (default: the "
                 "kit's three)")
      ->type_name("");
}

void declare_square(CLI::App& app, Request& request) {
  app.add_option("--square", request.calibration.square_mm,
                 "side of the board's squares (default: as the board's)")
      ->group(kScanGroup)
      ->type_name("MM");
  app.add_option("--board", request.calibration.board,
                 "which board was printed (default: tints, which the kit prints; black: black and "
                 "blank squares in turn)")
      ->group(kScanGroup)
      ->type_name("tints|black");
}

// Of the dips whose scans these are.
void declare_dipped_film(CLI::App& app, Request& request) {
  declare_film(app, request);
  declare_film_state(app, request,
                     "the dips' film had swollen as this registration.json, or profile, says");
}

void declare_scan_reading(CLI::App& app, Request& request) {
  declare_square(app, request);
  app.add_option("--scan-units", request.calibration.scan_units,
                 "unit of the scans (default: what the format says, as glTF's metres, else mm)")
      ->group(kScanGroup)
      ->type_name("mm|cm|m|in");
  app.add_flag("--aligned", request.calibration.aligned,
               "the scans are in the posed object's frame: do not register them")
      ->group(kScanGroup);
  app.add_flag("--mirrored", request.calibration.mirrored,
               "the scans are mirror images: turn them back")
      ->group(kScanGroup);
}

void declare_calibrate(CLI::App& app, Request& request) {
  declare_scans(app, request);
  declare_output(app, request, "calibration");
  declare_reporting(app, request);
  declare_scan_reading(app, request);
  CalibrationRequest& wanted = request.calibration;
  const auto add_range = [&](const char* option, std::string& range, const char* help) {
    app.add_option(option, range, help)->group(kSearchGroup)->type_name("RANGE");
  };
  add_range("--z-stretch", wanted.z_stretch, "values to try (default: 0.4,0.55,0.7,0.85)");
  add_range("--ratio", wanted.stiffness_ratio,
            "of material.ink_stiffness_ratio (default: 3:3072:x8)");
  add_range("--poisson", wanted.poisson, "values to try (default: 0:0.4:0.2)");
  app.add_option("--shard", wanted.shard, "only this part of the grid, as in 2/4, and no result")
      ->group(kSearchGroup)
      ->type_name("I/N");
  app.add_option("--merge", wanted.merged, "folder of a shard whose simulations to use; repeatable")
      ->group(kSearchGroup)
      ->type_name("DIR")
      ->allow_extra_args(false);
  app.add_option("--torn-ring", wanted.torn_rings,
                 "innermost ring of the kit's dome on which film is torn, of one dip; repeatable: "
                 "fits material.tear_stretch as well")
      ->group(kScanGroup)
      ->type_name("N")
      ->allow_extra_args(false);
  declare_dipped_film(app, request);
  declare_configuration(app, request);
}

void check_square(const Request& request) {
  const double square_mm = request.calibration.square_mm;
  if (square_mm != 0 && !(square_mm >= 0.5 && square_mm <= 100))
    throw InputError("--square: give the side of a square in mm, from 0.5 to 100");
}

void require_scans(const Request& request, const std::string& command) {
  if (request.calibration.scans.empty())
    throw InputError("name object and scan, as in 'hydrodip " + command + " sphere-90=scan.obj'");
  check_square(request);
}

JobConfig configure_writing_to(const Request& request, const char* default_folder,
                               const RunContext& context) {
  JobConfig config = configure(request, context);
  if (config.output.empty()) config.output = default_folder;
  return config;
}

JobResult run_calibrate(const Request& request, const RunContext& context) {
  require_scans(request, "calibrate");
  return calibrate_job(configure_writing_to(request, "calibration", context), request.calibration,
                       context);
}

void declare_measure(CLI::App& app, Request& request) {
  declare_scans(app, request);
  declare_output(app, request, "none, nothing is written");
  declare_reporting(app, request);
  declare_scan_reading(app, request);
  declare_dipped_film(app, request);
  declare_configuration(app, request);
}

JobResult run_measure(const Request& request, const RunContext& context) {
  require_scans(request, "measure");
  return measure_job(configure(request, context), request.calibration, context);
}

// The kit's three unless some are named.
CalibrationRequest with_objects(const Request& request) {
  check_square(request);
  CalibrationRequest wanted = request.calibration;
  if (wanted.scans.empty())
    for (const KitShape& shape : kit_shapes()) wanted.scans.emplace_back(shape.name);
  return wanted;
}

void declare_synth(CLI::App& app, Request& request) {
  declare_objects(app, request);
  declare_output(app, request, "synthetic-scans");
  declare_reporting(app, request);
  declare_square(app, request);
  CalibrationRequest& wanted = request.calibration;
  const auto add = [&](const char* option, auto& value, const char* type, const char* help) {
    app.add_option(option, value, help)->group(kScanGroup)->type_name(type);
  };
  add("--noise", wanted.noise_mm, "MM", "standard deviation of every coordinate (default: 0)");
  add("--missing", wanted.missing_share, "SHARE",
      "of the corners, left out at random (default: 0)");
  add("--seed", wanted.seed, "N", "of noise, gaps and pose (default: 1)");
  app.add_flag("--aligned", wanted.aligned, "in the posed object's frame instead of a random pose")
      ->group(kScanGroup);
  declare_dipped_film(app, request);
  declare_configuration(app, request);
}

void declare_pack(CLI::App& app, Request& request) {
  constexpr const char* kFactsGroup = "How it was made";
  declare_scans(app, request);
  declare_output(app, request, "measured-dip");
  declare_reporting(app, request);
  declare_scan_reading(app, request);
  DipFacts& facts = request.calibration.facts;
  const auto add = [&](const char* option, auto& value, const char* type, const char* help) {
    app.add_option(option, value, help)->group(kFactsGroup)->type_name(type);
  };
  add("--film-product", facts.film, "TEXT", "which film: maker and product");
  add("--printer", facts.printer, "TEXT", "which printer");
  add("--ink", facts.ink, "TEXT", "which ink");
  add("--activator", facts.activator, "TEXT", "which activator");
  add("--activator-g", facts.activator_g, "G", "how much of it was sprayed");
  add("--water-c", facts.water_c, "C", "the water's temperature");
  add("--soak-s", facts.soak_s, "S", "from laying the film to spraying");
  add("--wait-s", facts.wait_s, "S", "from spraying to dipping");
  add("--speed", facts.speed_mm_per_min, "MM_PER_MIN", "of the dip");
  add("--dipped-on", facts.dipped_on, "DATE", "when, as 2026-11-27");
  add("--notes", facts.notes, "TEXT", "what else is to be known");
  add("--owner", facts.owner, "TEXT", "whose measurement it is, to be named by who uses it");
  add("--licence", facts.licence, "SPDX", "under which it may be used, as CC-BY-4.0 or CC0-1.0");
  declare_dipped_film(app, request);
  declare_configuration(app, request);
}

JobResult run_pack(const Request& request, const RunContext& context) {
  require_scans(request, "calibrate pack");
  return pack_job(configure_writing_to(request, "measured-dip", context), request.calibration,
                  context);
}

JobResult run_synth(const Request& request, const RunContext& context) {
  const CalibrationRequest wanted = with_objects(request);
  return synth_job(configure_writing_to(request, "synthetic-scans", context), wanted, context);
}

void declare_kit(CLI::App& app, Request& request) {
  declare_output(app, request, "calibration-kit");
  declare_reporting(app, request);
  declare_square(app, request);
  app.add_option(
         "--expect", request.calibration.expected_noise_mm,
         "also say how well scans with this noise will determine the parameters, for ratios "
         "from 3 to 3000")
      ->group(kScanGroup)
      ->type_name("MM");
  declare_film(app, request);
  declare_configuration(app, request);
}

JobResult run_kit(const Request& request, const RunContext& context) {
  const CalibrationRequest wanted = with_objects(request);
  return kit_job(configure_writing_to(request, "calibration-kit", context), wanted, context);
}

}  // namespace

std::vector<Command> calibrate_commands() {
  return {
      {"calibrate", "fit z_stretch, ink stiffness and Poisson's ratio to scanned dips",
       "Writes profile.toml (for --profile), calibration.json, error-surface.csv, "
       "error-surface.png\n"
       "and joint-regions.png. Started again, an interrupted calibration goes on where it was.\n"
       "A RANGE is FROM:TO:STEP, FROM:TO:xFACTOR, values with commas, or one value that is known.\n"
       "The grid is searched on a film of a quarter of the triangles and twice the step, the "
       "answer\n"
       "found on the film that is asked for and corrected by a finer one. See also 'calibrate "
       "kit'\n"
       "and 'calibrate synth', and docs/calibration.md.",
       declare_calibrate, run_calibrate},
      {"calibrate kit", "what a calibration needs: shapes to print, film, instructions",
       "Writes sphere-90.stl, pyramid-90.stl, ellipsoid-135.stl, dome.stl, checkerboard.pdf and "
       "tear-film.pdf\n"
       "(print them at 100 %) and instructions.pdf.",
       declare_kit, run_kit},
      {"calibrate pack", "one measured dip as a file that others can compute against",
       "Writes SHAPE-dip.zip: the scan with its board, sheet, depth and all that is told of how "
       "the\n"
       "dip was made. 'measure' and 'calibrate' take such files in place of OBJECT=SCAN.\n"
       "docs/measured-dips.md says why, and what is in it.",
       declare_pack, run_pack},
      {"calibrate synth",
       "scans computed from known parameters, to try calibrations on",
       "Writes OBJECT-scan.obj, OBJECT-scan.csv and truth.toml. They are computed on sixteen "
       "times the\n"
       "triangles and a quarter of the step. Truth: --set material.z_stretch=0.65 and so on.",
       declare_synth,
       run_synth,
       {},
       "[OBJECT...]"},
      {"measure", "the error of a simulated dip against a scan, Eq. 4 of the paper",
       "For the full method and for the baselines single-step and projection. With -o it writes\n"
       "error-map.png and measure.json.",
       declare_measure, run_measure},
  };
}

}  // namespace hydrodip
