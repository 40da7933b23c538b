// Exact solutions of the continuum model (docs/model.md): what the dip must converge to.
#pragma once

#include <cmath>
#include <functional>

namespace hydrodip::exact {

// Film coordinate that attaches at distance a from the apex line of a prism with slope tan_theta
// across a film clamped at +-L.
inline double wedge(double a, double L, double tan_theta, double z_stretch) {
  const double c = std::hypot(1.0, z_stretch * tan_theta);
  return L - L * std::pow(1 - a / L, c);
}

// Film coordinate that attaches at radius a of a body of revolution on a disc clamped at L.
// tan_theta(a): slope of the meridian at radius a. Integrated by RK4; the start is regular because
// u = lambda a with lambda = 2 c / (1 + c) solves the equation near the axis.
inline double revolution(double a, double L, double z_stretch,
                         const std::function<double(double)>& tan_theta) {
  const auto rate = [&](double r, double u) {
    const double B = (u - r) / (1 / r - r / (L * L));
    const double A = 1 - B / (L * L);
    return std::hypot(1.0, z_stretch * tan_theta(r)) * (A - B / (r * r));
  };
  const double start = 1e-6;
  const double c = std::hypot(1.0, z_stretch * tan_theta(start));
  double u = 2 * c / (1 + c) * start;
  const int steps = 20000;
  // Steps grow with the radius, because the solution varies on the scale of the radius.
  const double ratio = std::pow(a / start, 1.0 / steps);
  double r = start;
  for (int i = 0; i < steps; ++i) {
    const double h = r * (ratio - 1);
    const double k1 = rate(r, u);
    const double k2 = rate(r + h / 2, u + h / 2 * k1);
    const double k3 = rate(r + h / 2, u + h / 2 * k2);
    const double k4 = rate(r + h, u + h * k3);
    u += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    r += h;
  }
  return u;
}

}  // namespace hydrodip::exact
