// One scan with the object that was scanned: what simulations are compared with.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/checkerboard_dip.h"
#include "scan/grid_error.h"
#include "scan/read_scan.h"
#include "scan/registration.h"

namespace hydrodip {

// How scans are to be read and compared.
struct ScanSettings {
  ScanOptions file;      // unit, square, mirrored
  bool aligned = false;  // the scan is in the posed-object frame already
};

struct Subject {
  std::string name;  // of the object; numbered where two scans show the same
  std::filesystem::path file;
  CalibrationObject object;
  std::unique_ptr<Surface> surface;
  Scan scan;
  std::vector<GridLength> lengths;
  std::optional<GridMatch> match;  // of a scan that is not aligned
  std::string fingerprint;         // of all that a simulated comparison depends on but parameters
};

// The scans' files.
std::vector<std::filesystem::path> files_of(const std::vector<Subject>& subjects);

// A scan compared with one simulated dip.
struct Comparison {
  WarpedGrid warped;
  Alignment alignment;
};
Comparison compare(const Subject& subject, const CheckerboardDip& dip);

// Per length of the subject, its error on the film, mm; NaN where the comparison has none.
std::vector<double> errors_by_length(const Subject& subject,
                                     const std::optional<WarpedGrid>& warped, double square_mm);

// How the lengths change with the scan's corners: a row per length, three columns per corner.
Eigen::MatrixXd noise_gradient_of(const Subject& subject, const CheckerboardDip& dip,
                                  const Comparison& comparison);

// "sphere=scan.obj", "ellipsoid@11=scan.csv", "part.stl@20=scan.ply", or a scan's name that holds a
// kit shape's name. Reads the scans and finds how they lie, with one coarse simulated dip each.
// Throws InputError; warns about scans that fit badly.
std::vector<Subject> load_subjects(const std::vector<std::string>& texts,
                                   const ScanSettings& settings, const JobConfig& config,
                                   const RunContext& context);

// Whether any of them was computed, not scanned.
bool any_synthetic(const std::vector<Subject>& subjects);

}  // namespace hydrodip
