// Which film goes with film that lets go: what is cut off, and threads; and what becomes of film
// that blocks the rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "dip/feet.h"
#include "dip/tears.h"
#include "exact/shapes.h"
#include "film/locate.h"

namespace hydrodip {
namespace {

// Film that floats and has nothing to do yet with the box high above it.
class Afloat {
 public:
  explicit Afloat(double tear_stretch)
      : film(make_film_mesh(
            {.width_mm = 120, .height_mm = 120, .margin_mm = 10, .elements = 2000, .grading = 1})) {
    options.material.tear_stretch = tear_stretch;
    for (std::size_t v = 0; v < film.u.size(); ++v) {
      state.position.emplace_back(film.u[v].x(), film.u[v].y(), 0);
      state.state.push_back(film.on_rim[v] ? VertexState::kClamped : VertexState::kUnattached);
    }
    state.torn.assign(film.triangles.size(), 0);
    state.lifted.assign(film.u.size(), 0);
    state.torn_at_mm.assign(film.triangles.size(), std::numeric_limits<double>::infinity());
  }

  Vec2 centre(std::size_t t) const {
    Vec2 sum = Vec2::Zero();
    for (const std::int32_t v : film.triangles[t]) sum += film.u[std::size_t(v)] / 3;
    return sum;
  }
  // Tells film whose middle is there to let go after a millimetre, which is now.
  void let_go(const std::function<bool(const Vec2&)>& where) {
    options.tears_at_mm.clear();
    for (std::size_t t = 0; t < film.triangles.size(); ++t)
      options.tears_at_mm.push_back(where(centre(t)) ? 1.0
                                                     : std::numeric_limits<double>::infinity());
    FloatingSheet sheet(setting(), state);
    Tears(setting(), state).release_overstretched(1, sheet);
  }
  DipSetting setting() const {
    return {film, box.positions, box.triangles, surface, options, travel, context};
  }
  bool torn_at(const Vec2& u) const {
    return state.torn[std::size_t(locate_flat(film, u).triangle)] != 0;
  }

  FilmMesh film;
  DipOptions options;
  DipState state;

 private:
  shapes::Shape box = shapes::box({-5, -5, 0}, {5, 5, 9});
  Surface surface{box.positions, box.triangles};
  Travel travel{Trajectory::straight_down(9), box.positions, box.triangles};
  RunContext context;
};

TEST(LetGo, WhatIsCutOffGoesAndWhatTheRimHoldsStays) {
  Afloat film(0);
  film.let_go([](const Vec2& u) { return u.norm() > 20 && u.norm() < 25; });
  for (std::size_t t = 0; t < film.state.torn.size(); ++t) {
    const double r = film.centre(t).norm();
    if (r < 25) {
      EXPECT_TRUE(film.state.torn[t]) << r;
      EXPECT_EQ(film.state.torn_at_mm[t], 1);
    } else if (r > 25 + 2 * film.film.cell_mm) {
      EXPECT_FALSE(film.state.torn[t]) << r;
    }
  }
}

// A gap right through the film with one row of cells across it.
TEST(LetGo, AThreadGoesAndABroadBridgeStays) {
  const double cell = Afloat(0).film.cell_mm;
  for (const double cells : {1.0, 5.0}) {
    Afloat film(0);
    film.let_go([&](const Vec2& u) {
      return std::abs(u.x()) < 20 && (u.y() < 0 || u.y() > cells * cell) && std::abs(u.y()) < 40;
    });
    EXPECT_EQ(film.torn_at({0.3, 0.5 * cells * cell}), cells < 2) << cells;
    EXPECT_FALSE(film.torn_at({-35, 2}));
    EXPECT_FALSE(film.torn_at({35, 2}));
    EXPECT_FALSE(film.torn_at({0.3, 47}));
  }
}

// Film in the way of all other film lets go, if it ever does; else its corners stay where they are.
TEST(LetGo, FilmInTheWayGoesOrIsHeld) {
  for (const double tear_stretch : {0.0, 1.4}) {
    Afloat film(tear_stretch);
    FloatingSheet sheet(film.setting(), film.state);
    std::vector<std::uint8_t> is_free = sheet.free_vertices();
    const std::int32_t blocked = locate_flat(film.film, {3, 4}).triangle;
    Tears(film.setting(), film.state).release({blocked}, 2.5, sheet, is_free);
    EXPECT_EQ(film.state.torn[std::size_t(blocked)] != 0, tear_stretch > 0);
    EXPECT_EQ(std::count(film.state.torn.begin(), film.state.torn.end(), 1), tear_stretch > 0);
    const Triangle& corners = film.film.triangles[std::size_t(blocked)];
    for (std::size_t v = 0; v < is_free.size(); ++v) {
      const bool corner =
          std::find(corners.begin(), corners.end(), std::int32_t(v)) != corners.end();
      EXPECT_EQ(is_free[v] != 0, !film.film.on_rim[v] && (tear_stretch > 0 || !corner)) << v;
    }
    EXPECT_EQ(sheet.is_usable(std::size_t(blocked)), tear_stretch == 0);
  }
}

}  // namespace
}  // namespace hydrodip
