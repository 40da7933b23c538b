// What the process facts mean for a sheet of film.
#pragma once

#include <string>

#include "settings/config.h"

namespace hydrodip {

double film_area_mm2(const FilmOptions& film);  // of the sheet

struct Activator {
  double mass_g = 0, tolerance_g = 0;
};
// Scaled by area from a letter sheet, for which the process says it.
Activator activator_for(const ProcessOptions& process, const FilmOptions& film);

// "3.50 ± 0.50 g", or "none".
std::string in_words(const Activator& activator);
// "60 to 80", or "60" if that is all there is to it.
std::string span_in_words(double least, double most);

}  // namespace hydrodip
