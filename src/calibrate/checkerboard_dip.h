// A calibration dip: film with a printed checkerboard, an object of known shape, and the film's
// parameters to be found (paper section 4).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "object/surface.h"
#include "scan/board.h"
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
  bool is_known_shape = false;  // by that name; a model file may be called the same
  TriangleMesh object;
  double depth_mm = 0;
};

// A shape that calibrations know: a sample, so much larger.
struct KitShape {
  const char* name;
  const char* sample;
  double scale;
  double depth_mm;            // where its slope gets to what films bear
  double edge_radius_mm = 0;  // 0: as sharp as the sample
};
// Those that the kit prints: as large as a sheet of paper bears. What moves corners about grows
// with a shape, a scan's noise does not. No edge is sharp: no printer makes one, and there films of
// triangles err by more than what they are to tell.
const std::vector<KitShape>& kit_shapes();
// The samples as they are: the paper's figures are made with them.
const std::vector<KitShape>& sample_shapes();
// All of them; a name that begins like another one comes before it.
std::vector<KitShape> known_shapes();
// nullptr: none of that name.
const KitShape* find_shape(const std::string& name);
TriangleMesh mesh_of(const KitShape& shape);  // posed, as it dips

// "sphere-90", "ellipsoid@11" (depth in mm) or a model file with its depth. Throws InputError.
CalibrationObject calibration_object(const std::string& text, const JobConfig& config,
                                     const RunContext& context);

// Throws InputError if it does not fit film or bath: its size and pose are given, so that what
// mends it is not what mends a model of one's own.
void require_room_for_shape(const CalibrationObject& shape, const JobConfig& config);

// Throws InputError if a print's correction is set: the board is printed without one.
void require_no_correction_of_board(const JobConfig& config);

// Everything about a film that its parameters leave alone. Immutable.
struct CheckeredFilm {
  SharedFilmMesh mesh;
  std::vector<double> ink_density;  // per triangle, after the stiffness filter
  Board board;
};
// Its grid lies on the board's squares (board_lines.h) and has about `film.elements` triangles,
// with every cell halved so many times.
CheckeredFilm checkered_film(const DesignOptions& design, const Board& board, int halvings = 0);

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
