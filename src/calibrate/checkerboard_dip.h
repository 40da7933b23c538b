// A calibration dip: film with a printed checkerboard, an object of known shape, and the film's
// parameters to be found (paper section 4).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calibrate/board.h"
#include "object/surface.h"
#include "scan/registration.h"
#include "settings/config.h"
#include "transfer/film_map.h"

namespace hydrodip {

// What a calibration finds out about a film.
struct FilmParameters {
  double z_stretch = FilmMaterial().z_stretch;
  double stiffness_ratio = StiffnessOptions().ratio;
  double poisson = FilmMaterial().poisson;
};
FilmParameters film_parameters(const DesignOptions& design);

// What is dipped, in the posed-object frame, and how deep.
struct CalibrationObject {
  std::string name;
  TriangleMesh object;
  double depth_mm = 0;
};

// The shapes of the kit.
struct KitShape {
  const char* name;  // of the sample
  double depth_mm;   // where its slope gets to what films bear
};
const std::vector<KitShape>& kit_shapes();

// "sphere", "ellipsoid@11" (depth in mm) or a model file with its depth. Throws InputError.
CalibrationObject calibration_object(const std::string& text, const JobConfig& config,
                                     const RunContext& context);

// Everything about a film that its parameters leave alone. Immutable.
struct CheckeredFilm {
  SharedFilmMesh mesh;
  std::vector<double> ink_density;  // per triangle, after the stiffness filter
  Board board;
};
CheckeredFilm checkered_film(const DesignOptions& design, const Board& board);

// One simulated dip with what is asked of it. Refers to the object and its surface.
struct CheckerboardDip {
  std::unique_ptr<DippedFilm> film;
  std::unique_ptr<FilmMap> map;  // refers to it
  Board board;
  // Where a corner of the board ends up.
  GridLanding landing(const CalibrationObject& object) const;
};

// The film never tears here: scans show what came out, and a corner that tore away is missing from
// them. Same bytes for any number of threads. Throws DipError, InputError, Cancelled.
CheckerboardDip dip_checkerboard(const CheckeredFilm& film, const CalibrationObject& object,
                                 const Surface& surface, const FilmParameters& parameters,
                                 const DipOptions& options, const RunContext& context);

}  // namespace hydrodip
