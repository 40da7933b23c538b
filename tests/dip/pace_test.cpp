// Steps that grow where that costs no accuracy.
#include "dip/pace.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dip/dip.h"
#include "dip/lowest_places.h"
#include "exact/dipping.h"
#include "exact/shapes.h"

namespace hydrodip {
namespace {

DipResult dip_of(const shapes::Shape& shape, const FilmMesh& film, const DipOptions& options,
                 const DipObserver& observe = {}) {
  const Surface surface(shape.positions, shape.triangles);
  RunContext context;
  return dip(film, shape.positions, shape.triangles, surface, make_trajectory({}, shape.positions),
             options, context, observe);
}

DipOptions growing(double step_mm) {
  DipOptions options;
  options.step_mm = step_mm;
  options.material.tear_stretch = 0;
  return options;
}

std::vector<double> lengths(const std::vector<double>& ends_mm) {
  std::vector<double> all;
  double before_mm = 0;
  for (const double end_mm : ends_mm) {
    all.push_back(end_mm - before_mm);
    before_mm = end_mm;
  }
  return all;
}

TEST(Pace, StepsGrowWithinTheirBounds) {
  const DipResult made = dip_of(shapes::sphere_bowl(30, 28), exact::disc_film(10000), growing(0.1));
  const std::vector<double>& ends_mm = made.statistics.steps_at_mm;
  ASSERT_FALSE(ends_mm.empty());
  EXPECT_EQ(made.statistics.steps, int(ends_mm.size()));
  EXPECT_DOUBLE_EQ(ends_mm.back(), made.film.depth_mm);
  const std::vector<double> all = lengths(ends_mm);
  // The last may be longer by what would have been a sliver.
  EXPECT_LE(*std::max_element(all.begin(), all.end()), 0.4 + 0.05 + 1e-9);
  EXPECT_GE(*std::min_element(all.begin(), all.end()), 0.1 / 8 - 1e-9);
  EXPECT_LT(double(all.size()), 0.5 * made.film.depth_mm / 0.1);
}

// The way is looked at in equal parts, whose sum rounding makes longer or shorter than the way.
TEST(Pace, EveryWayEnds) {
  const shapes::Shape shape = shapes::cone(10, 1);
  const Surface surface(shape.positions, shape.triangles);
  const FilmMesh film = exact::disc_film(500);
  RunContext context;
  int longer = 0;
  for (int hundredths = 40; hundredths <= 100; ++hundredths) {
    TrajectoryOptions way;
    way.depth_mm = hundredths / 100.0;
    const DipResult made = dip(film, shape.positions, shape.triangles, surface,
                               make_trajectory(way, shape.positions), growing(0.1), context);
    EXPECT_NEAR(made.statistics.steps_at_mm.back(), hundredths / 100.0, 1e-12);
    EXPECT_LT(made.statistics.steps, 100);
    for (int parts = 1; parts <= 10; ++parts)
      longer += made.film.depth_mm * parts / parts > made.film.depth_mm;
  }
  EXPECT_GT(longer, 0);
}

// But for the first, as the contact line runs fast under a tip.
TEST(Pace, EvenStepsAreAllAsLong) {
  DipOptions options = growing(0.25);
  options.even_steps = true;
  const DipResult made = dip_of(shapes::cone(10, 1), exact::disc_film(2000), options);
  const std::vector<double> all = lengths(made.statistics.steps_at_mm);
  EXPECT_LE(*std::max_element(all.begin(), all.end()), 0.25 + 1e-9);
  EXPECT_EQ(std::count_if(all.begin(), all.end(), [](double mm) { return mm > 0.25 - 1e-9; }), 39);
}

TEST(Pace, ADipInTheStepsOfAnotherIsThatDip) {
  const shapes::Shape cone = shapes::cone(15, 0.8);
  const FilmMesh film = exact::disc_film(4000);
  DipOptions options = growing(0.1);
  const DipResult first = dip_of(cone, film, options);
  options.steps_at_mm = first.statistics.steps_at_mm;
  const DipResult again = dip_of(cone, film, options);
  EXPECT_EQ(again.statistics.steps_at_mm, first.statistics.steps_at_mm);
  EXPECT_EQ(again.film.position, first.film.position);
}

// Beside the bowl, higher up than its bottom, a cone whose tip the water meets on its own.
TEST(Pace, AStepEndsWhereTheWaterComesToSomethingNew) {
  shapes::Shape both = shapes::sphere_bowl(30, 25);
  shapes::Shape cone = shapes::cone(3, 1);
  for (Vec3& p : cone.positions) p += Vec3(40, 0, 9.87);
  both.append(cone);
  const DipResult made = dip_of(both, exact::disc_film(4000), growing(0.1));
  const std::vector<double>& ends_mm = made.statistics.steps_at_mm;
  const auto after = std::upper_bound(ends_mm.begin(), ends_mm.end(), 9.87 + 1e-9);
  ASSERT_NE(after, ends_mm.end());
  // Nothing of the cone's tip is met by a longer step.
  EXPECT_LE(*after - *(after - 1), 0.1 + 1e-9);
  EXPECT_LE(*after - 9.87, 0.1 + 1e-9);
  const auto next = after + 1;
  ASSERT_NE(next, ends_mm.end());
  EXPECT_LE(*next - *after, 0.1 + 1e-9);
}

TEST(Pace, IsLookedAtEvenly) {
  std::vector<double> seen_mm;
  int looks = 0;
  dip_of(shapes::sphere_bowl(30, 28), exact::disc_film(2000), growing(0.1),
         [&](int look, int of, const Moment& moment, const auto&, const auto&) {
           looks = of;
           EXPECT_EQ(look, int(seen_mm.size()));
           seen_mm.push_back(moment.travelled_mm);
         });
  ASSERT_EQ(int(seen_mm.size()), looks + 1);
  const double length_mm = seen_mm.back();
  for (int look = 0; look <= looks; ++look)
    EXPECT_NEAR(seen_mm[std::size_t(look)], length_mm * look / looks, 0.45);
}

TEST(LowestPlaces, AreThoseWithNothingBelowAround) {
  shapes::Shape both = shapes::cone(10, 1);
  shapes::Shape other = shapes::cone(5, 2);
  for (Vec3& p : other.positions) p += Vec3(30, 0, 1.5);
  both.append(other);
  EXPECT_EQ(lowest_places(both.positions, both.triangles), (std::vector<double>{0, 1.5}));
}

// As STL files have them.
TEST(LowestPlaces, AreTheSameIfTrianglesShareNoCorners) {
  const shapes::Shape ball = shapes::sphere_bowl(20, 15);
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  for (const Triangle& t : ball.triangles) {
    const auto first = std::int32_t(positions.size());
    for (const std::int32_t v : t) positions.push_back(ball.positions[std::size_t(v)]);
    triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(lowest_places(positions, triangles), lowest_places(ball.positions, ball.triangles));
  EXPECT_EQ(lowest_places(positions, triangles).size(), 1U);
}

}  // namespace
}  // namespace hydrodip
