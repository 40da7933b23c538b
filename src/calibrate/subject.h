// One scan with the object that was scanned: what simulations are compared with.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/fit.h"
#include "calibrate/landings.h"
#include "scan/grid_error.h"
#include "scan/read_scan.h"
#include "scan/registration.h"

namespace hydrodip {

struct CalibrationRequest;

// How scans are to be read and compared.
struct ScanSettings {
  ScanOptions file;      // unit, square (the board's), mirrored
  Board board;           // what was printed
  bool aligned = false;  // the scan is in the posed-object frame already
};

// The same for a request, with the configuration: measured dips among its scans say themselves
// which board and which sheet were dipped. Throws InputError if they do not agree.
struct ScanSetup {
  JobConfig config;
  ScanSettings settings;
};
ScanSetup scan_setup(const JobConfig& config, const CalibrationRequest& request);

struct Subject {
  std::string name;  // of the object; numbered where two scans show the same
  std::filesystem::path file;
  CalibrationObject object;
  std::unique_ptr<Surface> surface;
  Scan scan;
  std::vector<GridLength> lengths;
  std::optional<GridMatch> match;               // of a scan that is not aligned
  std::vector<std::optional<GridPlace>> place;  // on the board, per corner, where that is known
  std::string fingerprint;  // of all that simulations depend on but parameters; not of the scan
};

// The scans' files, and those of the settings: what a result must not overwrite.
std::vector<std::filesystem::path> files_of(const std::vector<Subject>& subjects,
                                            const JobConfig& config);

// A scan compared with one simulated dip.
struct Comparison {
  WarpedGrid warped;
  Alignment alignment;
};
Comparison compare(const Subject& subject, const CheckerboardDip& dip);

// The same from where a dip lays the corners: near them, the film is carried back as it is at them.
// Corners of which the place is not known, or that do not land, have none.
WarpedGrid warped_near(const Subject& subject, const Board& board, const Landings& landings);

// Per length of the subject, its error on the film, mm; NaN where the comparison has none.
std::vector<double> errors_by_length(const Subject& subject,
                                     const std::optional<WarpedGrid>& warped, double square_mm);

// That a simulated dip lays film at most of the scan's corners: what is said of the few others
// would look the better, the less of the dip is right. Throws InputError; warns where many are left
// out.
struct CornersWithoutFilm {
  std::size_t bare = 0, of = 0;
};
void require_film_on_most(const Subject& subject, const CornersWithoutFilm& corners,
                          const RunContext& context);

// How far the scan's corners lie from where dips lay them, three rows per corner of the scan.
struct ScanMisfits {
  Misfits misfits;
  // How far the film lay off its place under the object in the first dip, mm on the film, as well
  // as that shows.
  Vec2 film_off_mm = Vec2::Zero();
};
// The scan is held as it lies best on the first of the dips. Dips that cannot be computed: NaN.
ScanMisfits misfits_of(const Subject& subject, const Board& board,
                       const std::vector<const Landings*>& dips);

// "sphere=scan.obj", "ellipsoid@11=scan.csv", "part.stl@20=scan.ply", or a scan's name that holds a
// kit shape's name. Reads the scans and finds how they lie, with one coarse simulated dip each.
// Throws InputError; warns about scans that fit badly.
std::vector<Subject> load_subjects(const std::vector<std::string>& texts,
                                   const ScanSettings& settings, const JobConfig& config,
                                   const RunContext& context);

// Whether any of them was computed, not scanned.
bool any_synthetic(const std::vector<Subject>& subjects);

}  // namespace hydrodip
