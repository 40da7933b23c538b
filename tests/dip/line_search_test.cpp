// Where feet begin on the contact line and where they go: ahead towards their floating vertex, but
// never far, never behind, and outward whichever way faces are turned.
#include "dip/line_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "exact/shapes.h"

namespace hydrodip {
namespace {

constexpr double kCell_mm = 2;

struct Cut {
  explicit Cut(shapes::Shape what, double depth_mm = 3)
      : shape(std::move(what)), line(shape.positions, shape.triangles, kCell_mm) {
    line.move_to(Moment::at_depth(depth_mm));
  }
  LineSearch search() const { return {line, kCell_mm}; }

  shapes::Shape shape;
  Waterline line;
};

shapes::Shape inside_out(shapes::Shape shape) {
  for (Triangle& t : shape.triangles) std::swap(t[1], t[2]);
  return shape;
}

// Where a foot goes from there.
Waterline::Point next(const LineSearch& search, const Vec2& from, const Vec2& floating,
                      const Vec2& outward) {
  return search.ahead(from, floating).value_or(search.line_near(from, outward));
}

TEST(LineSearch, AFootGoesAheadOnASlopeAndStraightUpAWall) {
  const Cut cone(shapes::cone(20, 1), 5), box(shapes::box({-10, -10, 0}, {10, 10, 6}));
  const auto ahead = cone.search().ahead(Vec2(4.5, 0), Vec2(7, 2));
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->position.norm(), 5, 1e-3);
  EXPECT_NEAR(cross2(ahead->position - Vec2(4.5, 0), Vec2(2.5, 2)), 0, 1e-9);
  EXPECT_NEAR(ahead->steepness, 1, 1e-3);
  // The water has no way to gain on it: where it stood it stays.
  const Waterline::Point up = next(box.search(), Vec2(10, 1), Vec2(12, 3), Vec2(1, 0));
  EXPECT_LT((up.position - Vec2(10, 1)).norm(), 1e-9);
  EXPECT_GT(up.steepness, 1e5);
}

// Once the water stands over a shelf, its far edge is no place for a foot that stood before it.
TEST(LineSearch, AFootNeverLeapsFarAhead) {
  const Cut plate(shapes::box({-30, -30, 0}, {30, 30, 6}));
  for (const double from : {-28.0, 0.0, 20.0, 24.0, 26.0, 29.0}) {
    const Vec2 start(from, 1);
    const Waterline::Point end = next(plate.search(), start, Vec2(40, 1), Vec2(1, 0));
    EXPECT_LT((end.position - start).norm(), LineSearch::kMaxJump * kCell_mm) << from;
    // Far from any line it goes straight up where it is.
    if (std::abs(from) < 24) {
      EXPECT_LT((end.position - start).norm(), 1e-12) << from;
      EXPECT_EQ(end.steepness, kWall);
      EXPECT_EQ(end.outward, Vec2(1, 0));
    } else if (from > 0) {
      EXPECT_NEAR(end.position.x(), from > 25 ? 30 : from, 1e-9);
    }
  }
}

TEST(LineSearch, ALineFacesAsTheFacesDo) {
  const Cut right(shapes::cone(20, 1), 5), wrong(inside_out(shapes::cone(20, 1)), 5);
  const Vec2 beside(4.5, 0);
  const auto of_right = right.search().near(beside), of_wrong = wrong.search().near(beside);
  ASSERT_TRUE(of_right);
  ASSERT_TRUE(of_wrong);
  EXPECT_NEAR(of_right->outward.dot(Vec2(1, 0)), 1, 1e-3);
  EXPECT_NEAR(of_right->outward.dot(Vec2(0, 1)), 0, 0.05);
  EXPECT_NEAR(of_right->outward.dot(Vec2(-1, 0)), -1, 1e-3);
  EXPECT_NEAR(of_wrong->outward.dot(Vec2(1, 0)), -1, 1e-3);
  EXPECT_FALSE(right.search().near(Vec2(12, 0)));
}

// A foot knows where outside is: where it came from, or where its floating vertex is.
TEST(LineSearch, OutwardIsOutwardWhicheverWayFacesAreTurned) {
  const Cut right(shapes::cone(20, 1), 5), wrong(inside_out(shapes::cone(20, 1)), 5);
  for (int n = 0; n < 12; ++n) {
    const double angle = 0.1 + 2 * M_PI * n / 12;
    const Vec2 out(std::cos(angle), std::sin(angle));
    for (const double radius : {4.6, 5.3}) {
      const Waterline::Point a = right.search().line_near(radius * out, out);
      const Waterline::Point b = wrong.search().line_near(radius * out, out);
      EXPECT_GT(a.outward.dot(out), 0.999);
      EXPECT_NEAR(a.steepness, 1, 1e-3);
      EXPECT_LT((a.position - b.position).norm(), 1e-9);
      EXPECT_LT((a.outward - b.outward).norm(), 1e-9);
      EXPECT_NEAR(a.steepness, b.steepness, 1e-9);
    }
  }
}

// A vertex that touches beside the line has its foot next to it, but not behind it where there is
// a line ahead.
TEST(LineSearch, AFootBeginsWhereItsEdgeLeavesOrBesideItsVertex) {
  shapes::Shape pair = shapes::box({-10, -10, 0}, {10, 10, 6});
  pair.append(shapes::box({14, -10, 0}, {40, 10, 6}));
  const Cut gap(std::move(pair));
  const auto first = [&](double from, double to) {
    return gap.search().first_on_line(Vec2(from, 1), Vec2(to, 1)).position.x();
  };
  EXPECT_NEAR(first(8, 12), 10, 1e-12);
  EXPECT_NEAR(first(10.05, 12), 10, 1e-9);
  EXPECT_NEAR(first(11.5, 13.5), 14, 1e-9);
  // The lines are at 10 and 14: no foot begins at the vertex that goes on floating.
  EXPECT_NEAR(first(11.5, 12.1), 11.5, 1e-12);
}

}  // namespace
}  // namespace hydrodip
