// A print and a photo of it as a camera without faults takes it from straight above.
#include "camera/film_picture.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

namespace hydrodip {
namespace {

constexpr double kWide_mm = 90, kHigh_mm = 70, kMargin_mm = 5;
constexpr double kPicture_px = 4, kPhoto_px = 2;  // per mm
constexpr double kWater_mm = 20, kEye_mm = 500;   // below and above the rim
constexpr int kPhotoWide_px = 300, kPhotoHigh_px = 260;

using Print = std::function<double(const Vec2&)>;  // levels by mm from the sheet's middle

// Boxes of 5 mm, each of them black or white: what differs from print to print.
Print boxes(std::uint32_t print) {
  return [print](const Vec2& mm) {
    const auto column = std::uint32_t(int(std::floor(mm.x() / 5)) + 100),
               row = std::uint32_t(int(std::floor(mm.y() / 5)) + 100);
    std::uint32_t hash = (print * 7919U + column) * 104729U + row;
    hash = (hash ^ (hash >> 15U)) * 0x2c1b3c6dU;
    hash = (hash ^ (hash >> 12U)) * 0x297a2d39U;
    return ((hash >> 15U) & 1U) != 0 ? 250.0 : 20.0;
  };
}

GrayImage drawn(int width_px, int height_px, const Print& level_at_px) {
  GrayImage gray{width_px, height_px, {}};
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      gray.value.push_back(std::uint8_t(std::lround(level_at_px({x + 0.5, y + 0.5}))));
  return gray;
}

FilmPicture picture_of(const Print& print) {
  return {drawn(int(kWide_mm * kPicture_px), int(kHigh_mm * kPicture_px),
                [&](const Vec2& px) {
                  return print({px.x() / kPicture_px - 0.5 * kWide_mm,
                                0.5 * kHigh_mm - px.y() / kPicture_px});
                }),
          kWide_mm, kHigh_mm, kMargin_mm};
}

class FilmLikeness : public testing::Test {
 protected:
  FilmLikeness() {
    tank_.place = {{6, -4}, 50};
    tank_.water_below_mm = kWater_mm;
    pose_.shift_mm = {2, 3};
    pose_.turn_deg = 8;
    pose_.swelling = {1.04, 1.02};
    look_from({0, 0});
  }

  void look_from(const Vec2& eye) {
    Lens lens;
    lens.focal_px = kPhoto_px * (kEye_mm + kWater_mm);
    lens.center_px = {0.5 * kPhotoWide_px, 0.5 * kPhotoHigh_px};
    const Mat3 down = Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()).toRotationMatrix();
    pose_.view.values << Pose::of(down, -(down * Vec3(eye.x(), eye.y(), kEye_mm))).values(),
        lens.values(), kWater_mm;
  }

  // `light`: by pixel.
  GrayImage photo_of(
      const Print& print, const Print& light = [](const Vec2&) { return 1.0; }) const {
    const auto turned = [](double deg) {
      return Eigen::Rotation2Dd(deg * std::numbers::pi / 180).toRotationMatrix().eval();
    };
    // From the sheet to the water, as FilmPose says.
    const Mat2 sheet_to_place = turned(pose_.turn_deg) * pose_.swelling.asDiagonal();
    const Mat2 place_to_water = turned(tank_.place.turn_deg);
    const Mat2 back = (place_to_water * sheet_to_place).inverse();
    const Vec2 middle = tank_.place.middle_mm + place_to_water * pose_.shift_mm;
    return drawn(kPhotoWide_px, kPhotoHigh_px, [&](const Vec2& px) {
      const Vec2 on_sheet = back * (View::on_water(pose_.view.values, px) - middle);
      const bool is_sheet =
          std::abs(on_sheet.x()) < 0.5 * kWide_mm && std::abs(on_sheet.y()) < 0.5 * kHigh_mm;
      return (is_sheet ? print(on_sheet) : 90.0) * light(px);
    });
  }

  std::optional<double> likeness(const GrayImage& photo, const Print& print) const {
    return film_likeness(photo, pose_, tank_, picture_of(print));
  }

  Tank tank_;
  FilmPose pose_;
};

TEST_F(FilmLikeness, IsWholeHoweverPlaceAndFilmAreTurned) {
  for (const double place_deg : {0.0, 50.0, 180.0})
    for (const double film_deg : {0.0, 8.0, -60.0}) {
      tank_.place.turn_deg = place_deg;
      pose_.turn_deg = film_deg;
      const GrayImage photo = photo_of(boxes(1));
      ASSERT_TRUE(likeness(photo, boxes(1)));
      EXPECT_GT(*likeness(photo, boxes(1)), 0.95) << place_deg << ' ' << film_deg;
      EXPECT_LT(std::abs(*likeness(photo, boxes(2))), 0.2) << place_deg << ' ' << film_deg;
      const Print back = [](const Vec2& mm) { return boxes(1)({-mm.x(), mm.y()}); };
      EXPECT_LT(std::abs(*likeness(photo, back)), 0.2) << place_deg << ' ' << film_deg;
    }
}

TEST_F(FilmLikeness, IsTheSameInLightThatChanges) {
  const Print light = [](const Vec2& px) { return 0.15 + 0.8 * px.x() / kPhotoWide_px; };
  const GrayImage photo = photo_of(boxes(1), light);
  EXPECT_GT(*likeness(photo, boxes(1)), 0.8);
  // Nor is it the picture where that grows paler the same way.
  const Print paler = [](const Vec2& mm) {
    return 0.5 * (boxes(2)(mm) + 250 * (0.5 + mm.x() / kWide_mm));
  };
  EXPECT_LT(std::abs(*likeness(photo_of([](const Vec2&) { return 200.0; }, light), paler)), 0.2);
}

TEST_F(FilmLikeness, IsNotToldByPrintsThatAreTooPale) {
  const Print pale = [](const Vec2& mm) { return 250 + boxes(1)(mm) / 50; };
  EXPECT_FALSE(likeness(photo_of(pale), pale));
  const Print strong = [](const Vec2& mm) { return 150 + boxes(1)(mm) / 5; };
  EXPECT_GT(*likeness(photo_of(strong), strong), 0.95);
}

// Half of what is printed has to be seen.
TEST_F(FilmLikeness, IsNotToldOfFilmThatIsHardlyInThePhoto) {
  tank_.place.turn_deg = pose_.turn_deg = 0;
  const auto seen_from = [&](double eye_mm) {
    look_from({eye_mm, 0});
    return likeness(photo_of(boxes(1)), boxes(1));
  };
  // The photo is 150 mm wide, the printed picture some 83 about x = 8.
  ASSERT_TRUE(seen_from(8 + 75 - 20));
  EXPECT_GT(*seen_from(8 + 75 - 20), 0.95);
  EXPECT_FALSE(seen_from(8 + 75 + 20));
}

TEST_F(FilmLikeness, OfAPhotoThatShowsNothingIsNone) {
  const auto even = likeness(photo_of([](const Vec2&) { return 90.0; }), boxes(1));
  ASSERT_TRUE(even);
  EXPECT_EQ(*even, 0);
}

}  // namespace
}  // namespace hydrodip
