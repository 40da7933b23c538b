// Bodies of revolution on the clamped disc, against the ordinary differential equation that the
// continuum obeys.
#include <gtest/gtest.h>

#include "exact/dipping.h"

namespace hydrodip {
namespace {

using exact::kZStretch;

constexpr double kBar_mm = 0.02;
constexpr double kFrom_mm = 3, kTo_mm = 28;
constexpr double kContact_mm = 28.4;  // where the water stands in the end

struct Body {
  shapes::Shape shape;
  std::function<double(double)> height;     // of the meridian at radius a
  std::function<double(double)> tan_theta;  // its slope
};

Body sphere() {
  constexpr double R = 30;
  return {shapes::sphere_bowl(R, 29.5), [](double a) { return R - std::sqrt(R * R - a * a); },
          [](double a) { return a / std::sqrt(R * R - a * a); }};
}

Body cone_45() {
  return {shapes::cone(32, 1), [](double a) { return a; }, [](double) { return 1.0; }};
}

// Semi-axes 36 mm across, 24 mm up.
Body ellipsoid() {
  constexpr double A = 36, C = 24;
  const double end = std::asin(34 / A);
  const auto meridian = [=](double s) {
    return Vec2(A * std::sin(s * end), C * (1 - std::cos(s * end)));
  };
  return {shapes::revolve(meridian, 300, 360),
          [](double a) { return C * (1 - std::sqrt(1 - a * a / (A * A))); },
          [](double a) { return C / A * a / std::sqrt(A * A - a * a); }};
}

// z = a^2 / 60 mm.
Body paraboloid() {
  const auto meridian = [](double s) { return Vec2(32 * s, 32 * s * 32 * s / 60); };
  return {shapes::revolve(meridian, 300, 360), [](double a) { return a * a / 60; },
          [](double a) { return a / 30; }};
}

exact::RevolutionTable solution(const Body& body) {
  return {kContact_mm, kZStretch, body.tan_theta};
}

DippedFilm dip_body(const Body& body, int elements, double step_mm, double poisson = 0) {
  auto options = exact::untearing(step_mm, body.height(kContact_mm));
  options.material.poisson = poisson;
  return exact::dip_shape(body.shape, exact::disc_film(elements), options);
}

std::vector<exact::VertexError> errors(const Body& body, int elements, double step_mm,
                                       double poisson = 0, double from_mm = kFrom_mm) {
  return exact::revolution_errors(dip_body(body, elements, step_mm, poisson), solution(body),
                                  from_mm, kTo_mm);
}

// That the film reaches the whole range and covers it evenly enough to speak of its largest error.
void expect_range(const std::vector<exact::VertexError>& found, std::size_t least) {
  EXPECT_GE(found.size(), least);
  double nearest = 1e300, furthest = 0;
  for (const exact::VertexError& e : found) {
    nearest = std::min(nearest, e.a);
    furthest = std::max(furthest, e.a);
  }
  EXPECT_LT(nearest, kFrom_mm + 1);
  EXPECT_GT(furthest, kTo_mm - 0.5);
}

// In steps that grow, the default.
std::vector<exact::VertexError> default_errors(const Body& body) {
  auto options = exact::untearing(DipOptions().step_mm, body.height(kContact_mm));
  options.even_steps = DipOptions().even_steps;
  return exact::revolution_errors(exact::dip_shape(body.shape, exact::disc_film(40000), options),
                                  solution(body), kFrom_mm, kTo_mm);
}

// With 40,000 triangles the bar is met in the default steps and in even ones, and at most a quarter
// of the error comes from those: so much it changes when the step is halved.
void expect_default_accuracy(const Body& body) {
  const auto found = errors(body, 40000, 0.1);
  expect_range(found, 3000);
  const double largest = exact::largest(found);
  EXPECT_LE(largest, kBar_mm);
  const auto by_default = default_errors(body);
  expect_range(by_default, 3000);
  EXPECT_LE(exact::largest(by_default), kBar_mm);
  EXPECT_LE(std::abs(exact::largest(errors(body, 40000, 0.05)) - largest), largest / 4);
}

TEST(RevolutionSlow, SphereMeetsTheBarByDefault) { expect_default_accuracy(sphere()); }

TEST(RevolutionSlow, ConeMeetsTheBarByDefault) { expect_default_accuracy(cone_45()); }

// Of the cone, whose error comes from the mesh: its exact strain jumps at the apex.
TEST(RevolutionSlow, ErrorFallsFasterThanTheMeshSize) {
  const Body body = cone_45();
  const exact::RevolutionTable exact_u = solution(body);
  std::vector<double> mean, most;
  for (const int elements : {1500, 6000, 24000, 96000}) {
    const auto outer =
        exact::revolution_errors(dip_body(body, elements, 0.05), exact_u, 10, kTo_mm);
    mean.push_back(exact::root_mean_square(outer));
    most.push_back(exact::largest(outer));
  }
  for (std::size_t i = 0; i + 1 < mean.size(); ++i) {
    EXPECT_GE(std::log2(mean[i] / mean[i + 1]), 1.5) << mean[i] << " " << mean[i + 1];
    EXPECT_GE(std::log2(most[i] / most[i + 1]), 1.5) << most[i] << " " << most[i + 1];
  }
}

TEST(RevolutionSlow, EllipsoidMeetsTheBar) {
  const auto found = errors(ellipsoid(), 10000, 0.1);
  expect_range(found, 800);
  EXPECT_LE(exact::largest(found), kBar_mm);
}

TEST(RevolutionSlow, ParaboloidMeetsTheBar) {
  const auto found = errors(paraboloid(), 10000, 0.1);
  expect_range(found, 800);
  EXPECT_LE(exact::largest(found), kBar_mm);
}

// The exact film does not depend on Poisson's ratio.
TEST(RevolutionSlow, PoissonsRatioDoesNotMatter) {
  for (const double poisson : {-0.3, 0.3}) {
    const auto found = errors(sphere(), 10000, 0.2, poisson);
    EXPECT_LE(exact::largest(found), kBar_mm) << "poisson " << poisson;
  }
}

}  // namespace
}  // namespace hydrodip
