// What a dip amounts to, in a few numbers.
#pragma once

#include "film/film.h"
#include "object/object.h"
#include "transfer/film_map.h"

namespace hydrodip {

struct DipFigures {
  double object_mm2 = 0;            // the object's whole surface
  double downward_mm2 = 0;          // of it: below the dipping depth and facing down
  double covered_mm2 = 0;           // of the whole surface: film lies on it
  double covered_downward_mm2 = 0;  // of downward_mm2: film lies on it
  double torn_mm2 = 0;              // of the flat film
  double film_on_object_mm2 = 0;    // of the flat film
  double largest_stretch = 1;       // principal stretch of film that lies on the object
  double mean_area_ratio = 1;       // deformed over flat area of film that lies on the object

  double covered_share() const { return ratio(covered_mm2, object_mm2); }
  double covered_downward_share() const { return ratio(covered_downward_mm2, downward_mm2); }
  // Of the film that met the object.
  double torn_share() const { return ratio(torn_mm2, torn_mm2 + film_on_object_mm2); }

  static double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }
};

// Coverage is sampled about every millimetre of the object's surface.
DipFigures dip_figures(const Object& object, const FilmMap& map, const DippedFilm& film);

}  // namespace hydrodip
