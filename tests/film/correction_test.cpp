#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "base/error.h"
#include "film/film.h"
#include "film/locate.h"

namespace hydrodip {
namespace {

FilmCorrection field(const std::function<Vec2(const Vec2&)>& move) {
  FilmCorrection result{{-60, -80}, 5, 25, 33, {}};
  for (int j = 0; j < result.ny; ++j)
    for (int i = 0; i < result.nx; ++i) result.move.push_back(move(result.first + 5 * Vec2(i, j)));
  return result;
}

TEST(Correction, KeepsWhatIsAffineAndFollowsWhatIsSmooth) {
  const auto affine = [](const Vec2& u) -> Vec2 {
    return {0.3 + 0.01 * u.x() - 0.02 * u.y(), -0.2 + 0.005 * u.y()};
  };
  const auto smooth = [](const Vec2& u) -> Vec2 {
    return {std::sin(u.x() / 30), std::cos(u.y() / 25 + u.x() / 40)};
  };
  const FilmCorrection a = field(affine), s = field(smooth);
  for (const Vec2& u : {Vec2(0, 0), Vec2(13.7, -21.2), Vec2(-44.1, 60.3)}) {
    EXPECT_LT((a.at(u) - affine(u)).norm(), 1e-12);
    EXPECT_LT((s.at(u) - smooth(u)).norm(), 2e-3);
  }
  // Beyond its edge as on it.
  EXPECT_LT((a.at({500, 0}) - a.at({60, 0})).norm(), 1e-12);
  EXPECT_EQ(FilmCorrection().at({1, 2}), Vec2(0, 0));
}

TEST(Correction, ThatSaysNothingSomewhereIsAsFarAsCanBe) {
  FilmCorrection some = field([](const Vec2&) -> Vec2 { return {0.2, -0.7}; });
  EXPECT_EQ(some.farthest_mm(), 0.7);
  some.move[7].y() = std::nan("");
  EXPECT_EQ(some.farthest_mm(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(FilmCorrection().farthest_mm(), 0);
}

TEST(Correction, MovesWhatIsPrintedAndNotWhatFloats) {
  FilmOptions options{.width_mm = 100, .height_mm = 120, .margin_mm = 5, .elements = 2000};
  const FilmMesh plain = make_film_mesh(options);
  EXPECT_TRUE(plain.wet.empty());
  options.correction = std::make_shared<const FilmCorrection>(field([](const Vec2& u) -> Vec2 {
    return {1 + 0.02 * u.y(), -0.5};
  }));
  const FilmMesh moved = make_film_mesh(options);
  ASSERT_EQ(moved.u.size(), plain.u.size());
  for (std::size_t v = 0; v < plain.u.size(); ++v) {
    EXPECT_EQ(moved.wet[v], plain.u[v]);
    EXPECT_LT((moved.u[v] - plain.u[v] - Vec2(1 + 0.02 * plain.u[v].y(), -0.5)).norm(), 1e-9);
  }
  // Places of the sheet are still found.
  for (const Vec2& u : {Vec2(0, 0), Vec2(31.3, -42.7), Vec2(-20.9, 15.1)}) {
    const FilmLocation at = locate_flat(moved, u);
    ASSERT_TRUE(at.inside);
    Vec2 found = Vec2::Zero();
    for (int k = 0; k < 3; ++k)
      found += at.weight[k] *
               moved.u[std::size_t(moved.triangles[std::size_t(at.triangle)][std::size_t(k)])];
    EXPECT_LT((found - u).norm(), 1e-9);
  }
}

TEST(Correction, ThatFoldsIsRefused) {
  FilmOptions options{.width_mm = 100, .height_mm = 120, .margin_mm = 5, .elements = 2000};
  options.correction = std::make_shared<const FilmCorrection>(field([](const Vec2& u) -> Vec2 {
    return {-2 * u.x(), 0};
  }));
  EXPECT_THROW(make_film_mesh(options), InputError);
}

}  // namespace
}  // namespace hydrodip
