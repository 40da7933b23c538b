// A wall thinner than the film's mesh is wide: which of its two sides the film lies on.
#include <gtest/gtest.h>

#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

using fixtures::kHalfSide_mm;

TEST(ThinWall, FilmOnOneSideLeavesTheOtherBare) {
  const double thickness_mm = 1;
  const auto wall = fixtures::mapped(
      fixtures::plain_object(shapes::box(Vec3(-kHalfSide_mm, -kHalfSide_mm, 0),
                                         Vec3(kHalfSide_mm, kHalfSide_mm, thickness_mm))),
      fixtures::film_on_slab(2000));
  ASSERT_GT(wall->film.mesh().cell_mm, thickness_mm);
  for (double x = -18; x <= 18; x += 4)
    for (double y = -18; y <= 18; y += 4) {
      const auto filmed = wall->map->to_film(Vec3(x, y, 0), Vec3(0, 0, -1));
      ASSERT_TRUE(filmed);
      EXPECT_LT((*filmed - Vec2(x, y)).norm(), 1e-6);
      EXPECT_FALSE(wall->map->to_film(Vec3(x, y, thickness_mm), Vec3(0, 0, 1)));
      EXPECT_FALSE(wall->map->torn_at(Vec3(x, y, 0), Vec3(0, 0, -1)));
    }
}

// In a slot, film lies on the side that it is nearer to, whichever way its normal points.
TEST(ThinWall, FilmInASlotLandsOnTheNearerSide) {
  const Vec3 reach(kHalfSide_mm, kHalfSide_mm, 0);
  shapes::Shape fork = shapes::box(-reach, reach + Vec3(0, 0, 8));
  fork.append(shapes::box(-reach - Vec3(0, 0, 9), reach - Vec3(0, 0, 1)));
  DippedFilm film = fixtures::film_on_slab(2000);
  for (Vec3& at : film.position) at.z() -= 0.3;
  const auto dipped = fixtures::mapped(fixtures::plain_object(fork), std::move(film));
  ASSERT_GT(dipped->film.mesh().cell_mm, 1);
  for (double x = -18; x <= 18; x += 4) {
    const auto on = dipped->map->to_object(Vec2(x, 0.5 * x));
    ASSERT_TRUE(on);
    EXPECT_LT((position_at(dipped->object, *on) - Vec3(x, 0.5 * x, 0)).norm(), 1e-9);
  }
}

TEST(ThinWall, FilmThatToreIsFoundOnItsOwnSideOnly) {
  DippedFilm film = fixtures::film_on_slab(2000);
  film.torn.assign(film.torn.size(), 1);
  const auto wall =
      fixtures::mapped(fixtures::plain_object(shapes::box(Vec3(-kHalfSide_mm, -kHalfSide_mm, 0),
                                                          Vec3(kHalfSide_mm, kHalfSide_mm, 1))),
                       std::move(film));
  EXPECT_TRUE(wall->map->torn_at(Vec3(3, 5, 0), Vec3(0, 0, -1)));
  EXPECT_FALSE(wall->map->torn_at(Vec3(3, 5, 1), Vec3(0, 0, 1)));
  EXPECT_FALSE(wall->map->to_film(Vec3(3, 5, 0), Vec3(0, 0, -1)));
}

}  // namespace
}  // namespace hydrodip
