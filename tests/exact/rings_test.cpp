// Ink in concentric rings: from the printed image over the stiffness field to where the film lands,
// against the two-point boundary value problem of the continuum.
#include <gtest/gtest.h>

#include <numbers>

#include "exact/dipping.h"
#include "ink/stiffness.h"

namespace hydrodip {
namespace {

using exact::kZStretch;

constexpr double kRadius = 30;
constexpr double kRing_mm = 16;  // from one dark ring to the next
constexpr double kRatio = 600;

double sphere_slope(double a) { return a / std::sqrt(kRadius * kRadius - a * a); }

// From 0.1 to 1 and back.
double ink_density(double u) { return 0.55 - 0.45 * std::cos(2 * std::numbers::pi * u / kRing_mm); }

InkImage rings(const SheetRaster& raster) {
  InkImage image(raster.width_px(), raster.height_px());
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x)
      image.pixel(x, y)[2] =
          std::uint8_t(std::lround(255 * ink_density(raster.to_film(x + 0.5, y + 0.5).norm())));
  return image;
}

TEST(Rings, WithoutRingsTheSolutionIsTheKnownOne) {
  const std::vector<double> radii = {5, 15, 25, 28};
  const auto even = exact::ringed_revolution(radii, exact::kClampRadius, kZStretch, sphere_slope,
                                             [](double) { return 7.0; });
  for (std::size_t i = 0; i < radii.size(); ++i)
    EXPECT_NEAR(even[i], exact::revolution(radii[i], exact::kClampRadius, kZStretch, sphere_slope),
                1e-3);
}

TEST(RingsSlow, InkRingsOnASphereLandWhereTheContinuumHasThem) {
  const FilmMesh film = exact::disc_film(20000);
  const SheetRaster raster{2 * exact::kClampRadius + 20, 2 * exact::kClampRadius + 20, 150};
  auto options = exact::untearing(0.2, kRadius - std::sqrt(kRadius * kRadius - 28.4 * 28.4));
  options.modulus = film_modulus(film, rings(raster), raster, {.ratio = kRatio, .filter_mm = 0.5});
  const DippedFilm dipped = exact::dip_shape(shapes::sphere_bowl(kRadius, 29.5), film, options);

  const std::vector<double> radii = {3, 5, 8, 11, 14, 17, 20, 22, 24, 26, 27, 28};
  const auto modulus = [](double u) { return 1 + ink_density(u) * (kRatio - 1); };
  const auto ringed =
      exact::ringed_revolution(radii, exact::kClampRadius, kZStretch, sphere_slope, modulus);
  double furthest_from_even = 0, largest = 0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    furthest_from_even = std::max(
        furthest_from_even, std::abs(ringed[i] - exact::revolution(radii[i], exact::kClampRadius,
                                                                   kZStretch, sphere_slope)));
    // The film around that radius, brought there along the solution's own slope.
    double sum = 0;
    int count = 0;
    for (std::size_t v = 0; v < dipped.position.size(); ++v) {
      if (dipped.state[v] != VertexState::kAttached) continue;
      const double a = dipped.position[v].head<2>().norm();
      if (std::abs(a - radii[i]) > 0.4) continue;
      const double slope = std::hypot(1.0, kZStretch * sphere_slope(radii[i])) *
                           exact::ringed_slope(radii[i], ringed[i], exact::kClampRadius, modulus);
      const double error = dipped.mesh().u[v].norm() - ringed[i] - slope * (a - radii[i]);
      sum += error;
      ++count;
    }
    ASSERT_GT(count, 0) << radii[i];
    largest = std::max(largest, std::abs(sum / count));
    EXPECT_NEAR(sum / count, 0, 0.03) << "a = " << radii[i];
  }
  RecordProperty("largest_mm", std::to_string(largest));
  EXPECT_GT(furthest_from_even, 0.1) << "the rings must matter";
}

}  // namespace
}  // namespace hydrodip
