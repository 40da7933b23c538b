#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "base/error.h"
#include "camera/board.h"
#include "camera/film_picture.h"
#include "camera/film_pose.h"
#include "camera/tank.h"
#include "camera/view.h"
#include "scene.h"
#include "sheet/film_marks.h"

namespace hydrodip {
namespace {

using fixtures::phone_lens;
using fixtures::random_view;
using fixtures::synthetic_tank;

constexpr double kWater_mm = 22;  // below the rim

std::vector<SeenPhoto> calibration_photos(double noise_px, std::uint32_t seed,
                                          double tilt_deg = 28) {
  std::mt19937 random(seed);
  const auto tank = synthetic_tank(false);
  std::vector<SeenPhoto> photos;
  for (int n = 0; n < 12; ++n)
    photos.push_back(
        {"photo", tank.seen(phone_lens(), random_view(random, tilt_deg), noise_px, random)});
  return photos;
}

Tank known_tank() {
  Tank tank = calibrate_tank(calibration_photos(0.03, 1), 4000, 3000, RunContext());
  tank.water_below_mm = kWater_mm;
  return tank;
}

// Truth in the tank frame that a calibration has chosen for itself.
Pose to_found_frame(const Tank& found) {
  const auto truth = synthetic_tank(false);
  std::vector<Vec3> a, b;
  for (const auto& [id, corner] : found.corner_mm) {
    const StripPlace at = strip_place(id);
    a.push_back(truth.strip[std::size_t(at.strip)] * Vec3(at.corner.x(), at.corner.y(), 0));
    b.push_back(corner);
  }
  Eigen::Matrix3Xd from(3, Eigen::Index(a.size())), to(3, Eigen::Index(a.size()));
  for (std::size_t i = 0; i < a.size(); ++i) {
    from.col(Eigen::Index(i)) = a[i];
    to.col(Eigen::Index(i)) = b[i];
  }
  const Eigen::Matrix4d move = Eigen::umeyama(from, to, false);
  return Pose::of(Mat3(move.topLeftCorner<3, 3>()), Vec3(move.topRightCorner<3, 1>()));
}

TEST(Lens, SeesAlongTheRayThroughWhichItProjects) {
  const Lens lens = phone_lens();
  for (const Vec2& px : {Vec2(2000, 1500), Vec2(10, 20), Vec2(3990, 30), Vec2(700, 2950)})
    EXPECT_LT((lens.project(430 * lens.ray(px)) - px).norm(), 1e-8);
}

// Brown and Conrady's: off the middle by r, a lens that leans moves along its lean three times as
// far as across it.
TEST(Lens, LeansAsTheModelSays) {
  Lens lens;
  lens.focal_px = 1000;
  lens.center_px = {500, 400};
  lens.p2 = 0.02;
  EXPECT_LT((lens.project({0.5, 0, 1}) - Vec2(1000 + 1000 * 0.02 * 0.75, 400)).norm(), 1e-9);
  EXPECT_LT((lens.project({0, 0.5, 1}) - Vec2(500 + 1000 * 0.02 * 0.25, 900)).norm(), 1e-9);
  EXPECT_LT((lens.project({0, 1, 2}) - lens.project({0, 0.5, 1})).norm(), 1e-9);
  lens.p2 = 0;
  lens.p1 = 0.02;
  EXPECT_LT((lens.project({0, 0.5, 1}) - Vec2(500, 900 + 1000 * 0.02 * 0.75)).norm(), 1e-9);
  EXPECT_LT((lens.project({0.5, 0, 1}) - Vec2(1000, 400 + 1000 * 0.02 * 0.25)).norm(), 1e-9);
  lens.p1 = 0;
  lens.k1 = 0.1;
  EXPECT_LT((lens.project({0.5, 0, 1}) - Vec2(1000 + 1000 * 0.1 * 0.125, 400)).norm(), 1e-9);
}

TEST(Calibration, FindsLensAndRimFromPhotosOfTheBoard) {
  const Tank tank = calibrate_tank(calibration_photos(0.05, 3), 4000, 3000, RunContext());
  const Lens truth = phone_lens();
  const auto sigma = [&](int k) { return std::sqrt(tank.lens_covariance(k, k)); };
  EXPECT_LT(std::abs(tank.lens.focal_px - truth.focal_px), 4 * sigma(0));
  EXPECT_LT(std::abs(tank.lens.k1 - truth.k1), 4 * sigma(3));
  EXPECT_LT(sigma(0) / truth.focal_px, 1e-3);
  EXPECT_NEAR(tank.rms_px, 0.05, 0.01);
  // Every corner, up to the frame.
  const Pose move = to_found_frame(tank);
  const auto rim = synthetic_tank(false);
  for (const auto& [id, corner] : tank.corner_mm) {
    const StripPlace at = strip_place(id);
    const Vec3 is =
        move * (rim.strip[std::size_t(at.strip)] * Vec3(at.corner.x(), at.corner.y(), 0));
    EXPECT_LT((is - corner).norm(), 0.06) << id;
  }
  // A frame as the header says.
  EXPECT_NEAR(tank.corner_mm.at(kFirstBoardTag).y(), 170, 15);
}

TEST(Calibration, RefusesPhotosThatTellNothing) {
  EXPECT_THROW(calibrate_tank({}, 4000, 3000, RunContext()), InputError);
  std::vector<SeenPhoto> one = calibration_photos(0.05, 3);
  one.resize(2);
  EXPECT_THROW(calibrate_tank(one, 4000, 3000, RunContext()), InputError);
  // Straight down, all alike.
  std::mt19937 random(3);
  std::vector<SeenPhoto> alike;
  for (int n = 0; n < 6; ++n)
    alike.push_back(
        {"photo", synthetic_tank(false).seen(
                      phone_lens(), fixtures::look_at({0, 1, 500}, {0, 1, 0}, 0), 0.1, random)});
  EXPECT_THROW(calibrate_tank(alike, 4000, 3000, RunContext()), InputError);
}

// A photo of the rim in which some strips lie elsewhere than they were calibrated, by a lens that
// focuses anew.
SeenPhoto rim_photo(const std::map<int, Vec3>& moved_mm, std::mt19937& random) {
  auto rim = synthetic_tank(false);
  for (const auto& [strip, by] : moved_mm) rim.strip[std::size_t(strip)].shift += by;
  std::normal_distribution<double> normal;
  Lens lens = phone_lens();
  lens.focal_px *= 1 + 0.002 * normal(random);
  lens.center_px += 3 * Vec2(normal(random), normal(random));
  return {"photo.jpg", rim.seen(lens, random_view(random), 0.1, random)};
}

std::string refusal(const SeenPhoto& photo, const Tank& tank) {
  try {
    view_of(photo, tank, 0.3);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(View, StripThatHasMovedIsNamedWithItsWay) {
  const Tank tank = known_tank();
  std::mt19937 random(21);
  std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
  for (int n = 0; n < 24; ++n) {
    EXPECT_EQ(refusal(rim_photo({}, random), tank), "");
    const int strip = n % 4;
    const double by_mm = n < 12 ? 1 : 3, towards = angle(random);
    const std::string told = refusal(
        rim_photo({{strip, by_mm * Vec3(std::cos(towards), std::sin(towards), 0)}}, random), tank);
    EXPECT_NE(told.find("strip " + std::to_string(strip + 1) + " of the rim has moved by"),
              std::string::npos)
        << told;
    const std::size_t at = told.find("moved by ");
    ASSERT_NE(at, std::string::npos) << told;
    EXPECT_NEAR(std::stod(told.substr(at + 9)), by_mm, 0.25) << told;
  }
}

TEST(View, StripsThatMovedTogetherAreRefused) {
  const Tank tank = known_tank();
  std::mt19937 random(22);
  // Neither pair can tell that it was the other one.
  const std::string told =
      refusal(rim_photo({{1, Vec3(0, 2, 0)}, {3, Vec3(0, 2, 0)}}, random), tank);
  EXPECT_NE(told.find("px off where the calibration found them"), std::string::npos) << told;
}

TEST(View, SecondPrintOfAStripIsNamed) {
  const Tank tank = known_tank();
  std::mt19937 random(23);
  SeenPhoto photo = rim_photo({}, random);
  const SeenPhoto other = rim_photo({{2, Vec3(60, 55, 0)}}, random);
  for (const SeenMark& mark : other.marks)
    if (strip_place(mark.id).strip == 2) photo.marks.push_back(mark);
  const std::string told = refusal(photo, tank);
  EXPECT_NE(told.find("strip 3 of the board is to be seen twice"), std::string::npos) << told;
  // A calibration does without such a photo.
  std::vector<SeenPhoto> photos = calibration_photos(0.03, 1);
  photos.push_back(photo);
  const Tank again = calibrate_tank(photos, 4000, 3000, RunContext());
  EXPECT_EQ(again.rms_px, tank.rms_px);
  // One tag that was misread is no strip.
  photo = rim_photo({}, random);
  photo.marks.push_back(photo.marks.front());
  photo.marks.back().corner_px += Vec2(300, 200);
  EXPECT_EQ(refusal(photo, tank), "");
}

// An A4 sheet on the water, as it lies in the truth's frame.
struct Laid {
  Vec2 shift = Vec2::Zero();
  double turn_deg = 0;
  Vec2 swelling = Vec2::Ones();
};

struct Photographed {
  GrayImage photo;
  Laid truth;  // in the frame that the calibration has found
};

Photographed photographed(const Tank& found, const Laid& laid, std::uint32_t seed, bool mirrored,
                          const std::vector<Box2>& printed = {}) {
  std::mt19937 random(seed);
  auto tank = synthetic_tank(true);
  Box2 sheet;
  sheet.add(Vec2(105, 148.5));
  sheet.add(Vec2(-105, -148.5));
  std::vector<Box2> boxes = printed;
  for (const MarkPlace& mark : film_marks(210, 297, 10))
    for (const Box2& box : mark_boxes(mark)) boxes.push_back(box);
  const auto film = fixtures::draw_boxes(boxes, sheet);
  fixtures::Scene scene;
  scene.lens = phone_lens();
  scene.camera = random_view(random);
  scene.sheets = tank.sheets();
  // Upright in a bath that lies: a quarter turn is the place's matter.
  const double turn = laid.turn_deg * std::numbers::pi / 180;
  const Pose lies{Vec3(0, 0, turn), Vec3(laid.shift.x(), laid.shift.y(), -kWater_mm)};
  const Pose move = to_found_frame(found);
  // The water is level with the found frame's plane, which is the calibration's.
  const Pose level = move.inverse() * lies;
  scene.sheets.push_back({&film, level, laid.swelling, mirrored});
  scene.shade = {0.35, -0.2};
  scene.glare = {{{2300, 900}, 120, 160}, {{900, 2200}, 60, 220}};
  scene.seed = seed;
  return {photograph(scene), laid};
}

TEST(SlowFilmPose, IsFoundInAPhoto) {
  const Tank tank = known_tank();
  const Laid laid{{1.4, -2.2}, 0.7, {1.025, 1.015}};
  const Photographed seen = photographed(tank, laid, 5, false);
  FilmSearch search{film_marks(210, 297, 10)};
  search.water_sigma_mm = 0.1;
  const FilmPose pose = find_film(seen.photo, "photo.jpg", tank, search, RunContext());
  EXPECT_GE(pose.marks.size(), 8U);
  EXPECT_LT((pose.shift_mm - laid.shift).norm(), 0.1);
  EXPECT_NEAR(pose.turn_deg, laid.turn_deg, 0.05);
  EXPECT_LT((pose.swelling - laid.swelling).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT(pose.unexplained_rms_mm, 0.05);
  for (int k = 0; k < 2; ++k) {
    EXPECT_LT(std::abs(pose.shift_mm[k] - laid.shift[k]), 4 * pose.shift_sigma_mm[k]);
    EXPECT_LT(std::abs(pose.swelling[k] - laid.swelling[k]), 4 * pose.swelling_sigma[k]);
  }
  const auto told = [&](const GrayImage& photo) -> std::string {
    try {
      find_film(photo, "photo.jpg", tank, search, RunContext());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  // In a mirrored photo the rim is mirrored, too: no reason to throw the film away.
  const std::string mirrored_photo = told(mirrored(seen.photo));
  EXPECT_NE(mirrored_photo.find("the photo is mirrored"), std::string::npos) << mirrored_photo;
  // By a level that might be anywhere nobody can move a film.
  search.water_sigma_mm = 30;
  const std::string unsure = told(seen.photo);
  EXPECT_NE(unsure.find("too little to move it by"), std::string::npos) << unsure;
  search.water_sigma_mm = 0.1;
  // A sheet of another size.
  search.marks = film_marks(215.9, 279.4, 10);
  EXPECT_THROW(find_film(seen.photo, "photo.jpg", tank, search, RunContext()), InputError);
}

// One photo, of sheets that were printed otherwise.
TEST(SlowFilmPose, FilmOnWhichAJobDoesNotLandIsRefused) {
  Tank tank = known_tank();
  const Photographed seen = photographed(tank, {}, 7, false);
  const std::vector<MarkPlace> own = film_marks(210, 297, 10);
  const auto told = [&](const FilmSearch& search) -> std::string {
    try {
      find_film(seen.photo, "photo.jpg", tank, search, RunContext());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto says = [&](const FilmSearch& search, const char* words) {
    EXPECT_NE(told(search).find(words), std::string::npos) << told(search);
  };
  FilmSearch search{own};
  EXPECT_EQ(told(search), "");
  search.tolerance_mm = 1e-6;
  says(search, "any evenly swollen sheet");
  search = {own};
  for (MarkPlace& mark : search.marks) mark.corner /= 1.09;
  says(search, "would have swollen by");
  search = {own};
  for (MarkPlace& mark : search.marks) mark.corner = {-mark.corner.y(), mark.corner.x()};
  says(search, "lies turned by");
  search.any_turn = true;
  EXPECT_EQ(told(search), "");
  // One mark is another sheet's.
  search = {own};
  search.marks.front().corner += Vec2(15, 0);
  const FilmPose pose = find_film(seen.photo, "photo.jpg", tank, search, RunContext());
  for (const FilmPose::Mark& mark : pose.marks) EXPECT_NE(mark.id, search.marks.front().id);
  EXPECT_LT(pose.shift_mm.norm(), 0.1);
  search = {own};
  ++tank.width_px;
  says(search, "use the same camera");
}

TEST(SlowFilmPose, ToldWhenItLiesUpsideDown) {
  const Tank tank = known_tank();
  const Photographed seen = photographed(tank, {}, 6, true);
  try {
    find_film(seen.photo, "photo.jpg", tank, {film_marks(210, 297, 10)}, RunContext());
    FAIL() << "found";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("film lies upside down"), std::string::npos)
        << error.what();
  }
}

FilmPicture picture_of(const std::vector<Box2>& boxes) {
  Box2 sheet;
  sheet.add(Vec2(105, 148.5));
  sheet.add(Vec2(-105, -148.5));
  return {fixtures::draw_boxes(boxes, sheet, 4).gray, 210, 297, 10};
}

TEST(SlowFilmPicture, TellsOneJobsFilmFromAnothers) {
  const Tank tank = known_tank();
  const Laid laid{{1.4, -2.2}, 1.7, {1.025, 1.015}};
  const Photographed seen = photographed(tank, laid, 5, false, fixtures::boxes_on_a4(1));
  const FilmPose pose =
      find_film(seen.photo, "photo.jpg", tank, {film_marks(210, 297, 10)}, RunContext());
  const auto likeness = [&](const std::vector<Box2>& printed) {
    return film_likeness(seen.photo, pose, tank, picture_of(printed));
  };
  ASSERT_TRUE(likeness(fixtures::boxes_on_a4(1)).has_value());
  EXPECT_GT(*likeness(fixtures::boxes_on_a4(1)), 0.8);
  for (const std::uint32_t other : {2U, 3U, 4U}) {
    ASSERT_TRUE(likeness(fixtures::boxes_on_a4(other)).has_value());
    EXPECT_LT(std::abs(*likeness(fixtures::boxes_on_a4(other))), 0.2) << other;
  }
  // A print without a picture, or of one colour all over, tells nothing.
  EXPECT_FALSE(likeness({}).has_value());
  EXPECT_FALSE(likeness({{Vec2(-105, -148.5), Vec2(105, 148.5)}}).has_value());
  // Film on which nothing is printed is another's.
  const Photographed blank = photographed(tank, laid, 5, false);
  EXPECT_LT(*film_likeness(blank.photo, pose, tank, picture_of(fixtures::boxes_on_a4(1))), 0.2);
}

}  // namespace
}  // namespace hydrodip
