// Exact solutions of the continuum model (docs/model.md): what the dip must converge to.
#pragma once

#include <algorithm>
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

// A circular cylinder along y that is lowered, shifted along x and turned about y, evenly and all
// at once, through a film clamped at x = +-L. The pivot is its lowest line.
struct RolledCylinder {
  double radius = 30, L = 95, z_stretch = 0.65;
  double lower = 20, shift = 6, turn = M_PI / 18;  // in the end; turn in radians

  // Film coordinates that attach at angles psi from the lowest line in the body's frame: to the
  // right, positive angles ascending, and to the left, negative angles descending.
  struct Side {
    std::vector<double> psi, u;
    // Linear between so many entries is exact to 1e-6 mm. Not beyond the last.
    double at(double angle) const {
      const bool rising = psi.back() > 0;
      const auto n =
          std::size_t(std::lower_bound(psi.begin() + 1, psi.end() - 1, angle,
                                       [&](double a, double b) { return rising ? a < b : a > b; }) -
                      psi.begin());
      const double s = (angle - psi[n - 1]) / (psi[n] - psi[n - 1]);
      return u[n - 1] + s * (u[n] - u[n - 1]);
    }
  };

  // The floating film on one side is strained evenly, u' = (L -+ u) / (L -+ x). On the circle,
  // which meets the water at the angle chi from straight down as the bath sees it, the water line
  // gains d chi +- d theta. With s = sqrt(t) nothing is singular at the touch. side: +1 right, -1
  // left.
  Side solved(double side) const {
    constexpr int kSteps = 40000;
    // chi, and where the water line is in the bath.
    const auto chi = [&](double t) {
      return std::acos(std::clamp(std::cos(turn * t) - lower * t / radius, -1.0, 1.0));
    };
    const auto gained = [&](double t) { return chi(t) + side * turn * t; };
    const auto rate = [&](double t, double u) {
      const double x = side * (radius * std::sin(turn * t) + shift * t) + radius * std::sin(chi(t));
      return (L - u) / (L - x);
    };
    Side result{{0}, {0}};
    double u = 0;
    for (int n = 1; n <= kSteps; ++n) {
      const auto t_at = [&](double step) { return std::pow(step / kSteps, 2); };
      const double t0 = t_at(n - 1), t1 = t_at(n - 0.5), t2 = t_at(n);
      const double arc = radius * (gained(t2) - gained(t0));
      const double middle = chi(t1);
      const double sigma = arc * std::hypot(std::cos(middle), z_stretch * std::sin(middle));
      const double half = u + 0.5 * sigma * rate(t0, u);
      u += sigma * rate(t1, half);
      result.psi.push_back(side * gained(t2));
      result.u.push_back(side * u);
    }
    return result;
  }
};

// The tangential film coordinate v that attaches at radius a, to first order in phi, of a body of
// revolution that has been turned by phi(a) when its water line is there: film point
// (u + i v) exp(i (Theta + phi)) at the body's angle Theta. u(a) solves revolution().
inline std::vector<double> twisted(const std::vector<double>& radii, double L, double z_stretch,
                                   const std::function<double(double)>& tan_theta,
                                   const std::function<double(double)>& u,
                                   const std::function<double(double)>& phi) {
  std::vector<double> result;
  double a = 1e-3, v = 0;
  for (const double radius : radii) {
    const int steps = std::max(1, int((radius - a) / 0.005));
    const double h = (radius - a) / steps;
    for (int n = 0; n < steps; ++n, a += h) {
      // What the film's own slope takes back is stiff near the axis: implicit midpoint rule.
      const double m = a + h / 2;
      const double decay = std::hypot(1.0, z_stretch * tan_theta(m)) * (1 / (L * L) + 1 / (m * m)) /
                           (1 / m - m / (L * L));
      const double turned = (phi(a + h) - phi(a)) * u(m);
      v = (v * (1 - 0.5 * h * decay) - turned) / (1 + 0.5 * h * decay);
    }
    result.push_back(v);
  }
  return result;
}

}  // namespace hydrodip::exact
