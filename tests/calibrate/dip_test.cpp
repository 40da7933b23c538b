#include <gtest/gtest.h>

#include <map>

#include "base/error.h"
#include "calibrate/kit_shapes.h"
#include "calibrate/printed_board.h"
#include "calibrate/rounded_pyramid.h"
#include "object/health.h"
#include "refusal.h"
#include "scans.h"

namespace hydrodip {
namespace {

TEST(BlackBoardTest, SquaresAlternateAroundTheCentreAndStayInsideTheTape) {
  FilmOptions film;
  film.width_mm = 100;
  film.height_mm = 80;
  const PrintedBoard board = print_board(film, black_board(5));
  const auto inked = [&](double x, double y) {
    const Vec2 p = board.raster.to_pixel({x, y});
    return board.inks.pixel(int(p.x()), int(p.y()))[3] == 255;
  };
  for (double x = -37.5; x < 38; x += 5)
    for (double y = -27.5; y < 28; y += 5)
      EXPECT_EQ(inked(x, y), (long(std::floor(x / 5)) + long(std::floor(y / 5))) % 2 == 0);
  EXPECT_FALSE(inked(42.5, 2.5));
  EXPECT_FALSE(inked(2.5, 32.5));
  // Half of the free film.
  double sum = 0;
  for (std::size_t i = 3; i < board.inks.cmyk.size(); i += 4) sum += board.inks.cmyk[i] / 255.0;
  const double pixel_mm = kMmPerInch / board.raster.dpi;
  EXPECT_NEAR(sum * pixel_mm * pixel_mm, 0.5 * 80 * 60, 20);
}

// So that no scan of a shape that looks alike from several sides can be read the wrong way round.
TEST(TintBoardTest, LooksTheSameAfterAQuarterTurnAndInAMirror) {
  const Board board = tint_board(4);
  for (int column = -9; column <= 9; ++column)
    for (int row = -9; row <= 9; ++row) {
      EXPECT_EQ(board.ink_of({column, row}), board.ink_of({-row, column}));
      EXPECT_EQ(board.ink_of({column, row}), board.ink_of({-column, row}));
    }
  // The middle of a square is the film's centre: turned about it, corners are corners.
  EXPECT_EQ(board.on_film({0, 0}), Vec2(-2, -2));
  EXPECT_EQ(board.on_film({1, 1}), Vec2(2, 2));
  EXPECT_EQ(board.square_at({0, 0}), (GridPlace{0, 0}));
  EXPECT_EQ(board.square_at({-2.1, 1.9}), (GridPlace{-1, 0}));
}

TEST(TintBoardTest, EveryCornerIsADarkSquares) {
  const Board board = tint_board(5);
  for (int column = -9; column <= 9; ++column)
    for (int row = -9; row <= 9; ++row) {
      int dark = 0;
      for (const int dx : {-1, 0})
        for (const int dy : {-1, 0}) dark += board.ink_of({column + dx, row + dy}) > 200;
      EXPECT_EQ(dark, 1);
    }
}

TEST(TintBoardTest, IsPrintedAsItIsSimulated) {
  FilmOptions film;
  film.width_mm = 101;
  film.height_mm = 80;
  const Board board = tint_board(5);
  const PrintedBoard printed = print_board(film, board);
  for (double x = -37.3; x < 38; x += 1.9)
    for (double y = -27.2; y < 28; y += 1.7) {
      const Vec2 p = printed.raster.to_pixel({x, y});
      EXPECT_EQ(printed.inks.pixel(int(p.x()), int(p.y()))[3],
                board.ink_of(board.square_at({x, y})))
          << x << " " << y;
    }
}

TEST(CalibrationObjectTest, DepthsAndNames) {
  RunContext context;
  const JobConfig config = scans::quick_config();
  EXPECT_EQ(calibration_object("sphere", config, context).depth_mm, 12);
  EXPECT_EQ(calibration_object("sphere@9.5", config, context).depth_mm, 9.5);
  EXPECT_THROW(calibration_object("sphere@-1", config, context), InputError);
  EXPECT_THROW(calibration_object("no-such.obj@3", config, context), InputError);
  EXPECT_EQ(refusal([&] { calibration_object("sphere@9999", config, context); }),
            "sphere@9999: the depth after '@' must be above 0 and below 5000 mm");
  EXPECT_EQ(refusal([&] { calibration_object("spere-90", config, context); }),
            "spere-90: is neither a model file nor one of the shapes sphere-90, pyramid-90, "
            "ellipsoid-135, sphere, pyramid, ellipsoid; did you mean 'sphere-90'?");
}

TEST(SyntheticTest, SameSeedSameScanAndNoiseAsAsked) {
  RunContext context;
  const scans::Truth truth("sphere", {0.65, 30, 0.1}, context);
  const auto scan = [&](const SyntheticOptions& options) {
    return synthetic_scan(truth.dip.landing(truth.object), {12, 12}, options);
  };
  const CornerGrid clean = scan({.aligned = true});
  const CornerGrid noisy = scan({.noise_mm = 0.05, .seed = 3, .aligned = true});
  const CornerGrid again = scan({.noise_mm = 0.05, .seed = 3, .aligned = true});
  ASSERT_EQ(clean.position.size(), noisy.position.size());
  double sum = 0;
  for (std::size_t c = 0; c < clean.position.size(); ++c) {
    EXPECT_EQ(noisy.position[c], again.position[c]);
    sum += (noisy.position[c] - clean.position[c]).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(sum / (3.0 * double(clean.position.size()))), 0.05, 0.01);
  const CornerGrid gaps = scan({.missing_share = 0.33, .seed = 5});
  EXPECT_NEAR(double(gaps.position.size()) / double(clean.position.size()), 0.67, 0.15);
  // The film's middle is the middle of a square, and lands on the lowest point.
  Vec3 middle = Vec3::Zero();
  for (std::size_t c = 0; c < clean.place.size(); ++c)
    for (const GridPlace& around : {GridPlace{0, 0}, {1, 0}, {0, 1}, {1, 1}})
      if (clean.place[c] == around) middle += clean.position[c] / 4;
  EXPECT_LT(middle.head<2>().norm(), 0.05);
}

class KitShapeTest : public testing::TestWithParam<const char*> {};

TEST_P(KitShapeTest, IsOneClosedBodyWhoseDippedSideIsTheSamples) {
  const std::string name = GetParam();
  const KitShape& known = *find_shape(name);
  Object shape = kit_shape(known);
  // Every edge twice, once in each direction.
  std::map<std::pair<int, int>, int> edges;
  for (const Triangle& t : shape.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  double volume = 0;
  for (const Triangle& t : shape.triangles)
    volume += shape.positions[std::size_t(t[0])].dot(
                  shape.positions[std::size_t(t[1])].cross(shape.positions[std::size_t(t[2])])) /
              6;
  EXPECT_GT(volume, 0);  // outward
  EXPECT_NEAR(shape.bounds().min.z(), 0, 1e-9);

  // Hung up again, it is the sample below the depth of its dip.
  const double top = shape.bounds().max.z();
  for (Vec3& p : shape.positions) p = Vec3(p.x(), -p.y(), top - p.z());
  const TriangleMesh sample = mesh_of(known);
  const Surface a(shape.positions, shape.triangles), b(sample.positions, sample.triangles);
  int compared = 0;
  for (const Vec3& p : sample.positions) {
    if (p.z() > known.depth_mm) continue;
    const auto hit = a.closest_point(p, 1);
    ASSERT_TRUE(hit);
    EXPECT_LT(hit->t, 0.02);
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

INSTANTIATE_TEST_SUITE_P(All, KitShapeTest,
                         testing::Values("sphere-90", "pyramid-90", "ellipsoid-135"));

// Dykstra's projections onto a cone's four half-spaces.
double distance_to_cone(const Vec3& point, const Vec3& apex, const std::vector<Vec3>& normals) {
  Vec3 at = point - apex;
  std::vector<Vec3> kept(normals.size(), Vec3::Zero());
  for (int round = 0; round < 500; ++round)
    for (std::size_t k = 0; k < normals.size(); ++k) {
      const Vec3 from = at + kept[k];
      at = from - std::max(0.0, normals[k].dot(from)) * normals[k];
      kept[k] = from - at;
    }
  return (point - apex - at).norm();
}

TEST(RoundedPyramidTest, IsWhatABallRollingInsideTheSharpOneTouches) {
  constexpr double kWidth = 90, kHeight = 36, kRadius = 6;
  const RoundedPyramid pyramid = rounded_pyramid(kWidth, kHeight, kRadius);
  std::vector<Vec3> normals;
  for (const auto& [x, y] : {std::pair(1, 0), std::pair(0, 1), std::pair(-1, 0), std::pair(0, -1)})
    normals.push_back(Vec3(2 * kHeight / kWidth * x, 2 * kHeight / kWidth * y, -1).normalized());
  const Surface surface(pyramid.closed().positions, pyramid.closed().triangles);
  int touched = 0;
  for (double x = -44; x <= 44; x += 2.3)
    for (double y = -44; y <= 44; y += 1.9) {
      const auto hit = surface.first_hit({x, y, -1}, Vec3::UnitZ(), 0, 100);
      ASSERT_TRUE(hit);
      const Vec3 p = surface.position(*hit);
      EXPECT_NEAR(distance_to_cone(p, {0, 0, kRadius}, normals), kRadius, 0.003) << x << " " << y;
      ++touched;
    }
  EXPECT_GT(touched, 1000);
  // Its faces and its width are those of the sharp one.
  const Box3 box = pyramid.closed().bounds();
  EXPECT_NEAR(box.size().x(), kWidth, 1e-9);
  EXPECT_NEAR(box.size().y(), kWidth, 1e-9);
  const auto face = surface.first_hit({30, 3, -1}, Vec3::UnitZ(), 0, 100);
  const auto further = surface.first_hit({40, -5, -1}, Vec3::UnitZ(), 0, 100);
  ASSERT_TRUE(face && further);
  EXPECT_NEAR(surface.position(*further).z() - surface.position(*face).z(),
              10 * 2 * kHeight / kWidth, 1e-6);
}

}  // namespace
}  // namespace hydrodip
