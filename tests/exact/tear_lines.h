// Where film tears first on a body of revolution, exactly and as a dip has it.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "exact/dipping.h"
#include "transfer/film_map.h"

namespace hydrodip::exact {

struct TearingBody {
  std::string name;
  shapes::Shape shape;
  double a_max;                             // exact solutions reach out to here
  std::function<double(double)> height;     // of the meridian at radius a
  std::function<double(double)> tan_theta;  // its slope
};

inline std::vector<TearingBody> tearing_bodies() {
  constexpr double R = 30, A = 36, C = 30, P = 40;
  return {{"sphere, R = 30", shapes::full_sphere(R, 400, 480), 29.2,
           [](double a) { return R - std::sqrt(R * R - a * a); },
           [](double a) { return a / std::sqrt(R * R - a * a); }},
          {"ellipsoid, 36 by 30",
           shapes::revolve(
               [](double s) { return Vec2(A * std::sin(M_PI * s), C * (1 - std::cos(M_PI * s))); },
               400, 480),
           35, [](double a) { return C * (1 - std::sqrt(1 - a * a / (A * A))); },
           [](double a) { return C / A * a / std::sqrt(A * A - a * a); }},
          {"paraboloid, z = a^2 / 40",
           shapes::revolve([](double s) { return Vec2(34 * s, 34 * s * 34 * s / P); }, 300, 480),
           33, [](double a) { return a * a / P; }, [](double a) { return 2 * a / P; }}};
}

// Height at which sqrt(1 + tan^2 theta) / (du_a / da) passes the limit.
inline double tear_height(const TearingBody& body, double limit) {
  const RevolutionTable u(body.a_max, kZStretch, body.tan_theta);
  const auto stretch = [&](double a) {
    constexpr double kStep = 0.05;
    const double slope =
        (8 * (u(a + kStep) - u(a - kStep)) - (u(a + 2 * kStep) - u(a - 2 * kStep))) / (12 * kStep);
    return std::hypot(1.0, body.tan_theta(a)) / slope;
  };
  double low = 5, high = body.a_max - 0.5;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (stretch(middle) < limit ? low : high) = middle;
  }
  return body.height(low);
}

struct TearLine {
  double exact_mm = 0;                                                  // height
  double mean_mm = 0, deviation_mm = 0, lowest_mm = 0, highest_mm = 0;  // over directions
};

constexpr int kDirections = 72;

// Heights at which whole film ends, in directions around the axis.
inline std::vector<double> edge_heights(const TearingBody& body, const FilmMap& map,
                                        double about_mm) {
  std::vector<double> heights;
  double about = 0;
  while (body.height(about) < about_mm) about += 0.01;
  for (int n = 0; n < kDirections; ++n) {
    const double angle = 2 * M_PI * (n + 0.5) / kDirections;
    const auto is_whole = [&](double a) {
      const Vec3 at(a * std::cos(angle), a * std::sin(angle), body.height(a));
      const Vec3 normal =
          Vec3(std::cos(angle) * body.tan_theta(a), std::sin(angle) * body.tan_theta(a), -1)
              .normalized();
      return map.to_film(at, normal).has_value();
    };
    // From below, so that nothing above counts.
    double low = 0.7 * about;
    while (low < body.a_max && is_whole(low + 0.02)) low += 0.02;
    double high = low + 0.02;
    for (int i = 0; i < 20; ++i) {
      const double middle = 0.5 * (low + high);
      (is_whole(middle) ? low : high) = middle;
    }
    heights.push_back(body.height(low));
  }
  return heights;
}

inline TearLine tear_line(const TearingBody& body, double limit, int elements,
                          double step_mm = 0.1) {
  const Surface surface(body.shape.positions, body.shape.triangles);
  RunContext context;
  TearLine line;
  line.exact_mm = tear_height(body, limit);
  DipOptions options;
  options.step_mm = step_mm;
  options.material.tear_stretch = limit;
  const DippedFilm film = dip(disc_film(elements), body.shape.positions, body.shape.triangles,
                              surface, make_trajectory({}, body.shape.positions), options, context)
                              .film;
  const TriangleMesh mesh{body.shape.positions, body.shape.triangles};
  const FilmMap map(mesh, surface, film);
  const std::vector<double> heights = edge_heights(body, map, line.exact_mm);
  for (const double h : heights) line.mean_mm += h / kDirections;
  for (const double h : heights)
    line.deviation_mm += (h - line.mean_mm) * (h - line.mean_mm) / kDirections;
  line.deviation_mm = std::sqrt(line.deviation_mm);
  line.lowest_mm = *std::min_element(heights.begin(), heights.end());
  line.highest_mm = *std::max_element(heights.begin(), heights.end());
  return line;
}

}  // namespace hydrodip::exact
