#include "settings/activator.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "settings/settings.h"

namespace hydrodip {
namespace {

double letter_area_mm2() {
  for (const FilmFormat& format : film_formats())
    if (format.name == "letter") return format.width_mm * format.height_mm;
  return 0;
}

}  // namespace

double film_area_mm2(const FilmOptions& film) {
  if (film.shape == FilmShape::kRectangle) return film.width_mm * film.height_mm;
  const double radius = 0.5 * std::min(film.width_mm, film.height_mm);
  return std::numbers::pi * radius * radius;
}

Activator activator_for(const ProcessOptions& process, const FilmOptions& film) {
  const double share = film_area_mm2(film) / letter_area_mm2();
  return {share * process.activator_g, share * process.activator_tolerance_g};
}

std::string in_words(const Activator& activator) {
  if (!(activator.mass_g > 0)) return "none";
  return fmt::format("{:.2f} ± {:.2f} g", activator.mass_g, activator.tolerance_g);
}

std::string span_in_words(double least, double most) {
  return least < most ? fmt::format("{:g} to {:g}", least, most) : fmt::format("{:g}", least);
}

}  // namespace hydrodip
