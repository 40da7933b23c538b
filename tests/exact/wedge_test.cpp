// The wedge's closed form: a prism pushed through film that is clamped along two edges.
#include <gtest/gtest.h>

#include "exact/dipping.h"

namespace hydrodip {
namespace {

using exact::kZStretch;

// A strip of film, clamped at x = +-100 and free along its other two edges.
FilmMesh strip(int elements, double grading) {
  FilmMesh mesh = make_film_mesh({.width_mm = 2 * exact::kClampRadius + 20,
                                  .height_mm = 120,
                                  .margin_mm = 10,
                                  .elements = elements,
                                  .grading = grading});
  for (std::size_t v = 0; v < mesh.u.size(); ++v)
    mesh.on_rim[v] = std::abs(std::abs(mesh.u[v].x()) - exact::kClampRadius) < 1e-9;
  return mesh;
}

struct WedgeError {
  double largest_mm = 0;  // along x, against the closed form
  double root_mean_square_mm = 0;
  double sideways_mm = 0;  // along y, against staying where it was
  double stretch = 0;      // largest error of the stretch, 1 <= a <= 25
  double area_ratio = 0;
  double reach_mm = 0;  // furthest attached vertex
};

// Dips until film as far as 30 mm from the apex lies on the wedge.
WedgeError wedge_error(double degrees, const FilmMesh& film, double step_mm,
                       DipScheme scheme = DipScheme::kContactLine) {
  const double tan_theta = std::tan(degrees * kDegree);
  auto options = exact::untearing(step_mm, 30 * tan_theta);
  options.scheme = scheme;
  const DippedFilm dipped = exact::dip_shape(shapes::wedge(40, 200, tan_theta), film, options);
  WedgeError error;
  double sum = 0;
  int count = 0;
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    if (dipped.state[v] != VertexState::kAttached) continue;
    const Vec3& x = dipped.position[v];
    const double a = std::abs(x.x());
    const double u = std::copysign(1.0, x.x()) * film.u[v].x();
    const double along = u - exact::wedge(a, exact::kClampRadius, tan_theta, kZStretch);
    error.largest_mm = std::max(error.largest_mm, std::abs(along));
    error.sideways_mm = std::max(error.sideways_mm, std::abs(x.y() - film.u[v].y()));
    error.reach_mm = std::max(error.reach_mm, a);
    sum += along * along;
    ++count;
    if (a < 1 || a > 25) continue;
    // On the object a millimetre of a is sqrt(1 + tan^2) long and takes u'(a) of film.
    const double c = std::hypot(1.0, kZStretch * tan_theta);
    const double rate = c * std::pow(1 - a / exact::kClampRadius, c - 1);
    const double stretch = std::hypot(1.0, tan_theta) / rate;
    error.stretch = std::max(error.stretch, std::abs(dipped.stretch[v] - stretch));
    error.area_ratio = std::max(error.area_ratio, std::abs(dipped.area_ratio[v] - stretch));
  }
  error.root_mean_square_mm = std::sqrt(sum / count);
  return error;
}

TEST(WedgeSlow, MeetsTheClosedFormOnAnyMesh) {
  for (const int elements : {600, 1500, 2500, 10000})
    for (const double grading : {1.0, 4.0}) {
      const WedgeError error = wedge_error(45, strip(elements, grading), 0.1);
      const double cell2 = 600.0 / elements;  // over that of the coarsest, squared
      EXPECT_LT(error.largest_mm, 1e-3 * cell2 + 2e-4)
          << elements << " triangles, grading " << grading;
      EXPECT_LT(error.sideways_mm, 6e-4 * cell2) << elements << " triangles, grading " << grading;
      EXPECT_GT(error.reach_mm, 20) << elements << " triangles, grading " << grading;
    }
}

// What counts is how far a step climbs along the object: on flat slopes the same run needs less.
TEST(WedgeSlow, MeetsTheClosedFormAtAnySlope) {
  const FilmMesh film = strip(6000, 4);
  for (const double degrees : {5.0, 20.0, 30.0, 55.0, 65.0}) {
    const double step_mm = 0.2 * std::min(1.0, std::tan(degrees * kDegree));
    EXPECT_LT(wedge_error(degrees, film, step_mm).largest_mm, degrees < 50 ? 2e-4 : 1.5e-3)
        << degrees << " degrees";
  }
}

TEST(WedgeSlow, ErrorFallsWithTheSquareOfTheStep) {
  const FilmMesh film = strip(6000, 4);
  const double coarse = wedge_error(45, film, 1.6).root_mean_square_mm;
  const double middle = wedge_error(45, film, 0.8).root_mean_square_mm;
  const double fine = wedge_error(45, film, 0.4).root_mean_square_mm;
  EXPECT_GT(std::log2(coarse / fine) / 2, 1.7) << coarse << " " << middle << " " << fine;
  EXPECT_LT(fine, middle);
  EXPECT_LT(middle, coarse);
}

// A vertex is measured on the triangles around it, so the stretch lags by a part of a cell.
TEST(Wedge, StretchIsThatOfTheClosedForm) {
  const WedgeError error = wedge_error(45, strip(2500, 4), 0.1);
  EXPECT_LT(error.stretch, 2e-3);
  EXPECT_LT(error.area_ratio, 2e-3);
}

TEST(WedgeSlow, PaperSchemeConvergesAsMeshAndStepShrink) {
  const auto error = [](int elements, double step_mm) {
    return wedge_error(45, strip(elements, 1), step_mm, DipScheme::kPaper).root_mean_square_mm;
  };
  const double coarse = error(600, 0.4), fine = error(9600, 0.1);
  EXPECT_LT(fine, 0.6 * coarse);
}

}  // namespace
}  // namespace hydrodip
