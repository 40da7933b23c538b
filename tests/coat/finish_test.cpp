#include "coat/finish.h"

#include <gtest/gtest.h>

#include <cmath>

#include "coat/design.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

// Everything, or in halves with a gap at x = 0, of the sample box's flat bottom.
enum class Part { kAll, kLeft, kRight, kThird, kTwoThirds };

class TwoCoats : public testing::Test {
 protected:
  Coat coat(Part part, bool first) {
    DesignOptions options;
    options.film.width_mm = options.film.height_mm = 120;
    options.film.elements = 4000;
    options.trajectory.depth_mm = 3;
    options.dip.step_mm = 1;
    options.dpi = 72;
    options.rounds_max = 1;
    const Allotment allotment([this, part](const SurfacePoint& point) {
      const double x = position_at(posed_.mesh(), point).x();
      if (part == Part::kThird) return 1 / 3.0F;
      if (part == Part::kTwoThirds) return 2 / 3.0F;
      const bool left = x < 0;
      return part == Part::kAll || left == (part == Part::kLeft) ? 1.0F : 0.0F;
    });
    Timings timings;
    RunContext context;
    const auto model = make_device_model();
    Designed made = design({posed_, *paint_, allotment, *model, options}, timings, context);
    const FilmInk& ink = made.ink.ink;
    const LinearColor under = first ? paint_->base() : LinearColor{1, 1, 1, 1};
    return {made.dipped, raster_of(options.film, options.dpi),
            std::make_shared<const Image>(
                look_on_object(ink.inking.inks, ink.stretch.area_ratio, *model, under))};
  }

  // On the bottom, half a pixel and more off the seam.
  template <class Check>
  int for_points(const Check& check) {
    int points = 0;
    for (double x = -15; x <= 15; x += 1.5)
      for (double y = -15; y <= 15; y += 1.5) {
        if (std::abs(x) < 1) continue;
        const auto hit = posed_.surface().first_hit({x, y, -1}, {0, 0, 1}, 0, 10);
        if (!hit) continue;
        check(SurfacePoint{hit->triangle, hit->u, hit->v});
        ++points;
      }
    return points;
  }

  // Within a millimetre.
  bool is_one_color_around(const SurfacePoint& point) const {
    const LinearColor here = paint_->color_at(point);
    const Vec3 p = position_at(posed_.mesh(), point);
    for (const double dx : {-1.0, 0.0, 1.0})
      for (const double dy : {-1.0, 0.0, 1.0}) {
        const auto hit = posed_.surface().first_hit({p.x() + dx, p.y() + dy, -1}, {0, 0, 1}, 0, 10);
        if (!hit) return false;
        const LinearColor there = paint_->color_at({hit->triangle, hit->u, hit->v});
        if (std::abs(there.r - here.r) > 0.01F || std::abs(there.g - here.g) > 0.01F) return false;
      }
    return true;
  }

  std::shared_ptr<const Object> object_ = std::make_shared<const Object>(make_sample("box"));
  PosedObject posed_{object_, {}};
  std::shared_ptr<const Paint> paint_ = model_paint(object_, {0.8F, 0.9F, 0.7F, 1});
};

TEST_F(TwoCoats, HalvesMakeTheWhole) {
  const Finish whole(paint_, {coat(Part::kAll, true)});
  const Finish halves(paint_, {coat(Part::kLeft, true), coat(Part::kRight, false)});
  EXPECT_GT(for_points([&](const SurfacePoint& point) {
              const LinearColor a = whole.color_at(point), b = halves.color_at(point);
              EXPECT_NEAR(a.r, b.r, 0.01);
              EXPECT_NEAR(a.g, b.g, 0.01);
              EXPECT_NEAR(a.b, b.b, 0.01);
            }),
            200);
}

// Within one colour: where a pixel mixes two, parts of their inks make another mixture.
TEST_F(TwoCoats, PartsOfTheInkMakeTheWhole) {
  const Finish whole(paint_, {coat(Part::kAll, true)});
  const Finish parts(paint_, {coat(Part::kThird, true), coat(Part::kTwoThirds, false)});
  int even = 0;
  for_points([&](const SurfacePoint& point) {
    if (!is_one_color_around(point)) return;
    ++even;
    const LinearColor a = whole.color_at(point), b = parts.color_at(point);
    EXPECT_NEAR(a.r, b.r, 0.012);
    EXPECT_NEAR(a.g, b.g, 0.012);
    EXPECT_NEAR(a.b, b.b, 0.012);
  });
  EXPECT_GT(even, 80);
}

TEST_F(TwoCoats, OnlyLaterCoatsLandOff) {
  const Finish halves(paint_, {coat(Part::kLeft, true), coat(Part::kRight, false)});
  // The right half moved by 4 mm to the left lies over the left one, and leaves a gap at its end.
  const auto at = [&](double x) {
    const auto hit = posed_.surface().first_hit({x, 5, -1}, {0, 0, 1}, 0, 10);
    return SurfacePoint{hit->triangle, hit->u, hit->v};
  };
  const Vec2 off(4, 0);
  EXPECT_EQ(halves.color_at(at(-8), off).g, halves.color_at(at(-8)).g);
  EXPECT_LT(halves.color_at(at(-2), off).g, halves.color_at(at(-2)).g - 0.01);
  EXPECT_TRUE(halves.has_film_at(at(-8)));
}

TEST_F(TwoCoats, TwiceTheSameFilmFiltersTwice) {
  const Finish once(paint_, {coat(Part::kAll, true)});
  const Finish twice(paint_, {coat(Part::kAll, true), coat(Part::kAll, false)});
  for_points([&](const SurfacePoint& point) {
    const LinearColor a = once.color_at(point), b = twice.color_at(point);
    const LinearColor& base = paint_->base();
    EXPECT_NEAR(b.r, a.r * a.r / base.r, 0.02);
    EXPECT_NEAR(b.g, a.g * a.g / base.g, 0.02);
    EXPECT_NEAR(b.b, a.b * a.b / base.b, 0.02);
  });
}

TEST_F(TwoCoats, WhereNoFilmLiesTheBareObjectShows) {
  const Finish finish(paint_, {coat(Part::kAll, true), coat(Part::kAll, false)});
  const auto top = posed_.surface().first_hit({3, 4, 100}, {0, 0, -1}, 0, 200);
  ASSERT_TRUE(top);
  const LinearColor seen = finish.color_at({top->triangle, top->u, top->v});
  EXPECT_EQ(seen.r, paint_->base().r);
  EXPECT_EQ(seen.g, paint_->base().g);
  EXPECT_EQ(seen.b, paint_->base().b);
}

}  // namespace
}  // namespace hydrodip
