#include "calibrate/tear_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "calibrate/fit.h"

namespace hydrodip {
namespace {

constexpr double kFirstRing_mm = 30, kRingDistance_mm = 1.25;
constexpr int kAround = 256, kAlong = 256;  // triangles of the dome
constexpr int kDirections = 64;             // in which a ring is looked at
// A reading may be a ring off: its standard deviation, in rings.
constexpr double kReadingOff = 1;

// On the dome, by the arc from its lowest point and the direction from its axis.
Vec3 on_dome(double arc_mm, double direction) {
  const double angle = arc_mm / kDomeRadius_mm;
  const double radius = kDomeRadius_mm * std::sin(angle);
  return {radius * std::cos(direction), radius * std::sin(direction),
          kDomeRadius_mm * (1 - std::cos(angle))};
}

}  // namespace

double ring_arc_mm(int ring) { return kFirstRing_mm + kRingDistance_mm * (ring - 1); }

CalibrationObject tear_dome() {
  CalibrationObject dome;
  dome.name = "dome";
  dome.depth_mm = kDomeDepth_mm;
  TriangleMesh& mesh = dome.object;
  mesh.positions.push_back(Vec3::Zero());
  for (int k = 1; k <= kAlong; ++k)
    for (int i = 0; i < kAround; ++i)
      mesh.positions.push_back(on_dome(0.5 * std::numbers::pi * kDomeRadius_mm * k / kAlong,
                                       2 * std::numbers::pi * i / kAround));
  const auto at = [](int ring, int i) {
    return std::int32_t(1 + (ring - 1) * kAround + i % kAround);
  };
  for (int i = 0; i < kAround; ++i) mesh.triangles.push_back({0, at(1, i + 1), at(1, i)});
  for (int k = 1; k < kAlong; ++k)
    for (int i = 0; i < kAround; ++i) {
      mesh.triangles.push_back({at(k, i), at(k, i + 1), at(k + 1, i + 1)});
      mesh.triangles.push_back({at(k, i), at(k + 1, i + 1), at(k + 1, i)});
    }
  return dome;
}

std::vector<double> ring_stretches(const DesignOptions& design, const FilmParameters& parameters,
                                   const RunContext& context) {
  const CalibrationObject dome = tear_dome();
  const Surface surface(dome.object.positions, dome.object.triangles);
  DipOptions options = design.dip;
  options.method = DipMethod::kFull;
  options.material.z_stretch = parameters.z_stretch;
  options.material.poisson = parameters.poisson;
  options.material.tear_stretch = 0;
  options.modulus.clear();
  const auto mesh = std::make_shared<const FilmMesh>(make_film_mesh(design.film));
  const DippedFilm film =
      dip(mesh, dome.object.positions, dome.object.triangles, surface,
          make_trajectory({dome.depth_mm}, dome.object.positions), options, context)
          .film;
  const FilmMap map(dome.object, surface, film);
  std::vector<double> stretches;
  double most = 1;
  for (int ring = 1; ring <= kDomeRings; ++ring) {
    for (int i = 0; i < kDirections; ++i) {
      const auto hit = surface.closest_point(
          on_dome(ring_arc_mm(ring), 2 * std::numbers::pi * (i + 0.5) / kDirections), 1);
      if (!hit) continue;
      const auto u = map.to_film(surface.position(*hit), surface.normal(*hit));
      if (u) most = std::max(most, map.stretch(*u));
    }
    stretches.push_back(most);
  }
  return stretches;
}

void require_rings(const std::vector<int>& torn_from) {
  for (const int ring : torn_from)
    if (ring < 2 || ring > kDomeRings)
      throw InputError(
          fmt::format("--torn-ring {}: give the innermost ring of the dome on which film is torn, "
                      "from 2 to {}; "
                      "of film that holds further, or not so far, the dome cannot tell the limit",
                      ring, kDomeRings));
}

std::optional<TearLimit> tear_limit(const std::vector<double>& stretches,
                                    const std::vector<int>& torn_from) {
  require_rings(torn_from);
  double sum = 0, variance = 0;
  for (const int ring : torn_from) {
    const auto k = std::size_t(ring - 1);
    const double before = stretches[k - 1], here = stretches[k];
    sum += 0.5 * (before + here);
    // Where two neighbours happen to be alike, those that a misread ring leads to are not.
    const std::size_t inner = k < 2 ? 0 : k - 2, outer = std::min(k + 1, stretches.size() - 1);
    const double a_ring =
        std::max(here - before, (stretches[outer] - stretches[inner]) / double(outer - inner));
    variance += a_ring * a_ring * (kReadingOff * kReadingOff + 1.0 / 12);
  }
  if (!(variance > 0)) return std::nullopt;
  const auto count = double(torn_from.size());
  TearLimit limit;
  limit.stretch = sum / count;
  // Readings that differ by more say so themselves.
  double spread = 0;
  for (const int ring : torn_from) {
    const auto k = std::size_t(ring - 1);
    const double off = 0.5 * (stretches[k - 1] + stretches[k]) - limit.stretch;
    spread += off * off;
  }
  const double of_one = std::max(variance / count, count > 1 ? spread / (count - 1) : 0.0);
  const double half = kQuantile * std::sqrt(of_one / count);
  limit.low = std::max(1.0, limit.stretch - half);
  limit.high = limit.stretch + half;
  return limit;
}

}  // namespace hydrodip
