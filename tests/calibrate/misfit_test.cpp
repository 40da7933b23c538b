#include "calibrate/misfit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace hydrodip {
namespace {

constexpr double kSlope = 2, kShear = 0.5;

// Where a film lies that is stretched and sheared over a tilted plane.
Landing landing_at(const Vec2& u) {
  Landing landing;
  landing.by_film << kSlope, kShear, 0, 1, 0.25, -1;
  landing.position = landing.by_film * u + Vec3(3, -4, 20);
  return landing;
}

// Of different reach along the two axes, so that they cannot be mistaken for each other.
Landings landings_on(const Board& board, const GridPlace& reach) {
  Landings landings;
  landings.reach = reach;
  for (int row = -reach[1]; row <= reach[1]; ++row)
    for (int column = -reach[0]; column <= reach[0]; ++column)
      landings.corner.emplace_back(landing_at(board.on_film({column, row})));
  return landings;
}

std::vector<GridPlace> places_within(const GridPlace& reach) {
  std::vector<GridPlace> places;
  for (int row = -reach[1]; row <= reach[1]; ++row)
    for (int column = -reach[0]; column <= reach[0]; ++column) places.push_back({column, row});
  return places;
}

// How much of a vector lies outside of a space.
double outside(const Eigen::VectorXd& vector, const Eigen::MatrixXd& space) {
  return without(vector, orthonormal(space)).norm() / vector.norm();
}

TEST(LandingsTest, CornersAreFoundAtTheirPlacesAndNowhereElse) {
  const Board board = black_board(5);
  const GridPlace reach{2, 1};
  Landings landings = landings_on(board, reach);
  for (const GridPlace& place : places_within({4, 3})) {
    const Landing* found = landings.find(place);
    const bool is_within = std::abs(place[0]) <= reach[0] && std::abs(place[1]) <= reach[1];
    ASSERT_EQ(found != nullptr, is_within) << place[0] << " " << place[1];
    if (found == nullptr) continue;
    EXPECT_EQ(found->position, landing_at(board.on_film(place)).position);
  }
  landings.corner[landings.index_of({2, -1})].reset();
  EXPECT_EQ(landings.find({2, -1}), nullptr);
  EXPECT_NE(landings.find({-2, 0}), nullptr);
}

TEST(LandingsTest, TheFilmsPointFollowsTheObjectsAndNotWhatIsAcrossTheSurface) {
  const Landing landing = landing_at({0, 0});
  const Eigen::Matrix<double, 2, 3> back = by_object(landing);
  EXPECT_LT((back * landing.by_film - Eigen::Matrix2d::Identity()).norm(), 1e-12);
  const Vec3 across = landing.by_film.col(0).cross(landing.by_film.col(1));
  EXPECT_LT((back * across).norm(), 1e-12);
}

// Whoever moves the scan or the film a little gets misfits that are left out of a comparison.
TEST(OpenMotionsTest, HoldWhatMovingTheScanOrTheFilmDoes) {
  constexpr double kLittle = 1e-7;
  const Board board = tint_board(5);
  const std::vector<GridPlace> places = places_within({4, 3});
  const Landings landings = landings_on(board, {4, 3});
  const Eigen::MatrixXd open = open_motions(board, landings, places);
  const Eigen::MatrixXd of_film = open_motions(board, landings, places, true);
  const auto moved = [&](const auto& move) {
    Eigen::VectorXd difference(3 * Eigen::Index(places.size()));
    for (std::size_t c = 0; c < places.size(); ++c)
      difference.segment<3>(3 * Eigen::Index(c)) =
          (move(board.on_film(places[c])) - landings.find(places[c])->position) / kLittle;
    return difference;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::AngleAxisd turn(kLittle, Vec3::Unit(axis));
    const auto turned = moved([&](const Vec2& u) { return Vec3(turn * landing_at(u).position); });
    EXPECT_LT(outside(turned, open), 1e-6) << axis;
    EXPECT_GT(outside(turned, of_film), 0.01) << axis;
    const auto shifted = moved(
        [&](const Vec2& u) { return Vec3(landing_at(u).position + kLittle * Vec3::Unit(axis)); });
    EXPECT_LT(outside(shifted, open), 1e-6) << axis;
  }
  const Eigen::Rotation2Dd film_turn(kLittle);
  const auto film_turned = moved([&](const Vec2& u) { return landing_at(film_turn * u).position; });
  EXPECT_LT(outside(film_turned, of_film), 1e-6);
  for (int axis = 0; axis < 2; ++axis) {
    const auto film_shifted =
        moved([&](const Vec2& u) { return landing_at(u + kLittle * Vec2::Unit(axis)).position; });
    EXPECT_LT(outside(film_shifted, of_film), 1e-6) << axis;
  }
  // A larger scale is no motion: it is what the film's stretch looks like.
  EXPECT_GT(outside(moved([&](const Vec2& u) { return landing_at((1 + kLittle) * u).position; }),
                    of_film),
            0.01);
}

// A dark square among blank ones that comes out larger moves its corners away from its middle.
TEST(OpenMotionsTest, InkThatSpreadsMovesCornersAwayFromTheirDarkSquare) {
  Board board;
  board.period = 2;
  board.ink = {255, 0, 0, 0};
  const std::vector<GridPlace> corners = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  const Landings landings = landings_on(board, {1, 1});
  const Eigen::MatrixXd open = open_motions(board, landings, corners, true);
  Eigen::VectorXd away(12);
  for (std::size_t c = 0; c < corners.size(); ++c)
    away.segment<3>(3 * Eigen::Index(c)) =
        landings.find(corners[c])->by_film * Vec2(2 * corners[c][0] - 1, 2 * corners[c][1] - 1);
  const Eigen::VectorXd spread = open.col(open.cols() - 1);
  EXPECT_NEAR(spread.dot(away), spread.norm() * away.norm(), 1e-9 * away.norm());
}

TEST(OrthonormalTest, IsTheSameSpaceWhateverItsColumnsLengths) {
  const Eigen::MatrixXd columns = Eigen::MatrixXd::Random(12, 3);
  Eigen::MatrixXd scaled(12, 4);
  scaled << 1e9 * columns.col(0), 1e-9 * columns.col(1), columns.col(2), 2 * columns.col(2);
  const Eigen::MatrixXd space = orthonormal(scaled);
  ASSERT_EQ(space.cols(), 3);
  EXPECT_LT((space.transpose() * space - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  EXPECT_LT(without(columns, space).norm(), 1e-9);
  // What is left is at right angles to the space, and nothing is left of that to take out.
  const Eigen::VectorXd left = without(Eigen::VectorXd::Random(12), space);
  EXPECT_GT(left.norm(), 0.1);
  EXPECT_LT((space.transpose() * left).norm(), 1e-9);
}

}  // namespace
}  // namespace hydrodip
