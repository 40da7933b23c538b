// A material law given by numbers: energies over a square of principal values, and a smooth surface
// through them.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "elastic/material_law.h"

namespace hydrodip {

// energy[i * samples + j]: at a = least + i h, b = least + j h, h = (most - least) / (samples - 1).
struct LawTable {
  double least = 0.4, most = 2.5;
  int samples = 129;
  std::vector<double> energy;
};

// A bicubic spline, twice continuously differentiable, exact for cubic laws; beyond the table it
// goes on as a parabola. The error falls with the fourth power of h. Throws InputError for fewer
// than 8 samples, a range that does not hold 1 between its ends, energies that are not finite, or
// that change when a and b are exchanged.
std::shared_ptr<const MaterialLaw> make_table_law(const LawTable& table);

// Of a function of a and b, or of one of the film's principal stretches 1 / a and 1 / b that counts
// its energy per mm^2 of flat film, as books have it. The range is that of a and b.
using LawEnergy = std::function<double(double, double)>;
LawTable tabulated(const LawEnergy& energy, LawTable range = {});
LawTable tabulated_by_stretch(const LawEnergy& energy, LawTable range = {});

}  // namespace hydrodip
