// What the process facts mean for a sheet of film.
#pragma once

#include "settings/config.h"

namespace hydrodip {

double film_area_mm2(const FilmOptions& film);  // of the sheet

struct Activator {
  double mass_g = 0, tolerance_g = 0;
};
// Scaled by area from a letter sheet, for which the process says it.
Activator activator_for(const ProcessOptions& process, const FilmOptions& film);

}  // namespace hydrodip
