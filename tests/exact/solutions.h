// Exact solutions of the continuum model (docs/model.md): what the dip must converge to.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

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

// The floating annulus a <= r <= L of a film whose modulus K depends on the film coordinate u, with
// u(a) = u_a and u(L) = L: its slope u'(a). Equilibrium is (K r (u' - 1))' = K (u / r - 1), a
// two-point boundary value problem; solved by shooting from r = a.
inline double ringed_slope(double a, double u_a, double L,
                           const std::function<double(double)>& modulus) {
  constexpr int kSteps = 1200;
  const double ratio = std::pow(L / a, 1.0 / kSteps);
  // u(L) - L when the film sets out with this slope. The flux is q = K r (u' - 1).
  const auto miss = [&](double slope) {
    double r = a, u = u_a, q = modulus(u_a) * a * (slope - 1);
    const auto du = [&](double at, double v, double flux) { return 1 + flux / (modulus(v) * at); };
    const auto dq = [&](double at, double v) { return modulus(v) * (v / at - 1); };
    for (int i = 0; i < kSteps; ++i) {
      const double h = r * (ratio - 1);
      const double u1 = du(r, u, q), q1 = dq(r, u);
      const double u2 = du(r + h / 2, u + h / 2 * u1, q + h / 2 * q1);
      const double q2 = dq(r + h / 2, u + h / 2 * u1);
      const double u3 = du(r + h / 2, u + h / 2 * u2, q + h / 2 * q2);
      const double q3 = dq(r + h / 2, u + h / 2 * u2);
      const double u4 = du(r + h, u + h * u3, q + h * q3), q4 = dq(r + h, u + h * u3);
      u += h / 6 * (u1 + 2 * u2 + 2 * u3 + u4);
      q += h / 6 * (q1 + 2 * q2 + 2 * q3 + q4);
      r += h;
    }
    return u - L;
  };
  double x0 = 1, x1 = 0.95, y0 = miss(x0), y1 = miss(x1);
  for (int i = 0; i < 30 && std::abs(y1) > 1e-10 && y1 != y0; ++i) {
    const double x2 = x1 - y1 * (x1 - x0) / (y1 - y0);
    x0 = x1;
    y0 = y1;
    x1 = x2;
    y1 = miss(x2);
  }
  return x1;
}

// Film coordinate that attaches at each of `radii` (ascending) of a body of revolution on a disc
// clamped at L, for a film with rings of different modulus(u).
inline std::vector<double> ringed_revolution(const std::vector<double>& radii, double L,
                                             double z_stretch,
                                             const std::function<double(double)>& tan_theta,
                                             const std::function<double(double)>& modulus) {
  const auto rate = [&](double r, double u) {
    return std::hypot(1.0, z_stretch * tan_theta(r)) * ringed_slope(r, u, L, modulus);
  };
  constexpr double kStep = 0.25;
  double a = 0.05, u = a;  // a body that is flat at the axis has not stretched anything yet
  std::vector<double> result;
  for (const double radius : radii) {
    const int steps = std::max(1, int(std::ceil((radius - a) / kStep)));
    const double h = (radius - a) / steps;
    for (int i = 0; i < steps; ++i) {
      const double k1 = rate(a, u), k2 = rate(a + h / 2, u + h / 2 * k1);
      const double k3 = rate(a + h / 2, u + h / 2 * k2), k4 = rate(a + h, u + h * k3);
      u += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      a += h;
    }
    result.push_back(u);
  }
  return result;
}

}  // namespace hydrodip::exact
