// What a film prints of a pixel's points where it shares the object with others.
#include "transfer/printed.h"

#include <gtest/gtest.h>

#include <cmath>

#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

const LinearColor kBase{0.9F, 0.8F, 0.7F, 1};

// Darker along u.
class GradedPaint : public Paint {
 public:
  GradedPaint() : Paint(kBase) {}
  LinearColor color_at(const SurfacePoint& point) const override {
    const auto u = float(point.u);
    return {0.8F - 0.7F * u, 0.6F - 0.4F * u, 0.5F, 1};
  }
  bool says_anything() const override { return true; }
};

constexpr SurfaceGrid kGrid{{0, 0.2, 0.3}, 0.03, 0.01, -0.01, 0.03, 3};

Vec2 anywhere(int, int) { return {0, 0}; }

LinearColor mean_of_points(const Printed& printed) {
  ColorSum sum;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      sum.add(printed.at(kGrid.at(column, row), {0, 0}), 1.0F / 9);
  return sum.color();
}

double level(float linear) { return linear_to_srgb8(linear); }

TEST(Printed, APartOfTheInkLeavesThatPowerOfTheLight) {
  const GradedPaint paint;
  const Allotment half([](const SurfacePoint&) { return 0.5F; });
  const Printed whole(paint, Allotment()), part(paint, half);
  const SurfacePoint point{0, 0.4, 0.1};
  const LinearColor w = whole.at(point, {0, 0}), p = part.at(point, {0, 0});
  EXPECT_NEAR(p.r / kBase.r, std::sqrt(w.r / kBase.r), 1e-6);
  EXPECT_NEAR(p.g / kBase.g, std::sqrt(w.g / kBase.g), 1e-6);
  EXPECT_EQ(p.a, 1);
}

// As in a seam's fade: far slower than a pixel is wide, or just as wide as it.
TEST(Printed, AFadesMeanIsThatOfItsPointsWithinALevel) {
  const GradedPaint paint;
  for (const float slope : {0.0F, 0.5F, 1.5F, 8.0F}) {
    const Allotment fade([slope](const SurfacePoint& point) {
      return std::clamp(0.5F + slope * float(point.u - 0.22), 0.0F, 1.0F);
    });
    const Printed printed(paint, fade);
    const LinearColor told = printed.mean(kGrid, anywhere), points = mean_of_points(printed);
    EXPECT_NEAR(level(told.r), level(points.r), 1) << slope;
    EXPECT_NEAR(level(told.g), level(points.g), 1) << slope;
    EXPECT_NEAR(told.a, points.a, 1e-6) << slope;
  }
}

// At a film's border.
TEST(Printed, WhereASharesJumpsEveryPointCounts) {
  const GradedPaint paint;
  const Allotment jump([](const SurfacePoint& point) { return point.u < 0.22 ? 0.0F : 0.7F; });
  const Printed printed(paint, jump);
  const LinearColor told = printed.mean(kGrid, anywhere), points = mean_of_points(printed);
  EXPECT_EQ(told.r, points.r);
  EXPECT_EQ(told.a, points.a);
  EXPECT_GT(told.a, 0.1);
  EXPECT_LT(told.a, 0.9);
}

// What holds for a whole triangle is not asked of its points.
TEST(Printed, OfAnothersTriangleNothingIsPrinted) {
  const GradedPaint paint;
  const auto never = [](const SurfacePoint&) -> float { throw std::logic_error("asked"); };
  const Allotment none(never, [](int) { return std::optional(0.0F); });
  EXPECT_EQ(Printed(paint, none).mean(kGrid, anywhere).a, 0);
  const Allotment all(never, [](int) { return std::optional(1.0F); });
  const LinearColor told = Printed(paint, all).mean(kGrid, anywhere);
  const LinearColor points = mean_of_points(Printed(paint, Allotment()));
  EXPECT_EQ(told.r, points.r);
  EXPECT_EQ(told.b, points.b);
}

}  // namespace
}  // namespace hydrodip
