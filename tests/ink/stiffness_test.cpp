// The stiffness field against areas that can be written down.
#include "ink/stiffness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hydrodip {
namespace {

using Corners = std::array<Vec2, 3>;

// 20 x 16 mm in pixels of 0.5 mm; film coordinate 0 is its centre.
const SheetRaster kRaster{20, 16, 50.8};

InkImage painted(const std::function<int(const Vec2&)>& density) {
  InkImage image(kRaster.width_px(), kRaster.height_px());
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) {
      int left = density(kRaster.to_film(x + 0.5, y + 0.5));
      for (int i = 0; i < 4; ++i) {
        const int ink = std::min(left, 255);
        image.pixel(x, y)[i] = static_cast<std::uint8_t>(ink);
        left -= ink;
      }
    }
  return image;
}

InkImage half_inked() {
  return painted([](const Vec2& u) { return u.x() > 0 ? 255 : 0; });
}

TEST(Stiffness, AHalfInkedTriangleHasHalfTheDensity) {
  const Corners square_half = {Vec2(-2, -1), Vec2(2, -1), Vec2(-2, 3)};
  // Right-angled, legs 4: of its area 8 the part with x > 0 is 2 * 2 / 2.
  EXPECT_NEAR(mean_density(half_inked(), kRaster, square_half, 0.01), 2.0 / 8, 1e-6);
  const Corners symmetric = {Vec2(-2, -1), Vec2(2, -1), Vec2(0, 3)};
  EXPECT_NEAR(mean_density(half_inked(), kRaster, symmetric, 1.016), 0.5, 1e-12);
}

// Wherever in a triangle its ink begins.
TEST(Stiffness, InkBelowOrAboveABlankHalfCounts) {
  const Corners triangle = {Vec2(-2, -2), Vec2(2, -2), Vec2(0, 2)};
  // The upper half is a quarter of the area.
  const InkImage above = painted([](const Vec2&u) { return u.y() > 0 ? 255 : 0; }),
                 below = painted([](const Vec2&u) { return u.y() < 0 ? 255 : 0; });
  EXPECT_NEAR(mean_density(above, kRaster, triangle, 0.01), 0.25, 1e-4);
  EXPECT_NEAR(mean_density(below, kRaster, triangle, 0.01), 0.75, 1e-4);
}

// Height of the triangle (-2, 0) (2, 0) (-2, 4) at x is 2 - x. Smearing the ink's edge by a box is
// taking the mean over all places s of the edge within w / 2: the mean of (2 - s)^2 / 2.
TEST(Stiffness, TheBoxFilterSmearsExactly) {
  const Corners triangle = {Vec2(-2, 0), Vec2(2, 0), Vec2(-2, 4)};
  for (const double w : {0.3, 1.016, 2.5}) {
    const double moment = w * w / 24;
    EXPECT_NEAR(mean_density(half_inked(), kRaster, triangle, w), (2 + moment) / 8, 1e-12) << w;
  }
}

TEST(Stiffness, EvenInkIsItself) {
  const InkImage image = painted([](const Vec2&) { return 3 * 255 + 51; });
  const Corners inner = {Vec2(-1.3, 2.2), Vec2(4.1, -3.3), Vec2(5.7, 2.9)};
  EXPECT_NEAR(mean_density(image, kRaster, inner, 1.016), 3.2, 1e-12);
  const Corners outside = {Vec2(30, 0), Vec2(31, 0), Vec2(30, 1)};
  EXPECT_EQ(mean_density(image, kRaster, outside, 1.016), 0);
}

// Off the image there is no ink: of a triangle across its edge x = 10 the part inside counts.
TEST(Stiffness, TheSheetsEdgeIsBlank) {
  const InkImage image = painted([](const Vec2&) { return 255; });
  const Corners across = {Vec2(8, -1), Vec2(12, -1), Vec2(10, 3)};
  EXPECT_NEAR(mean_density(image, kRaster, across, 0.8), 0.5, 1e-12);
}

// What the four triangles of a rectangle hold adds up to what the rectangle holds, and turning the
// corners around changes nothing.
TEST(Stiffness, PartsAddUpToTheWhole) {
  std::mt19937 random(7);
  const InkImage image = painted([&](const Vec2&) { return int(random() % 1021); });
  const Vec2 a(-6.1, -4.7), b(5.3, -4.7), c(5.3, 4.9), d(-6.1, 4.9), e(0.37, 1.19);
  const double w = 1.3;
  const auto held = [&](const Corners& t) {
    return mean_density(image, kRaster, t, w) * 0.5 * std::abs(cross2(t[1] - t[0], t[2] - t[0]));
  };
  const double parts = held({a, b, e}) + held({b, c, e}) + held({c, d, e}) + held({d, a, e});
  EXPECT_NEAR(parts, held({a, b, c}) + held({a, d, c}), 1e-9);
  // The same, pixel by pixel: the filtered rectangle is a product of two trapezoids.
  const auto weight = [&](double from, double to, double low, double high) {
    // int over the pixel of the box-smeared indicator of [low, high]
    const auto ramp = [&](double x, double edge) {  // int_-inf^x of the smeared step at edge
      const double t = x - edge;
      if (t < -w / 2) return 0.0;
      if (t > w / 2) return t;
      return (t + w / 2) * (t + w / 2) / (2 * w);
    };
    return ramp(to, low) - ramp(from, low) - ramp(to, high) + ramp(from, high);
  };
  double sum = 0;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) {
      const Vec2 p = kRaster.to_film(x, y + 1), q = kRaster.to_film(x + 1, y);
      const std::uint8_t* ink = image.pixel(x, y);
      sum += (ink[0] + ink[1] + ink[2] + ink[3]) / 255.0 * weight(p.x(), q.x(), a.x(), c.x()) *
             weight(p.y(), q.y(), a.y(), c.y());
    }
  EXPECT_NEAR(parts, sum, 1e-9);
}

TEST(Stiffness, ModulusGrowsFromBlankToInked) {
  const FilmMesh film = make_film_mesh(
      {.width_mm = 20, .height_mm = 16, .margin_mm = 2, .elements = 100, .grading = 1});
  const SheetRaster& raster = kRaster;
  const auto modulus = film_modulus(film, half_inked(), raster, {.ratio = 600, .filter_mm = 1});
  ASSERT_EQ(modulus.size(), film.triangles.size());
  for (std::size_t t = 0; t < modulus.size(); ++t) {
    double low = 1e9, high = -1e9;
    for (const std::int32_t v : film.triangles[t]) {
      low = std::min(low, film.u[std::size_t(v)].x());
      high = std::max(high, film.u[std::size_t(v)].x());
    }
    if (high <= -0.5) {
      EXPECT_EQ(modulus[t], 1);
    }
    if (low >= 0.5) {
      EXPECT_NEAR(modulus[t], 600, 1e-8);
    }
    EXPECT_GE(modulus[t], 1);
    EXPECT_LE(modulus[t], 600 + 1e-8);
  }
  for (const double k : film_modulus(film, half_inked(), raster, {.ratio = 1})) EXPECT_EQ(k, 1);
}

}  // namespace
}  // namespace hydrodip
