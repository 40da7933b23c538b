#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "base/file.h"
#include "contains.h"
#include "loop.h"
#include "refusal.h"
#include "register/displacement_fit.h"
#include "register/place_table.h"
#include "register/tank_file.h"
#include "register/true_size.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

// ---- fits ----

std::vector<CorrectionSample> scattered(const std::function<Vec2(const Vec2&)>& move, int count,
                                        double noise_mm) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> any(-50, 50);
  std::normal_distribution<double> noise(0, noise_mm);
  std::vector<CorrectionSample> samples;
  for (int i = 0; i < count; ++i) {
    const Vec2 at(any(random), any(random));
    samples.push_back({at, move(at) + Vec2(noise(random), noise(random))});
  }
  return samples;
}

TEST(DisplacementFit, ReturnsAnAffineFieldExactly) {
  const auto affine = [](const Vec2& u) -> Vec2 {
    return {0.4 + 0.01 * u.x(), -0.3 + 0.004 * u.x() - 0.02 * u.y()};
  };
  const auto fit = fit_displacements(scattered(affine, 40, 0), {Vec2(-60, -60), Vec2(60, 60)});
  for (const Vec2& u : {Vec2(0, 0), Vec2(33, -41), Vec2(-55, 58)})
    EXPECT_LT((fit.field.at(u) - affine(u)).norm(), 1e-3);
}

TEST(DisplacementFit, IsNearerToTheTruthThanItsNoisySamplesAndKnowsHowNear) {
  const auto truth = [](const Vec2& u) -> Vec2 {
    return {std::sin(u.x() / 25), 0.7 * std::cos(u.y() / 30 + u.x() / 60)};
  };
  constexpr double kNoise_mm = 0.1;
  const auto fit =
      fit_displacements(scattered(truth, 200, kNoise_mm), {Vec2(-50, -50), Vec2(50, 50)});
  double square = 0, told = 0, count = 0;
  for (int j = 0; j < fit.field.ny; ++j)
    for (int i = 0; i < fit.field.nx; ++i) {
      const Vec2 u = fit.field.first + fit.field.pitch_mm * Vec2(i, j);
      if (u.cwiseAbs().maxCoeff() > 45) continue;
      const auto at = std::size_t(j) * std::size_t(fit.field.nx) + std::size_t(i);
      square += (fit.field.move[at] - truth(u)).squaredNorm();
      told += 2 * fit.sigma_mm[at] * fit.sigma_mm[at];
      ++count;
    }
  EXPECT_LT(std::sqrt(square / count), 0.6 * kNoise_mm);
  EXPECT_NEAR(fit.noise_mm, kNoise_mm, 0.05);
  EXPECT_LT(std::sqrt(square), 2 * std::sqrt(told));
  EXPECT_GT(std::sqrt(square), 0.4 * std::sqrt(told));
}

// However many dips are averaged, a sample is foretold no better than its own noise.
TEST(DisplacementFit, ForetellsASampleAsWellAsItsNoiseAllows) {
  constexpr double kNoise_mm = 0.1;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, kNoise_mm);
  for (const int dips : {1, 3, 12}) {
    std::vector<CorrectionSample> samples;
    for (int i = 0; i < 169 * dips; ++i) {
      const Vec2 at(8 * (i % 13) - 48, 8 * (i % 169 / 13) - 48);
      samples.push_back({at, Vec2(std::sin(at.x() / 25) + noise(random), noise(random))});
    }
    const DisplacementFit fit = fit_displacements(samples, {Vec2(-50, -50), Vec2(50, 50)});
    EXPECT_NEAR(fit.left_out_rms_mm, std::sqrt(2.0) * kNoise_mm, 0.015) << dips;
    EXPECT_GT(fit.left_out_rms_mm, 0.97 * std::sqrt(2.0) * fit.noise_mm) << dips;
  }
}

TEST(DisplacementFit, RefusesWhatTellsNoField) {
  const auto still = [](const Vec2&) -> Vec2 { return {0, 0}; };
  const auto why = [](const std::vector<CorrectionSample>& samples) {
    return refusal([&] { fit_displacements(samples, {Vec2(-9, -9), Vec2(9, 9)}); });
  };
  EXPECT_TRUE(contains(why({}), "0 places of the film that can be used: at least"));
  EXPECT_TRUE(contains(why(scattered(still, 8, 0)), "8 places of the film that can be used: at"));
  // Enough of them, but not where they tell anything.
  std::vector<CorrectionSample> line;
  line.reserve(40);
  for (int i = 0; i < 40; ++i) line.push_back({Vec2(i, 2 * i), Vec2(0.1, 0)});
  EXPECT_TRUE(contains(why(line), "have to be spread over the film"));
}

TEST(ClosedLoop, TheSecondPrintIsRightWhateverTheFilmModelMisses) {
  const std::vector<double> error = fixtures::ClosedLoop({}).run();
  EXPECT_GT(error[0], 0.8);
  EXPECT_LT(error[1], error[0] / 5);
  EXPECT_LT(error[2], error[0] / 10);
}

// ---- true size ----

// What a printer that is off makes of a point of the page.
Vec2 printed(const PrinterScale& printer, const Vec2& p) {
  return {printer.x * p.x() + printer.skew * p.y(), printer.y * p.y()};
}

TEST(TrueSize, IsReadOffFourLengths) {
  const TestSheet sheet = test_sheet(210, 297);
  const PrinterScale truth{1.0052, 0.9961, 0.0031};
  const Vec2 a = printed(truth, {-0.5 * sheet.across_mm, -0.5 * sheet.along_mm}),
             b = printed(truth, {0.5 * sheet.across_mm, -0.5 * sheet.along_mm}),
             c = printed(truth, {-0.5 * sheet.across_mm, 0.5 * sheet.along_mm}),
             d = printed(truth, {0.5 * sheet.across_mm, 0.5 * sheet.along_mm});
  // A rule is read to 0.05 mm.
  const auto read = [](double mm) { return std::round(mm / 0.05) * 0.05; };
  const PrinterReadings readings{read((b - a).norm()), read((c - a).norm()), read((d - a).norm()),
                                 read((b - c).norm())};
  const PrinterScale found = scale_by(readings, sheet);
  // Over 250 mm, corrected, to what the rule gives.
  EXPECT_NEAR(250 * truth.x / found.x, 250, 0.05);
  EXPECT_NEAR(250 * truth.y / found.y, 250, 0.05);
  EXPECT_NEAR(found.skew, truth.skew, 4e-4);
  EXPECT_THROW(scale_by(PrinterReadings{180, 250, 310, 290}, sheet), InputError);
  // Said by its likely cause.
  const auto says = [&sheet](double across_mm, double along_mm, const std::string& cause) {
    const double diagonal_mm = std::hypot(across_mm, along_mm);
    EXPECT_NE(refusal([&] {
                scale_by(PrinterReadings{across_mm, along_mm, diagonal_mm, diagonal_mm}, sheet);
              }).find(cause),
              std::string::npos)
        << cause;
  };
  says(180, 230, "--film letter");
  says(180 * 0.94, 250 * 0.94, "fit the page");
  says(180 / 25.4, 250 / 25.4, "in inches");
  says(18, 25, "in centimetres");
  says(180 * 0.96, 250, "what was measured");
}

TEST(TrueSize, IsReadOffAScanHoweverTheSheetLay) {
  const TestSheet sheet = test_sheet(215.9, 279.4);
  const PrinterScale truth{1.0052, 0.9961, 0.0031};
  std::vector<SeenMark> seen;
  constexpr double kDpi = 300, kTurn = 1.6;
  for (const MarkPlace& mark : sheet.marks) {
    const Vec2 p = printed(truth, mark.corner);
    const Vec2 turned(std::cos(kTurn) * p.x() - std::sin(kTurn) * p.y(),
                      std::sin(kTurn) * p.x() + std::cos(kTurn) * p.y());
    seen.push_back({mark.id, kDpi / 25.4 * Vec2(turned.x() + 140, 160 - turned.y()), 10});
  }
  const PrinterScale found = scale_by(seen, kDpi, sheet, "scan.png");
  EXPECT_NEAR(found.x, truth.x, 1e-9);
  EXPECT_NEAR(found.y, truth.y, 1e-9);
  EXPECT_NEAR(found.skew, truth.skew, 1e-9);
  seen.resize(3);
  EXPECT_THROW(scale_by(seen, kDpi, sheet, "scan.png"), InputError);
}

// ---- files ----

class RegisterFiles : public ::testing::Test {
 protected:
  std::filesystem::path written(const std::string& text) {
    std::filesystem::path file = folder_ / "file";
    write_file(file, text);
    return file;
  }
  TemporaryFolder folder_;
};

TEST_F(RegisterFiles, ATankIsReadAsItWasWritten) {
  Tank tank;
  tank.width_px = 4000;
  tank.height_px = 3000;
  tank.lens = {2950.25, {2012, 1489}, -0.045, 0.018, 6e-4, -4e-4};
  tank.lens_covariance.diagonal() << 4, 1, 1, 1e-6, 1e-6, 1e-8, 1e-8;
  tank.place = {{3, -4.5}, 90.5};
  tank.water_below_mm = 22;
  tank.corner_mm = {{100, {1, 2, 3}}, {117, {-4, 5.5, 0}}};
  const Tank read = read_tank(written(tank_as_json(tank)));
  EXPECT_EQ(read.lens.values(), tank.lens.values());
  EXPECT_EQ(read.lens_covariance, tank.lens_covariance);
  EXPECT_EQ(read.corner_mm, tank.corner_mm);
  EXPECT_EQ(read.place.turn_deg, 90.5);
  EXPECT_EQ(read.water_below_mm, 22);
}

TEST_F(RegisterFiles, ALensThatFoldsThePictureIsRefused) {
  Tank tank;
  tank.width_px = 4000;
  tank.height_px = 3000;
  tank.lens_covariance.setIdentity();
  tank.lens = {2950, {2000, 1500}, -0.045, 0.018, 6e-4, -4e-4};
  EXPECT_NO_THROW(read_tank(written(tank_as_json(tank))));
  tank.lens.k1 = 1000;
  EXPECT_THROW(read_tank(written(tank_as_json(tank))), InputError);
  tank.lens = {1.5, {2000, 1500}, -0.045, 0.018, 6e-4, -4e-4};
  EXPECT_THROW(read_tank(written(tank_as_json(tank))), InputError);
}

TEST_F(RegisterFiles, CalibratingAnewKeepsTheLevelAndThePlaceOfStripsThatStay) {
  Tank earlier;
  earlier.water_below_mm = 22;
  earlier.place = {{3, -4.5}, 90.5};
  earlier.corner_mm = {{100, {1, 2, 3}}, {117, {-4, 5.5, 0}}};
  Tank tank;
  tank.corner_mm = {{100, {1.2, 2, 3}}, {117, {-4, 5.6, 0}}};
  EXPECT_TRUE(keep_what_was_said(earlier, tank));
  EXPECT_EQ(tank.water_below_mm, 22);
  EXPECT_EQ(tank.place.turn_deg, 90.5);
  Tank moved;
  moved.corner_mm = {{100, {9, 2, 3}}, {117, {-4, 5.6, 0}}};
  EXPECT_FALSE(keep_what_was_said(earlier, moved));
  EXPECT_EQ(moved.water_below_mm, 22);
  EXPECT_EQ(moved.place.turn_deg, 0);
}

TEST_F(RegisterFiles, WhatIsNoneIsRefused) {
  for (const char* text : {"", "{}", "[1,2]", "{\"photo_px\":[1,2]}", "\xff\xfe"}) {
    EXPECT_THROW(read_tank(written(text)), InputError) << text;
    EXPECT_THROW(read_correction(written(text)), InputError) << text;
  }
  EXPECT_THROW(read_correction(written("{\"grid\":{\"first_mm\":[0,0],\"pitch_mm\":5,\"nx\":1e9,"
                                       "\"ny\":1e9,\"move_mm\":[]},\"samples\":[]}")),
               InputError);
}

TEST_F(RegisterFiles, PlacesAreReadFromATable) {
  const auto file = written("film_x_mm,film_y_mm,x,y,z\r\n1,2,3.5,-4,5\r\n\n-1,0,0,0,1e-3\n");
  ASSERT_TRUE(is_place_table(file));
  const auto rows = read_place_table(file);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].on_sheet, Vec2(1, 2));
  EXPECT_EQ(rows[0].position, Vec3(3.5, -4, 5));
  for (const char* bad : {"1,2,3,4\n", "1,2,3,4,5,6\n", "1,2,x,4,5\n", "1,2,nan,4,5\n"})
    EXPECT_THROW(read_place_table(written(std::string("film_x_mm,film_y_mm,x,y,z\n") + bad)),
                 InputError)
        << bad;
  EXPECT_FALSE(is_place_table(written("column,row,x,y,z\n")));
}

TEST_F(RegisterFiles, PlacesAreReadAsSpreadsheetsSaveThem) {
  for (const char* text :
       {"film_x_mm;film_y_mm;x;y;z\r\n1,5;-2;3,5;-4;5\r\n",
        "\xef\xbb\xbf"
        "film_x_mm\tfilm_y_mm\tx\ty\tz\r\n1,5\t-2\t3,5\t-4\t5\r\n",
        "# measured by "
        "hand\n\"film_x_mm\",\"film_y_mm\",\"x\",\"y\",\"z\"\n\"1.5\",\"-2\",\"3.5\",-4,5\n",
        "film_x_mm, film_y_mm, x, y, z\n1.5, -2, 3.5, -4, 5"}) {
    const auto file = written(text);
    ASSERT_TRUE(is_place_table(file)) << text;
    const auto rows = read_place_table(file);
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].on_sheet, Vec2(1.5, -2));
    EXPECT_EQ(rows[0].position, Vec3(3.5, -4, 5));
  }
  // Columns in another order are no table of corners either.
  const auto swapped = written("film_y_mm,film_x_mm,x,y,z\n1,2,3,4,5\n");
  ASSERT_TRUE(is_place_table(swapped));
  EXPECT_EQ(
      refusal([&] { read_place_table(swapped); }),
      swapped.string() + ": a table of places begins with the line film_x_mm,film_y_mm,x,y,z");
}

}  // namespace
}  // namespace hydrodip
