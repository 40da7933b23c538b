// The commands around calibration: hydrodip calibrate kit, synth, and calibrate itself; measure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/context.h"
#include "calibrate/measured_dip.h"
#include "job/jobs.h"
#include "settings/config.h"

namespace hydrodip {

// What the commands ask beside the configuration.
struct CalibrationRequest {
  std::vector<std::string> scans;  // "sphere=scan.obj", or of synth and kit: "sphere"
  std::string board;               // which board was printed, as board_named() has it
  double square_mm = 0;            // 0: as the board is
  std::string scan_units;          // as ScanOptions::units
  bool aligned = false;
  bool mirrored = false;

  // calibrate: the grid, "FROM:TO:STEP", "FROM:TO:xFACTOR", "A,B,C" or one value
  std::string z_stretch = "0.4,0.55,0.7,0.85";
  std::string stiffness_ratio = "3:3072:x8";
  std::string poisson = "0:0.4:0.2";
  // calibrate: of each dip of the kit's dome, the innermost ring on which film is torn
  std::vector<int> torn_rings;

  std::string shard;                // "1/4"; empty: everything
  std::vector<std::string> merged;  // folders or stores of other shards

  // kit: a scan's noise, for which to say how well the parameters will be known; 0: do not
  double expected_noise_mm = 0;

  // pack
  DipFacts facts;

  // synth
  double noise_mm = 0;
  double missing_share = 0;
  std::uint64_t seed = 1;
};

// The values that a range names, ascending. Throws InputError naming `option`.
std::vector<double> parse_range(const std::string& text, const std::string& option, double least,
                                double most);

// Fits the film's parameters: profile.toml, calibration.json, error-surface.csv and
// error-surface.png in config.output, with simulations.jsonl, from which an interrupted calibration
// goes on. With a shard only the latter. Throws InputError, DipError, Cancelled.
JobResult calibrate_job(const JobConfig& config, const CalibrationRequest& request,
                        const RunContext& context);

// Eq. 4 for each scan and each method (full, single-step, projection) with the configuration's
// parameters. Writes error-map.png and measure.json only if config.output is given.
JobResult measure_job(const JobConfig& config, const CalibrationRequest& request,
                      const RunContext& context);

// Scans from known parameters: NAME-scan.obj and .csv for each object, truth.toml.
JobResult synth_job(const JobConfig& config, const CalibrationRequest& request,
                    const RunContext& context);

// One dip with its scan and what its owner tells of it, for others to compute against:
// SHAPE-dip.zip. Throws InputError for what nobody could use.
JobResult pack_job(const JobConfig& config, const CalibrationRequest& request,
                   const RunContext& context);

// What a calibration needs: the shapes as STL, the film's PDF, instructions.
JobResult kit_job(const JobConfig& config, const CalibrationRequest& request,
                  const RunContext& context);

}  // namespace hydrodip
