// Paling and its compensation, where both are known exactly.
#include "ink/discoloration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ink/difference.h"

namespace hydrodip {
namespace {

constexpr double kNoLimit = 4;

void expect_inks(const Inks& found, const Inks& expected) {
  EXPECT_FLOAT_EQ(found.c, expected.c);
  EXPECT_FLOAT_EQ(found.m, expected.m);
  EXPECT_FLOAT_EQ(found.y, expected.y);
  EXPECT_FLOAT_EQ(found.k, expected.k);
}

TEST(Discoloration, StretchedInkPalesAndIsCompensatedExactly) {
  const Inks wanted{0.5F, 0.25F, 0, 0.125F};
  for (const double ratio : {0.8, 1.0, 1.25, 2.0}) {
    expect_inks(paled(wanted, ratio), wanted.times(float(1 / ratio)));
    for (const GamutPolicy policy : {GamutPolicy::kClip, GamutPolicy::kScale})
      expect_inks(paled(compensated(wanted, ratio, policy, kNoLimit), ratio), wanted);
  }
}

TEST(Discoloration, WhatCannotBeReachedIsClippedInkByInk) {
  const Inks laid = compensated({0.9F, 0.4F, 0, 0}, 1.5, GamutPolicy::kClip, kNoLimit);
  expect_inks(laid, {1, 0.6F, 0, 0});
}

TEST(Discoloration, BlackThatTheBlackInkCannotGiveIsMadeUpOfColours) {
  const auto model = make_device_model();
  const Inks laid = compensated({0, 0, 0, 1}, 1.5, GamutPolicy::kClip, kNoLimit);
  expect_inks(laid, {0.5F, 0.5F, 0.5F, 1});
  const Inks left = paled(laid, 1.5);
  SrgbColor color;
  model->look(&left, &color, 1);
  EXPECT_NEAR(color.r, 0, 1e-6);
  EXPECT_NEAR(color.g, 0, 1e-6);
}

TEST(Discoloration, SoftKeepsTheHueAndTheOrder) {
  float before = 0;
  for (float amount = 0.01F; amount < 3; amount += 0.01F) {
    const Inks laid = compensated({amount, amount / 2, 0, 0}, 1, GamutPolicy::kSoft, kNoLimit);
    EXPECT_NEAR(laid.m / laid.c, 0.5, 1e-5);
    EXPECT_GT(laid.c, before);  // differences survive, however small
    EXPECT_LE(laid.c, 1);
    EXPECT_LT(laid.c - before, 0.0101F);  // smooth: never steeper than the identity
    before = laid.c;
    if (amount <= 0.8F) {
      EXPECT_FLOAT_EQ(laid.c, amount);
    }
  }
}

TEST(Discoloration, TheInkLimitHoldsAndKeepsTheHue) {
  const Inks laid = compensated({1, 0.8F, 0.2F, 0.5F}, 1, GamutPolicy::kClip, 2);
  EXPECT_FLOAT_EQ(laid.density(), 2);
  expect_inks(laid, Inks{1, 0.8F, 0.2F, 0.5F}.times(2 / 2.5F));
}

class OnFilm : public ::testing::Test {
 protected:
  // Every colour of a coarse cube; the last row transparent.
  OnFilm() : wanted_(36, 7), raster_{36 / 10.0, 7 / 10.0, 254} {
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 36; ++x) {
        std::uint8_t* pixel = wanted_.pixel(x, y);
        pixel[0] = std::uint8_t(51 * (x % 6));
        pixel[1] = std::uint8_t(51 * (x / 6));
        pixel[2] = std::uint8_t(51 * y);
        pixel[3] = 255;
      }
    stretch_.area_ratio = BlankArray<float>(wanted_.rgba.size() / 4);
    std::fill(stretch_.area_ratio.begin(), stretch_.area_ratio.end(), 1.0F);
    stretch_.on_object = BlankArray<std::uint8_t>(stretch_.area_ratio.size());
    std::fill(stretch_.on_object.begin(), stretch_.on_object.end(), std::uint8_t(1));
  }

  Reach reach(const InkingOptions& options) {
    const Inking inking = ink_film(wanted_, stretch_.area_ratio, *model_, options, context_);
    lightened_ = inking.lightened;
    inks_ = inking.inks;
    printed_ = inking.printed;
    const Image seen = look_on_object(inks_, stretch_.area_ratio, *model_, options.base);
    return reach_of(seen);
  }

  // All rows at once.
  Reach reach_of(const Image& seen, const Box2& film = {}) const {
    ReachMeter meter(raster_, film);
    meter.add({0, wanted_.height_px}, wanted_, seen, stretch_);
    return meter.result();
  }

  void stretch(float ratio) {
    std::fill(stretch_.area_ratio.begin(), stretch_.area_ratio.end(), ratio);
  }

  Image wanted_;
  SheetRaster raster_;
  FilmStretch stretch_;
  std::unique_ptr<ColorModel> model_ = make_device_model();
  RunContext context_;
  InkImage inks_;
  PixelSet printed_;
  double lightened_ = 0;
};

TEST_F(OnFilm, UnstretchedEverythingIsWithinReach) {
  const Reach found = reach({});
  EXPECT_NEAR(found.compared_mm2, 36 * 6 * 0.01, 1e-6);
  EXPECT_EQ(found.out_of_reach_mm2, 0);
  EXPECT_EQ(found.largest, 0);
}

TEST_F(OnFilm, AreaIsCountedOnTheObject) {
  stretch(1.5F);
  const Reach found = reach({});
  EXPECT_NEAR(found.compared_mm2, 1.5 * 36 * 6 * 0.01, 1e-6);
  // Out of reach: the colours of which a single ink is over 2/3 (a little more, or more in the
  // dark, is not visible); black is not among them.
  int beyond = 0, visible = 0;
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 36; ++x) {
      const std::uint8_t* pixel = wanted_.pixel(x, y);
      const auto [low, high] = std::minmax({pixel[0], pixel[1], pixel[2]});
      const double k = (255 - high) / 255.0, most = (high - low) / 255.0;
      const double spill = std::max(0.0, 1.5 * k - 1);
      beyond += 1.5 * most + spill > 1 + 1e-6;
      visible += high == 255 && 1.5 * most > 1.15;
    }
  EXPECT_LE(found.out_of_reach_mm2, 1.5 * beyond * 0.01 + 1e-9);
  EXPECT_GE(found.out_of_reach_mm2, 1.5 * visible * 0.01 - 1e-9);
  EXPECT_GT(visible, 20);
  EXPECT_LT(found.mean_within, 0.3);  // 8 bits
}

TEST_F(OnFilm, ScalingMakesEverythingFitAndKeepsProportions) {
  stretch(1.5F);
  reach({.policy = GamutPolicy::kScale, .limit = kNoLimit});
  EXPECT_NEAR(lightened_, 1 / 1.5, 1e-6);
  const Image seen = look_on_object(inks_, stretch_.area_ratio, *model_, {1, 1, 1, 1});
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 36; ++x)
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(255 - seen.pixel(x, y)[i], (255 - wanted_.pixel(x, y)[i]) / 1.5, 1);
}

// Pure red, green and blue take two inks in full: half of each where only as much as one may lie.
TEST_F(OnFilm, ScalingKeepsToTheInkLimit) {
  reach({.policy = GamutPolicy::kScale, .limit = 1});
  EXPECT_NEAR(lightened_, 0.5, 1e-6);
}

// To the byte: what is printed is asked for its limit.
TEST_F(OnFilm, NothingThatIsPrintedIsBeyondTheInkLimit) {
  stretch(1.5F);
  for (const double limit : {1.0, 1.2, 1.5, 1.7, 2.0}) {
    reach({.limit = limit});
    int most = 0;
    for (std::size_t i = 0; i < inks_.cmyk.size(); i += 4)
      most =
          std::max(most, inks_.cmyk[i] + inks_.cmyk[i + 1] + inks_.cmyk[i + 2] + inks_.cmyk[i + 3]);
    EXPECT_LE(most, 255 * limit);
    EXPECT_GT(most, 255 * limit - 4);
  }
}

TEST_F(OnFilm, ScalingIsNoLessThanWhatIsAskedFor) {
  reach({.policy = GamutPolicy::kScale, .limit = kNoLimit, .lightened_most = 0.7});
  EXPECT_EQ(lightened_, 0.7);
  stretch(2);
  reach({.policy = GamutPolicy::kScale, .limit = kNoLimit, .lightened_most = 0.7});
  EXPECT_NEAR(lightened_, 0.5, 1e-6);
}

TEST_F(OnFilm, WhatLiesBesideTheObjectIsNotCompared) {
  std::fill_n(stretch_.on_object.begin(), 36 * 3, 0);
  EXPECT_NEAR(reach({}).compared_mm2, 36 * 3 * 0.01, 1e-6);
}

TEST_F(OnFilm, WithoutCompensationTheFilmIsPrintedAsWanted) {
  stretch(1.5F);
  const Reach found = reach({.compensate = false});
  EXPECT_GT(found.mean, 5);
  const Image film = look_on_film(inks_, printed_, *model_);
  EXPECT_EQ(film.rgba, wanted_.rgba);
}

// Bands of any height give what all rows at once give, and nothing is asked of rows that are done.
TEST_F(OnFilm, BandsOfRowsGiveTheSameAsAllRowsAtOnce) {
  Box2 film;
  film.add({-1.5, -0.3});
  film.add({1.5, 0.3});
  for (std::size_t i = 0; i < stretch_.area_ratio.size(); ++i)
    stretch_.area_ratio[i] = 1 + 0.01F * float(i % 90);
  wanted_.pixel(7, 3)[3] = 100;
  for (const GamutPolicy policy : {GamutPolicy::kClip, GamutPolicy::kScale, GamutPolicy::kSoft}) {
    const InkingOptions options{.policy = policy};
    const Inking inking = ink_film(wanted_, stretch_.area_ratio, *model_, options, context_);
    const Image seen = look_on_object(inking.inks, stretch_.area_ratio, *model_, options.base);
    const Reach reach = reach_of(seen, film);
    ASSERT_GT(reach.largest, 0);
    ASSERT_FALSE(reach.difference.values.empty());
    for (const int height : {1, 2, 3, 5, 7}) {
      Image wanted = wanted_;
      FilmStretch stretch = stretch_;
      Inking banded = prepared_inking(wanted, stretch.area_ratio, *model_, options);
      Image look(wanted.width_px, wanted.height_px);
      ReachMeter meter(raster_, film);
      for (int row = 0; row < wanted.height_px; row += height) {
        const RowBand rows{row, std::min(row + height, wanted.height_px)};
        ink_rows(rows, wanted, stretch.area_ratio, *model_, options, banded);
        look_at_rows(rows, banded.inks, stretch.area_ratio, *model_, options.base, look);
        meter.add(rows, wanted, look, stretch);
        const auto done = std::ptrdiff_t(rows.end) * wanted.width_px;
        std::fill_n(wanted.rgba.begin(), 4 * done, 7);
        std::fill_n(stretch.area_ratio.begin(), done, -1);
        std::fill_n(stretch.on_object.begin(), done, 7);
      }
      EXPECT_EQ(banded.inks.cmyk, inking.inks.cmyk) << height;
      EXPECT_EQ(banded.lightened, inking.lightened) << height;
      EXPECT_EQ(look.rgba, seen.rgba) << height;
      const Reach found = meter.result();
      EXPECT_EQ(found.compared_mm2, reach.compared_mm2) << height;
      EXPECT_EQ(found.mean, reach.mean) << height;
      EXPECT_EQ(found.mean_beyond, reach.mean_beyond) << height;
      EXPECT_EQ(found.out_of_reach, reach.out_of_reach) << height;
      // NaN is not NaN.
      EXPECT_EQ(std::memcmp(found.difference.values.data(), reach.difference.values.data(),
                            reach.difference.values.size() * sizeof(float)),
                0)
          << height;
    }
  }
}

// Where anything is printed is known without the picture of what is wanted.
TEST_F(OnFilm, IsPrintedWhereAnythingIsWanted) {
  wanted_.pixel(3, 2)[3] = 1;
  std::fill_n(wanted_.pixel(5, 5), 4, 255);  // white: no ink, but not bare
  reach({});
  const Image film = look_on_film(inks_, printed_, *model_);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 36; ++x) {
      ASSERT_EQ(printed_.contains(x, y), wanted_.pixel(x, y)[3] != 0) << x << ", " << y;
      ASSERT_EQ(film.pixel(x, y)[3], printed_.contains(x, y) ? 255 : 0) << x << ", " << y;
    }
}

// A grey base is a filter: white is out of reach, what is darker than the base is not.
TEST_F(OnFilm, TheBaseColourShowsThrough) {
  const float light = srgb_to_linear(0.6F);
  const Reach found = reach({.base = {light, light, light, 1}});
  const Image seen = look_on_object(inks_, stretch_.area_ratio, *model_, {light, light, light, 1});
  EXPECT_GT(found.out_of_reach_mm2, 0);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 36; ++x)
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(seen.pixel(x, y)[i], std::min<int>(153, wanted_.pixel(x, y)[i]), 1);
  EXPECT_EQ(seen.pixel(0, 6)[0], 153);  // no film: the bare base
}

// Sharma, Wu and Dalal (2005) give pairs in CIELAB; grey differs by lightness alone, where
// the formula is dL / S_L.
TEST(Difference, AgreesWithTheFormulaForGreys) {
  const auto lightness = [](double v) {
    const double y = double(srgb_to_linear(float(v)));
    return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
  };
  for (const auto& [a, b] : {std::pair{0.2, 0.3}, {0.5, 0.52}, {0.8, 0.9}}) {
    const double la = lightness(a), lb = lightness(b), mean = 0.5 * (la + lb) - 50;
    const double s = 1 + 0.015 * mean * mean / std::sqrt(20 + mean * mean);
    const auto grey = [](double v) { return SrgbColor{float(v), float(v), float(v)}; };
    EXPECT_NEAR(color_difference(grey(a), grey(b)), (lb - la) / s, 0.01);
  }
}

}  // namespace
}  // namespace hydrodip
