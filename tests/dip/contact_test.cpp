#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "base/error.h"
#include "dip/scheme.h"
#include "exact/dipping.h"

namespace hydrodip {
namespace {

class BoxContact : public testing::Test {
 protected:
  std::optional<Contact> contact(const Vec3& from, const Vec3& to) const {
    return first_contact(surface_, from, to);
  }

 private:
  shapes::Shape box_ = shapes::box(Vec3(-10, -10, 2), Vec3(10, 10, 12));
  Surface surface_{box_.positions, box_.triangles};
};

TEST_F(BoxContact, IsWhereTheWayMeetsTheObjectFirst) {
  const auto bottom = contact(Vec3(1, 2, 0), Vec3(1, 2, 20));
  ASSERT_TRUE(bottom);
  EXPECT_LT((bottom->position - Vec3(1, 2, 2)).norm(), 1e-9);
  EXPECT_LT((bottom->normal - Vec3(0, 0, -1)).norm(), 1e-12);
  const auto wall = contact(Vec3(15, 1, 5), Vec3(5, 2, 6));  // sideways into the wall
  ASSERT_TRUE(wall);
  EXPECT_LT((wall->position - Vec3(10, 1.5, 5.5)).norm(), 1e-9);
  EXPECT_LT((wall->normal - Vec3(1, 0, 0)).norm(), 1e-12);
}

TEST_F(BoxContact, CountsBothEndsAndNothingBeyond) {
  EXPECT_TRUE(contact(Vec3(1, 2, 1), Vec3(1, 2, 2)));
  EXPECT_TRUE(contact(Vec3(1, 2, 2), Vec3(1, 2, 3)));
  EXPECT_FALSE(contact(Vec3(1, 2, 1), Vec3(1, 2, 1.99)));
  EXPECT_FALSE(contact(Vec3(1, 2, 0), Vec3(1, 2, 0)));    // no way at all
  EXPECT_FALSE(contact(Vec3(11, 2, 0), Vec3(11, 2, 9)));  // past the wall
}

TEST(DipOptions, OutOfRangeAreRefused) {
  const shapes::Shape box = shapes::box(Vec3(-10, -10, 0), Vec3(10, 10, 5));
  const FilmMesh film = exact::disc_film(200);
  const auto refused = [&](const auto& change) {
    exact::StraightDip options;
    change(options);
    EXPECT_THROW(exact::dip_shape(box, film, options), InputError);
  };
  refused([](exact::StraightDip& o) { o.step_mm = 0; });
  refused([](exact::StraightDip& o) { o.step_mm = std::nan(""); });
  refused([](exact::StraightDip& o) { o.depth_mm = -1; });
  refused([](exact::StraightDip& o) { o.material.poisson = 0.5; });
  refused([](exact::StraightDip& o) { o.material.z_stretch = -0.1; });
  refused([](exact::StraightDip& o) { o.modulus = {1, 2, 3}; });
}

TEST(Dip, CanBeCancelled) {
  const shapes::Shape box = shapes::box(Vec3(-10, -10, 0), Vec3(10, 10, 5));
  const Surface surface(box.positions, box.triangles);
  RunContext context;
  context.cancel();
  EXPECT_THROW(dip(exact::disc_film(200), box.positions, box.triangles, surface,
                   Trajectory::straight_down(5), DipOptions{}, context),
               Cancelled);
}

TEST(Dip, ReachesTheAskedDepth) {
  const shapes::Shape box = shapes::box(Vec3(-10, -10, 0), Vec3(10, 10, 5));
  const FilmMesh film = exact::disc_film(200);
  EXPECT_DOUBLE_EQ(exact::dip_shape(box, film, exact::untearing(0.5, 3.3)).depth_mm, 3.3);
  EXPECT_DOUBLE_EQ(exact::dip_shape(box, film, exact::untearing(0.5, 0)).depth_mm, 5);
  EXPECT_DOUBLE_EQ(exact::dip_shape(box, film, exact::untearing(0.5, 99)).depth_mm, 5);
}

// Finds no direction, ever.
class NoSolver : public LinearSolver {
 public:
  void update(const FilmEnergy&, const GridField&, const std::vector<std::uint8_t>&, bool,
              double) override {}
  std::optional<SearchDirection> direction(const GridField&) override { return std::nullopt; }
};

TEST(Dip, GivesUpWhereTooManyStepsFail) {
  const shapes::Shape box = shapes::box(Vec3(-10, -10, 0), Vec3(10, 10, 5));
  const FilmMesh film = exact::disc_film(200);
  const Surface surface(box.positions, box.triangles);
  auto options = exact::untearing(0.5, 3);
  options.make_solver = [](const FilmMesh&) { return std::make_unique<NoSolver>(); };
  RunContext context;
  const auto dip_box = [&] {
    return dip(film, box.positions, box.triangles, surface, Trajectory::straight_down(3), options,
               context)
        .statistics;
  };
  const DipStatistics all_failed = dip_box();
  EXPECT_EQ(all_failed.failed_steps, all_failed.steps);
  EXPECT_FALSE(context.warnings().empty());
  options.failed_share_max = 0.02;
  EXPECT_THROW(dip_box(), DipError);
}

}  // namespace
}  // namespace hydrodip
