// How ink stiffens the film (paper section 3.4): a modulus per triangle from what is printed there.
#pragma once

#include <array>
#include <vector>

#include "film/film.h"
#include "ink/inks.h"
#include "transfer/raster.h"

namespace hydrodip {

struct StiffnessOptions {
  double ratio = 600;        // r: modulus at ink density 1 over that of blank film, 1 or more
  double filter_mm = 1.016;  // side of the box filter: 12 pixels at 300 dpi
};

// The mean over a triangle of the ink density, after a square box filter. Every pixel is a square
// of constant density, there is no ink off the image, and the integrals are exact.
double mean_density(const InkImage& image, const SheetRaster& raster,
                    const std::array<Vec2, 3>& triangle, double filter_mm);

// Modulus over that of blank film, 1 + I (ratio - 1), per triangle of the flat film; I is its mean
// density, up to 4. The image has raster's pixels.
std::vector<double> film_modulus(const FilmMesh& film, const InkImage& image,
                                 const SheetRaster& raster, const StiffnessOptions& options);

}  // namespace hydrodip
