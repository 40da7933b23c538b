// Small synthetic scans for tests: quick dips.
#pragma once

#include <filesystem>
#include <string>

#include "calibrate/resolution.h"
#include "calibrate/search.h"
#include "calibrate/synthetic.h"
#include "scan/read_scan.h"

namespace hydrodip::scans {

// A small sheet and coarse triangles: hundredths of a second for a dip.
inline JobConfig quick_config() {
  JobConfig config;
  config.design.film.width_mm = config.design.film.height_mm = 110;
  config.design.film.elements = 3000;
  config.design.dip.step_mm = 0.5;
  return config;
}

inline Board board() { return tint_board(5); }
inline ScanSettings settings() { return {{}, board(), false}; }

// A dip of a kit shape on film finer than quick_config's, simulated once.
struct Truth {
  CalibrationObject object;
  Surface surface;
  CheckerboardDip dip;

  Truth(const std::string& name, const FilmParameters& parameters, const RunContext& context)
      : object(calibration_object(name, quick_config(), context)),
        surface(object.object.positions, object.object.triangles),
        dip(dip_checkerboard(checkered_film(finer_film(quick_config().design), board()), object,
                             surface, parameters, finer_film(quick_config().design).dip, context)) {
  }

  void write(const std::filesystem::path& file, const SyntheticOptions& options) const {
    write_scan_table(file, synthetic_scan(dip.landing(object), {12, 12}, options), kSyntheticMark);
  }
};

inline GridSearchOptions around(const FilmParameters& truth) {
  GridSearchOptions options;
  options.z_stretch = {truth.z_stretch - 0.12, truth.z_stretch + 0.02, truth.z_stretch + 0.16};
  options.stiffness_ratio = {truth.stiffness_ratio};
  options.poisson = {truth.poisson};
  return options;
}

}  // namespace hydrodip::scans
