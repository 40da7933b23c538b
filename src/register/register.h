// The commands around registration: printers that print true, cameras that see where the film lies,
// and prints that are corrected by what came out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/context.h"
#include "job/jobs.h"
#include "rig/rig_job.h"
#include "settings/config.h"

namespace hydrodip {

// ---- calibrate printer ----

// Lengths on the printed test sheet, as a steel rule measures them.
struct PrinterReadings {
  double across_mm = 0, along_mm = 0;    // A to B, A to C
  double rising_mm = 0, falling_mm = 0;  // A to D, C to B
};

struct PrinterRequest {
  std::optional<PrinterReadings> readings;
  std::filesystem::path scan;  // of the test sheet; empty: none
  double scan_dpi = 0;         // 0: as the picture records it
  // The profile to change in that folder; empty: printer.toml in config.output.
  std::string profile;
  std::filesystem::path profile_folder;
};

// Without readings and scan the test sheet, printer-test.pdf, drawn without any correction; else
// what they say, as print.scale_x, print.scale_y and print.skew_deg of a profile.
JobResult printer_job(const JobConfig& config, const PrinterRequest& request,
                      const RunContext& context);

// ---- register ----

// board.pdf in config.output: strips of marks for the tank's rim, drawn so that the configuration's
// printer prints them true. `paper`: a4 or letter; empty: a4.
JobResult board_job(const JobConfig& config, const std::string& paper, const RunContext& context);

struct CameraRequest {
  std::vector<std::filesystem::path> photos;
  std::filesystem::path file;  // to write
  // How far the water stands below the strips; else as `file` said before, or 0.
  std::optional<double> water_below_mm;
};
// camera.json from photos of the board on the tank's rim.
JobResult calibrate_camera_job(const CameraRequest& request, const RunContext& context);

struct RegisterRequest {
  std::filesystem::path photo;
  std::filesystem::path camera;          // empty: find_camera()
  std::optional<double> water_below_mm;  // else the camera's
  double water_sigma_mm = 0.3;
  double tolerance_mm = 1;
  bool set_place = false;  // this is where film is to lie: changes the camera's file
};
// Where the film lies: registration.json and registration.png in the job's folder.
JobResult register_job(const RigJob& job, const RegisterRequest& request,
                       const RunContext& context);

// ---- correct ----

struct CorrectRequest {
  std::vector<std::filesystem::path> scans;
  std::string scan_units;  // as ScanOptions::units
  std::string board;       // tints or black; empty: whichever fits clearly better
  double square_mm = 0;    // 0: the board's own
  bool aligned = false;
};
// correction.json and correction.png in the job's folder.
JobResult correct_job(const RigJob& job, const CorrectRequest& request, const RunContext& context);

}  // namespace hydrodip
