#include "film/over_edge.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <random>

namespace hydrodip {
namespace {

const Vec3 kUp(0, 0, 1);

// Two faces of an object that meet in an edge through the origin, rolled off so that film on them
// is flat: film coordinate (x, y), y along the edge, is on the first face where x < 0.
struct Edge {
  Vec3 along, first, last;  // in the object with heights scaled, unit, `first` towards the edge
  double z_stretch = 1;

  Vec3 on_object(Vec3 scaled) const {
    scaled.z() /= z_stretch;
    return scaled;
  }
  Vec3 on_face(const Vec2& film, const Vec3& across) const {
    return on_object(film.x() * across + film.y() * along);
  }
  Vec3 at(const Vec2& film) const { return on_face(film, film.x() < 0 ? first : last); }
  Vec3 normal(double x) const {
    return on_object(x < 0 ? first : last).cross(on_object(along)).normalized();
  }
};

Edge random_edge(std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1, 1);
  const auto direction = [&] { return Vec3(number(random), number(random), number(random)); };
  Edge edge;
  edge.along = direction().normalized();
  edge.first = direction().cross(edge.along).normalized();
  const double turn = std::numbers::pi * (0.5 + 0.2 * number(random));
  edge.last = Eigen::AngleAxisd(number(random) < 0 ? turn : -turn, edge.along) * edge.first;
  edge.z_stretch = 0.75 + 0.25 * number(random);
  return edge;
}

TEST(OverEdge, FilmGoesOnAsFarBehindItAsItCameBefore) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  int looked_at = 0;
  for (int n = 0; n < 300; ++n) {
    const Edge edge = random_edge(random);
    const std::array<Vec2, 3> film = {Vec2(-1.2 + number(random), number(random)),
                                      Vec2(1.2 + number(random), -1.2 + number(random)),
                                      Vec2(1.2 + number(random), 1.2 + number(random))};
    std::array<Vec3, 3> placed, normal;
    for (std::size_t k = 0; k < 3; ++k) {
      placed[k] = edge.at(film[k]);
      normal[k] = edge.normal(film[k].x());
    }
    if (normal[0].dot(normal[1]) > 0.85) continue;
    // Asked for a point of the edge.
    const auto is_on_edge = [&](const Vec3& point, double) {
      return point.cross(edge.on_object(edge.along).normalized()).norm() < 1e-9;
    };
    const auto direction = direction_over_edge(placed, normal, kUp, edge.z_stretch, is_on_edge);
    ASSERT_TRUE(direction);
    const auto parts = parts_over_edge(placed, normal, *direction);
    ASSERT_TRUE(parts);
    // The first is the single corner's: cut off by the line x = 0.
    const double to_next = -film[0].x() / (film[1].x() - film[0].x());
    const double to_last = -film[0].x() / (film[2].x() - film[0].x());
    EXPECT_NEAR((*parts)[0].share, to_next * to_last, 1e-9);
    EXPECT_NEAR((*parts)[1].share, 1 - to_next * to_last, 1e-9);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT(((*parts)[0].corner[k] - edge.on_face(film[k], edge.first)).norm(), 1e-9);
      EXPECT_LT(((*parts)[1].corner[k] - edge.on_face(film[k], edge.last)).norm(), 1e-9);
    }
    ++looked_at;
  }
  EXPECT_GT(looked_at, 200);
}

const Vec3 kDown(0, 0, -1), kSide(1, 0, 0);
// Two corners below, one on a wall at x = 1 above.
const std::array<Vec3, 3> kBelowAndBeside = {Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(0, 2, 0)};

bool is_over_edge(const std::array<Vec3, 3>& normal, double z_stretch = 0.65,
                  const std::array<Vec3, 3>& position = kBelowAndBeside, bool is_near = true) {
  return direction_over_edge(position, normal, kUp, z_stretch,
                             [&](const Vec3&, double) { return is_near; })
      .has_value();
}

TEST(OverEdge, IsNotWhereFacesAreOneOrRoundOrUnknown) {
  const Vec3 tilted = Vec3(0.2, 0, -1).normalized();
  EXPECT_FALSE(is_over_edge({kDown, kDown, kDown}));
  EXPECT_FALSE(is_over_edge({kDown, tilted, kDown}));
  EXPECT_FALSE(is_over_edge({kDown, kSide, Vec3::Zero()}));
  EXPECT_FALSE(is_over_edge({kDown, Vec3(-kDown), kDown}));  // a thin wall's sides
  EXPECT_TRUE(is_over_edge({kDown, kSide, kDown}));
  EXPECT_TRUE(is_over_edge({kDown, kSide, kDown}, 0));
}

TEST(OverEdge, IsNotWhereTheFacesDoNotMeetOnTheObject) {
  EXPECT_FALSE(is_over_edge({kDown, kSide, kDown}, 0.65, kBelowAndBeside, false));
  // Terraces: the corners below are on two of them.
  EXPECT_FALSE(
      is_over_edge({kDown, kSide, kDown}, 0.65, {Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(0, 2, 0.5)}));
}

TEST(OverEdge, AtACornerEachFaceCountsOnce) {
  const std::array<Vec3, 3> faces = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)};
  const std::array<Vec3, 3> corners = {Vec3(3, 2, 5), Vec3(2, 3, 5), Vec3(2, 2, 4)};
  const auto is_corner = [](const Vec3& point, double) {
    return (point - Vec3(3, 3, 4)).norm() < 1e-9;
  };
  const auto direction = direction_over_edge(corners, faces, kUp, 1, is_corner);
  ASSERT_TRUE(direction);
  EXPECT_LT((*direction - Vec3(1, 1, -1).normalized()).norm(), 1e-12);
  EXPECT_FALSE(parts_over_edge(corners, faces, *direction));
}

}  // namespace
}  // namespace hydrodip
