#include "scan/registration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

constexpr double kBoardSquare_mm = 5;

// Film laid onto a sample straight up but wider outwards, a little lopsided if asked: no dip, but
// places land on the surface one to one.
struct Landed {
  Object object;
  Surface surface;
  bool lopsided;

  explicit Landed(const std::string& sample, bool is_lopsided = false)
      : object(make_sample(sample)),
        surface(object.positions, object.triangles),
        lopsided(is_lopsided) {}

  std::optional<Vec3> operator()(const GridPlace& place) const {
    Vec2 u = kBoardSquare_mm * Vec2(place[0], place[1]);
    const double r = u.norm();
    u *= 1 - 0.002 * r;
    if (lopsided) u += Vec2(0.003 * u.y() * u.y() + 0.002 * u.x() * u.y(), 0.002 * u.x() * u.x());
    if (r > 22) return std::nullopt;
    const auto hit = surface.first_hit({u.x(), u.y(), -1}, {0, 0, 1}, 0, 100);
    if (!hit) return std::nullopt;
    return surface.position(*hit);
  }
};

CornerGrid landed_grid(const Landed& landed, const GridPlace& origin = {0, 0}) {
  CornerGrid grid;
  for (int j = -6; j <= 6; ++j)
    for (int i = -6; i <= 6; ++i)
      if (const auto p = landed({i, j})) {
        grid.position.push_back(*p);
        grid.place.push_back({i - origin[0], j - origin[1]});
        grid.patch.push_back(0);
      }
  return grid;
}

Eigen::Isometry3d some_pose(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  Eigen::Quaterniond turn(number(random), number(random), number(random), number(random));
  Eigen::Isometry3d pose(turn.normalized());
  pose.pretranslate(100 * Vec3(number(random), number(random), number(random)));
  return pose;
}

double largest_error(const CornerGrid& a, const CornerGrid& b) {
  double most = 0;
  for (std::size_t c = 0; c < a.position.size(); ++c)
    most = std::max(most, (a.position[c] - b.position[c]).norm());
  return most;
}

class ShapeTest : public testing::TestWithParam<const char*> {};

TEST_P(ShapeTest, AScanInAnyPoseComesBackToTheObject) {
  const Landed landed(GetParam(), true);
  const CornerGrid truth = landed_grid(landed);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    CornerGrid scan = moved(landed_grid(landed, {2, -3}), some_pose(seed));
    const GridMatch match = match_grid(scan, std::cref(landed), {6, 6}, kBoardSquare_mm, "scan");
    EXPECT_FALSE(match.mirrored);
    EXPECT_FALSE(match.turned);
    const Alignment alignment = align(scan, match, landed.surface, std::cref(landed));
    EXPECT_LT(alignment.rms_mm, 1e-6);
    EXPECT_LT(largest_error(moved(scan, alignment.pose), truth), 1e-4);
  }
}

TEST_P(ShapeTest, AThirdOfTheCornersMayBeMissing) {
  const Landed landed(GetParam(), true);
  const CornerGrid whole = landed_grid(landed);
  CornerGrid truth, scan;
  for (std::size_t c = 0; c < whole.position.size(); ++c) {
    if (c * 7919 % 97 < 32) continue;
    truth.position.push_back(whole.position[c]);
    truth.place.push_back(whole.place[c]);
    truth.patch.push_back(0);
  }
  scan = moved(truth, some_pose(9));
  const GridMatch match = match_grid(scan, std::cref(landed), {6, 6}, kBoardSquare_mm, "scan");
  const Alignment alignment = align(scan, match, landed.surface, std::cref(landed));
  EXPECT_LT(largest_error(moved(scan, alignment.pose), truth), 1e-4);
}

TEST_P(ShapeTest, AMirroredScanIsToldFromARightOne) {
  const Landed landed(GetParam(), true);  // lopsided: not its own mirror image
  CornerGrid scan = moved(landed_grid(landed), some_pose(3));
  for (Vec3& p : scan.position) p.x() = -p.x();
  EXPECT_TRUE(match_grid(scan, std::cref(landed), {6, 6}, kBoardSquare_mm, "scan").mirrored);
}

TEST_P(ShapeTest, OnASymmetricShapeAMirroredScanIsReadTheOtherWayRound) {
  const Landed landed(GetParam());
  CornerGrid scan = moved(landed_grid(landed), some_pose(4));
  for (Vec3& p : scan.position) p.x() = -p.x();
  const GridMatch match = match_grid(scan, std::cref(landed), {6, 6}, kBoardSquare_mm, "scan");
  EXPECT_FALSE(match.mirrored);
  EXPECT_TRUE(match.turned);
  EXPECT_LT(match.rms_mm, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(All, ShapeTest, testing::Values("sphere", "pyramid", "ellipsoid"));

// A sphere's surface says nothing about turns; where corners land has to.
TEST(RegistrationTest, NoiseOnASphereTurnsItLittle) {
  const Landed landed("sphere");
  const CornerGrid truth = landed_grid(landed);
  CornerGrid scan = truth;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.05);
  for (Vec3& p : scan.position) p += Vec3(noise(random), noise(random), noise(random));
  scan = moved(scan, some_pose(6));
  const GridMatch match = match_grid(scan, std::cref(landed), {6, 6}, kBoardSquare_mm, "scan");
  const Alignment alignment = align(scan, match, landed.surface, std::cref(landed));
  double sum = 0;
  for (std::size_t c = 0; c < truth.position.size(); ++c)
    sum += (alignment.pose * scan.position[c] - truth.position[c]).squaredNorm();
  EXPECT_LT(std::sqrt(sum / double(truth.position.size())), 2 * 0.05);
}

TEST(RegistrationTest, RefusesAnotherShape) {
  const Landed sphere("sphere"), pyramid("pyramid");
  CornerGrid scan = landed_grid(pyramid);
  for (Vec3& p : scan.position) p.z() *= 3;
  EXPECT_THROW(match_grid(scan, std::cref(sphere), {6, 6}, kBoardSquare_mm, "scan"), InputError);
}

// A few misread squares beside the board, found first, decide nothing.
TEST(RegistrationTest, TheLargestPatchIsMatched) {
  const Landed landed("sphere", true);
  CornerGrid scan;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> off(-2, 2);
  for (const bool misread : {true, false}) {
    const CornerGrid whole = landed_grid(landed);
    for (std::size_t c = 0; c < whole.position.size(); ++c) {
      const int column = whole.place[c][0];
      if (misread ? column > -3 : column < -1) continue;
      const Vec3 error = misread ? Vec3(off(random), off(random), off(random)) : Vec3::Zero();
      scan.position.push_back(whole.position[c] + error);
      scan.place.push_back(whole.place[c]);
      scan.patch.push_back(misread ? 0 : 1);
    }
  }
  scan = moved(scan, some_pose(2));
  EXPECT_LT(match_grid(scan, std::cref(landed), {6, 6}, kBoardSquare_mm, "scan").rms_mm, 1e-6);
}

TEST(RegistrationTest, AScanOfMoreThanLandsIsRefused) {
  const Landed whole("sphere");
  const GridLanding cross = [&](const GridPlace& place) -> std::optional<Vec3> {
    if (place[0] != 0 && place[1] != 0) return std::nullopt;
    return whole(place);
  };
  std::string why;
  try {
    match_grid(landed_grid(whole), cross, {6, 6}, kBoardSquare_mm, "scan");
  } catch (const InputError& error) {
    why = error.what();
  }
  EXPECT_NE(why.find("more squares than can come to lie"), std::string::npos) << why;
}

// Whichever way round somebody counted.
TEST(RegistrationTest, RowsMayRunAlongAnySideOfTheFilm) {
  const Landed landed("sphere", true);
  const CornerGrid truth = landed_grid(landed);
  for (int turns = 0; turns < 4; ++turns) {
    CornerGrid scan = truth;
    for (GridPlace& place : scan.place)
      for (int k = 0; k < turns; ++k) place = {place[1], -place[0]};
    const GridMatch match = match_grid(scan, std::cref(landed), {6, 6}, kBoardSquare_mm, "scan");
    EXPECT_LT(match.rms_mm, 1e-6) << turns;
    EXPECT_FALSE(match.turned || match.mirrored);
    for (std::size_t c = 0; c < truth.place.size(); ++c)
      EXPECT_EQ(match.place[c].value(), truth.place[c]) << turns;
  }
}

TEST(RegistrationTest, ALittleMotionIsATurnAboutTheOriginAndAShift) {
  const Eigen::Isometry3d pose = some_pose(3);
  const Vec3 shift(1, -2, 3), turn(0, 0, 0.1), p(4, 5, 6);
  const Vec3 at = pose * p;
  const Vec3 turned(std::cos(0.1) * at.x() - std::sin(0.1) * at.y(),
                    std::sin(0.1) * at.x() + std::cos(0.1) * at.y(), at.z());
  EXPECT_LT((moved_a_little(pose, shift, turn) * p - (turned + shift)).norm(), 1e-12);
  EXPECT_LT((moved_a_little(pose, shift, Vec3::Zero()) * p - (at + shift)).norm(), 1e-12);
}

TEST(AlignedScan, TellsTheWorstCornerAndTheMean) {
  const Surface surface({{-99, -99, 0}, {99, -99, 0}, {0, 99, 0}}, {{0, 1, 2}});
  CornerGrid grid;
  grid.position = {{0, 0, 4}, {1, 0, -3}, {2, 0, 0}};
  const Alignment alignment = as_it_lies(grid, surface);
  EXPECT_NEAR(alignment.worst_mm, 4, 1e-9);
  EXPECT_NEAR(alignment.rms_mm, std::sqrt(25 / 3.0), 1e-9);
}

TEST(RegistrationTest, RefusesScatteredSquares) {
  const Landed sphere("sphere");
  CornerGrid scan = landed_grid(sphere);
  for (std::size_t c = 0; c < scan.patch.size(); ++c) scan.patch[c] = int(c / 4);
  EXPECT_THROW(match_grid(scan, std::cref(sphere), {6, 6}, kBoardSquare_mm, "scan"), InputError);
}

TEST(AlignedScan, HalfASquareOffIsToldAsThat) {
  const std::vector<Vec3> plane = {{-99, -99, 0}, {99, -99, 0}, {99, 99, 0}, {-99, 99, 0}};
  const Surface surface(plane, {{0, 1, 2}, {0, 2, 3}});
  const GridLanding landing = [](const GridPlace& place) -> std::optional<Vec3> {
    return Vec3(kBoardSquare_mm * place[0], kBoardSquare_mm * place[1], 0);
  };
  const auto said = [&](const Vec3& off) {
    CornerGrid scan;
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column < 6; ++column) {
        scan.position.push_back(*landing({column, row}) + off);
        scan.place.push_back({column, row});
        scan.patch.push_back(0);
      }
    std::vector<std::optional<GridPlace>> place(scan.position.size());
    place_patches(scan, Eigen::Isometry3d::Identity(), false, landing, {15, 15}, kBoardSquare_mm,
                  place);
    return place[0] ? std::string("placed")
                    : why_unplaced(scan, surface, landing, {15, 15}, kBoardSquare_mm);
  };
  EXPECT_EQ(said({2, 1, 0}), "placed");
  EXPECT_NE(said({2.5, 2.5, 0}).find("3.54 mm"), std::string::npos) << said({2.5, 2.5, 0});
  EXPECT_NE(said({0, 0, 50}).find("50.0 mm off the object's surface"), std::string::npos);
}

}  // namespace
}  // namespace hydrodip
