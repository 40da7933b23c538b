#include "plan/hold.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydrodip {
namespace {

Vec3 turned(const PoseOptions& pose, const Vec3& direction) {
  return pose_matrix({}, pose).topLeftCorner<3, 3>() * direction;
}

TEST(Hold, PointsDownWhatItShould) {
  for (const Vec3& down : spread_directions(100)) {
    const PoseOptions pose = hold({}, down, 40);
    // Whole degrees about two axes.
    EXPECT_LT(turned(pose, down).z(), -std::cos(1.0 * M_PI / 180));
    EXPECT_LT((down_of(pose) - down).norm(), 0.018);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(pose.rotate_deg[axis], std::round(pose.rotate_deg[axis]));
  }
}

TEST(Hold, KeepsTheSideThatIsDownFirst) {
  PoseOptions base;
  base.down = ModelSide::kPlusY;
  base.size_mm = 70;
  const PoseOptions pose = hold(base, -Vec3::UnitZ(), 0);
  EXPECT_EQ(pose.down, ModelSide::kPlusY);
  EXPECT_EQ(pose.size_mm, 70);
  EXPECT_EQ(pose.rotate_deg, Vec3(0, 0, 0));
}

TEST(Hold, DirectionsAreApartAndTheAxesComeFirst) {
  const std::vector<Vec3> list = spread_directions(74);
  ASSERT_EQ(list.size(), 74U);
  for (std::size_t i = 0; i < list.size(); ++i) {
    EXPECT_NEAR(list[i].norm(), 1, 1e-12);
    EXPECT_EQ(i < 6, list[i].cwiseAbs().maxCoeff() == 1);
    for (std::size_t j = 0; j < i; ++j) EXPECT_LT(list[i].dot(list[j]), std::cos(8 * M_PI / 180));
  }
}

TEST(Hold, NoDirectionIsFarFromAllOfThem) {
  const std::vector<Vec3> list = spread_directions(74);
  for (const Vec3& any : spread_directions(400)) {
    double nearest = -1;
    for (const Vec3& d : list) nearest = std::max(nearest, d.dot(any));
    EXPECT_GT(nearest, std::cos(26 * M_PI / 180));
  }
}

TEST(Hold, NeighboursLieAtTheirAngle) {
  const Vec3 down = Vec3(1, 2, -3).normalized();
  Vec3 sum = Vec3::Zero();
  for (const Vec3& d : directions_around(down, 10, 6)) {
    EXPECT_NEAR(d.dot(down), std::cos(10 * M_PI / 180), 1e-12);
    sum += d;
  }
  EXPECT_LT((sum.normalized() - down).norm(), 1e-12);
}

TEST(Hold, IsTurnedSoThatItTakesTheLeastPartOfTheFilm) {
  std::vector<Vec3> bar = {{-100, 0, 0}, {100, 0, 0}, {100, 10, 0}, {-100, 10, 0}};
  const auto part = [&](const FilmOptions& film, double turn_deg) {
    Box2 box;
    PoseOptions pose;
    pose.rotate_deg.z() = turn_deg;
    for (const Vec3& p : bar) box.add(turned(pose, p).head<2>());
    const Vec2 size = box.max - box.min;
    return std::max(size.x() / film.width_mm, size.y() / film.height_mm);
  };
  FilmOptions film;  // 210 x 297
  // However it lies in the model.
  for (int lying = 0; lying < 12; ++lying) {
    const double turn = roomiest_turn_deg(bar, {}, film);
    for (int other = 0; other < 180; other += 5)
      EXPECT_LE(part(film, turn), part(film, other) + 1e-6) << other;
    std::swap(film.width_mm, film.height_mm);
    PoseOptions further;
    further.rotate_deg.z() = 25;
    for (Vec3& p : bar) p = turned(further, p);
  }
}

TEST(Hold, IsSaidInPlainWords) {
  const auto words = [](const Vec3& down) {
    return describe_hold(hold({}, down, 0), ModelSide::kPlusZ);
  };
  EXPECT_EQ(words(-Vec3::UnitZ()), "standing upright");
  EXPECT_EQ(words(Vec3::UnitZ()), "upside down");
  EXPECT_EQ(words(-Vec3::UnitX()), "lying on its -x side");
  EXPECT_EQ(words(Vec3(std::cos(0.35), 0, std::sin(0.35))),
            "lying on its +x side, tilted by 20 degrees towards its +z side");
  // A model whose y is up.
  EXPECT_EQ(describe_hold({}, ModelSide::kPlusY), "lying on its -z side");
}

TEST(Hold, OptionsBringItAbout) {
  PoseOptions pose;
  pose.rotate_deg = {90, -30, 5};
  EXPECT_EQ(hold_options(pose), "--rotate 90,-30,5");
  pose.down = ModelSide::kMinusY;
  EXPECT_EQ(hold_options(pose), "--down -y --rotate 90,-30,5");
}

}  // namespace
}  // namespace hydrodip
