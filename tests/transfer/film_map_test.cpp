#include "transfer/film_map.h"

#include <gtest/gtest.h>

#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

TEST(FilmMap, IsTheIdentityOnAFlatBottom) {
  const auto dipped = fixtures::mapped(fixtures::slab(), fixtures::film_on_slab(5000));
  EXPECT_NEAR(dipped->map->covered().min.x(), -20, 1e-12);
  EXPECT_NEAR(dipped->map->covered().max.y(), 20, 1e-12);
  for (double x = -19.93; x < 20; x += 1.37)
    for (double y = -19.97; y < 20; y += 1.19) {
      const Vec2 u(x, y);
      const auto point = dipped->map->to_object(u);
      ASSERT_TRUE(point);
      const Vec3 position = position_at(dipped->object, *point);
      EXPECT_LT((position - Vec3(x, y, 0)).norm(), 1e-9);
      const auto back = dipped->map->to_film(position, Vec3(0, 0, -1));
      ASSERT_TRUE(back);
      EXPECT_LT((*back - u).norm(), 1e-9);
      EXPECT_NEAR(dipped->map->area_ratio(u), 1, 1e-12);
    }
}

// Heights of the slab's walls count for this much film.
constexpr double kHeight = 0.65;

// The film on the slab goes on up the walls that it has at x = +-20.
DippedFilm film_over_edges(int elements) {
  DippedFilm film = fixtures::film_on_slab(elements);
  film.z_stretch = kHeight;
  for (std::size_t v = 0; v < film.position.size(); ++v) {
    const Vec2& u = film.mesh().u[v];
    const double beyond = std::abs(u.x()) - fixtures::kHalfSide_mm;
    if (beyond <= 0 || beyond > 4 || std::abs(u.y()) > fixtures::kHalfSide_mm) continue;
    film.position[v] = Vec3(std::copysign(fixtures::kHalfSide_mm, u.x()), u.y(), beyond / kHeight);
    film.state[v] = VertexState::kAttached;
  }
  return film;
}

// On meshes whose lines lie beside the edge.
TEST(FilmMap, FilmOverAnEdgeIsRolledOffBothFaces) {
  for (const int elements : {1800, 5000, 7300}) {
    const auto dipped = fixtures::mapped(fixtures::slab(), film_over_edges(elements));
    for (double x = 18.51; x < 22; x += 0.137)
      for (double y = -17.97; y < 18; y += 3.19) {
        const Vec2 u(y < 0 ? -x : x, y);
        const double beyond = x - fixtures::kHalfSide_mm;
        const bool on_wall = beyond > 0;
        const Vec3 exact(std::copysign(std::min(x, fixtures::kHalfSide_mm), u.x()), y,
                         std::max(0.0, beyond) / kHeight);
        const Vec3 normal = on_wall ? Vec3(std::copysign(1.0, u.x()), 0, 0) : Vec3(0, 0, -1);
        const auto there = dipped->map->to_object(u);
        ASSERT_TRUE(there) << u.transpose();
        EXPECT_LT((position_at(dipped->object, *there) - exact).norm(), 1e-9) << u.transpose();
        const auto back = dipped->map->to_film(exact, normal);
        ASSERT_TRUE(back) << u.transpose();
        EXPECT_LT((*back - u).norm(), 1e-9) << u.transpose();
      }
  }
}

TEST(FilmMap, KnowsWhereNothingLies) {
  const auto dipped = fixtures::mapped(fixtures::slab(), fixtures::film_on_slab(5000));
  EXPECT_FALSE(dipped->map->to_object(Vec2(21.1, 0)));
  EXPECT_FALSE(dipped->map->to_object(Vec2(1000, 0)));
  EXPECT_FALSE(dipped->map->to_object(Vec2(std::nan(""), 0)));
  EXPECT_FALSE(dipped->map->to_film(Vec3(0, 0, 8), Vec3(0, 0, 1)));   // the slab's dry side
  EXPECT_FALSE(dipped->map->to_film(Vec3(20, 0, 4), Vec3(1, 0, 0)));  // its wall
  EXPECT_EQ(dipped->map->area_ratio(Vec2(21.1, 0)), 1);
  EXPECT_FALSE(dipped->map->nearest_covered(Vec2(23.1, 0), 3));
  const auto near = dipped->map->nearest_covered(Vec2(22.9, 1), 3);
  ASSERT_TRUE(near);
  EXPECT_LT((*near - Vec2(20, 1)).norm(), 1e-4);
  EXPECT_TRUE(dipped->map->to_object(*near));
  EXPECT_EQ(dipped->map->nearest_covered(Vec2(3, 4), 3), Vec2(3, 4));
}

TEST(FilmMap, ACursorSpeedsUpButDecidesNothing) {
  const auto dipped = fixtures::mapped(fixtures::slab(), fixtures::film_on_slab(800));
  FilmMap::Cursor cursor;
  for (int i = 0; i < 500; ++i) {
    const Vec2 u(19.9 * std::sin(i * 1.3), 19.9 * std::cos(i * 2.1));
    const auto with = dipped->map->to_object(u, cursor), without = dipped->map->to_object(u);
    ASSERT_TRUE(with && without);
    EXPECT_LT((position_at(dipped->object, *with) - position_at(dipped->object, *without)).norm(),
              1e-9);
  }
}

class FilmMapOnSphere : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const shapes::Shape sphere = shapes::sphere_bowl(30, 29.5);
    dipped_ = fixtures::mapped(
        fixtures::plain_object(sphere),
        exact::dip_shape(sphere, exact::disc_film(10000), exact::untearing(0.2, 16)));
  }
  static void TearDownTestSuite() { dipped_.reset(); }
  static std::unique_ptr<fixtures::Dipped> dipped_;
};
std::unique_ptr<fixtures::Dipped> FilmMapOnSphere::dipped_;

// Nor where the triangle that it remembers lies in another plane than what is beside it.
TEST_F(FilmMapOnSphere, ACursorSpeedsUpButDecidesNothing) {
  FilmMap::Cursor cursor;
  int found = 0;
  for (int i = 0; i < 4000; ++i) {
    const double radius_mm = 0.003 * i, angle = 0.05 * i;
    const Vec2 u(radius_mm * std::cos(angle), radius_mm * std::sin(angle));
    const auto with = dipped_->map->to_object(u, cursor), without = dipped_->map->to_object(u);
    ASSERT_EQ(with.has_value(), without.has_value()) << u.transpose();
    if (!with) continue;
    ++found;
    EXPECT_LT((position_at(dipped_->object, *with) - position_at(dipped_->object, *without)).norm(),
              1e-9);
  }
  EXPECT_GT(found, 3000);
}

TEST_F(FilmMapOnSphere, ThereAndBackIsWhereItStarted) {
  double largest = 0;
  int count = 0;
  for (double radius = 0.3; radius < 23; radius += 0.37) {
    const double angle = 2.4 * count;
    const Vec2 u(radius * std::cos(angle), radius * std::sin(angle));
    const auto point = dipped_->map->to_object(u);
    ASSERT_TRUE(point) << u.transpose();
    const Vec3 position = position_at(dipped_->object, *point);
    EXPECT_NEAR((position - Vec3(0, 0, 30)).norm(), 30, 0.01);
    const auto back =
        dipped_->map->to_film(position, face_normal(dipped_->object, point->triangle));
    ASSERT_TRUE(back) << u.transpose();
    largest = std::max(largest, (*back - u).norm());
    ++count;
  }
  EXPECT_LT(largest, 0.02);
  RecordProperty("largest_um", int(1000 * largest));
}

// The map between vertices is as good as the vertices: against the exact solution.
TEST_F(FilmMapOnSphere, FollowsTheExactSolutionBetweenVertices) {
  const exact::RevolutionTable table(25, 0.65, [](double a) { return a / std::sqrt(900 - a * a); });
  for (double a = 2; a < 24; a += 0.31) {
    const Vec2 out(std::cos(5 * a), std::sin(5 * a));
    const Vec3 position(a * out.x(), a * out.y(), 30 - std::sqrt(900 - a * a));
    const auto u = dipped_->map->to_film(position, (position - Vec3(0, 0, 30)) / 30);
    ASSERT_TRUE(u) << a;
    EXPECT_LT((*u - table(a) * out).norm(), 0.03) << a;
  }
}

}  // namespace
}  // namespace hydrodip
