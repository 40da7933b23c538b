#include "plan/fit.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "base/error.h"
#include "contains.h"
#include "object/posed_object.h"
#include "samples/samples.h"

namespace hydrodip {
namespace {

// A funnel: point down, 10 mm deep per 10 mm of half width, 100 mm square on top at z = 50.
TriangleMesh funnel() {
  TriangleMesh object;
  object.positions = {{0, 0, 0}, {-50, -50, 50}, {50, -50, 50}, {50, 50, 50}, {-50, 50, 50}};
  object.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}, {1, 2, 3}, {1, 3, 4}};
  return object;
}

double size_of(const TriangleMesh& object) { return object.bounds().size().maxCoeff(); }

struct Room {
  FilmOptions film = {};
  BathOptions bath = {};
  double depth_mm = 50;
};

std::string fit_error(const TriangleMesh& object, const Room& room) {
  RunContext context;
  try {
    require_fit(size_of(object), room_of(object, room.depth_mm), room.film, room.bath, context);
  } catch (const InputError& error) {
    return error.what();
  }
  return "fits";
}

TEST(Fit, SaysByHowMuchAndHowToMend) {
  Room room;
  room.film = {100, 300, FilmShape::kRectangle, 10, 1000};
  const std::string message = fit_error(funnel(), room);
  EXPECT_TRUE(contains(message, "100 mm wide (x), 20 mm more than the 80 mm")) << message;
  EXPECT_TRUE(contains(message, "--size 70 or less")) << message;
}

// Neither the next refusal nor the warning of little film comes of what is proposed.
TEST(Fit, TheSizeThatIsToldFitsInEveryDirectionWithFilmLeft) {
  TriangleMesh object = funnel();
  for (Vec3& p : object.positions) p.y() *= 2.4;  // 100 x 240 mm
  const FilmOptions film{100, 200, FilmShape::kRectangle, 10, 1000};
  const BathOptions bath{370, 270, 30};  // too shallow besides
  const auto made = [&](double size_mm) {
    TriangleMesh sized = object;
    for (Vec3& p : sized.positions) p *= size_mm / 240;
    RunContext context;
    std::string error;
    try {
      require_fit(size_mm, room_of(sized, sized.bounds().max.z()), film, bath, context);
    } catch (const InputError& refused) {
      error = refused.what();
    }
    return std::pair(error, context.warnings().size());
  };
  double size_mm = 0;
  const std::string refused = made(240).first;
  const std::size_t told = refused.find("--size ");
  ASSERT_NE(told, std::string::npos) << refused;
  ASSERT_EQ(std::sscanf(refused.c_str() + told, "--size %lf or less", &size_mm), 1) << refused;
  EXPECT_EQ(made(size_mm), std::pair(std::string(), std::size_t(0)));
  EXPECT_NE(made(size_mm + 1), std::pair(std::string(), std::size_t(0)));
}

// Of film that the bath has no room for that is said.
TEST(Fit, ALargerFilmIsProposedWithTheBathItNeeds) {
  Room room;
  room.film = {100, 300, FilmShape::kRectangle, 10, 1000};
  const std::string roomy = fit_error(funnel(), room);
  EXPECT_TRUE(contains(roomy, "take a larger --film (the bath has room for 270 x 370 mm)"))
      << roomy;
  room.bath = {370, 125, 150};
  const std::string narrow = fit_error(funnel(), room);
  EXPECT_TRUE(contains(narrow, "take a larger --film in a larger bath (bath.width_mm")) << narrow;
}

TEST(Fit, OnlyTheWetPartCounts) {
  Room room;
  room.film = {100, 100, FilmShape::kRectangle, 10, 1000};
  EXPECT_NE(fit_error(funnel(), room), "fits");
  room.depth_mm = 40;  // there the funnel is 80 mm wide
  EXPECT_EQ(fit_error(funnel(), room), "fits");
  room.depth_mm = 41;
  EXPECT_TRUE(contains(fit_error(funnel(), room), "82 mm wide (x), 2 mm more"));
}

TEST(Fit, TheDiscIsMeasuredAcrossTheDiagonal) {
  Room room;
  room.film = {162, 162, FilmShape::kDisc, 10, 1000};
  EXPECT_EQ(fit_error(funnel(), room), "fits");  // 141.42 of 142 mm
  room.film.width_mm = 161;                      // the smaller extent counts
  EXPECT_TRUE(contains(fit_error(funnel(), room), "141.42 mm across, 0.42 mm more"));
}

TEST(Fit, TheBathHasWidthLengthAndDepth) {
  Room room;
  room.film = {400, 300, FilmShape::kRectangle, 10, 1000};
  room.bath = {90, 300, 150};  // turned with the sheet: 300 along x
  EXPECT_TRUE(contains(fit_error(funnel(), room), "100 mm long (y), 10 mm more than the 90 mm"));
  room.bath = {300, 300, 45};
  const std::string message = fit_error(funnel(), room);
  EXPECT_TRUE(contains(message, "50 mm deep in the water, 5 mm more than the 45 mm")) << message;
  EXPECT_TRUE(contains(message, "--depth")) << message;
  room.depth_mm = 45;
  EXPECT_EQ(fit_error(funnel(), room), "fits");
}

TEST(Fit, WarnsAboutAFilmLargerThanTheBathAndAboutATightOne) {
  Room room;
  RunContext context;
  room.film = {297, 420, FilmShape::kRectangle, 10, 1000};
  require_fit(size_of(funnel()), room_of(funnel(), room.depth_mm), room.film, room.bath, context);
  ASSERT_EQ(context.warnings().size(), 1u);
  EXPECT_TRUE(contains(context.warnings()[0], "larger than the bath"));

  RunContext tight;
  room.film = {122, 297, FilmShape::kRectangle, 10, 1000};
  require_fit(size_of(funnel()), room_of(funnel(), room.depth_mm), room.film, room.bath, tight);
  ASSERT_EQ(tight.warnings().size(), 1u);
  EXPECT_TRUE(contains(tight.warnings()[0], "Only 1 mm of free film"));
}

// From 5 mm of free film on a side it is enough.
TEST(Fit, WarnsOfLessThanFiveMillimetresOnASide) {
  for (const auto& [on_a_side_mm, warnings] : {std::pair{4.9, 1U}, {5.1, 0U}}) {
    Room room;
    room.film = {100 + 20 + 2 * on_a_side_mm, 297, FilmShape::kRectangle, 10, 1000};
    RunContext context;
    require_fit(size_of(funnel()), room_of(funnel(), room.depth_mm), room.film, room.bath, context);
    ASSERT_EQ(context.warnings().size(), warnings) << on_a_side_mm;
    if (warnings > 0) {
      EXPECT_TRUE(contains(context.warnings()[0], "Only 4.9 mm of free film"));
    }
  }
}

// With a depth that was given, the one that goes with the size is told too, and both together fit.
TEST(Fit, TheSizeAndDepthThatAreToldFit) {
  const auto sphere = std::make_shared<const Object>(make_sample("sphere"));
  const FilmOptions film{120, 120, FilmShape::kRectangle, 10, 1000};
  const auto error_at = [&](double size_mm, double depth_mm) {
    const PosedObject posed(sphere, {.size_mm = size_mm});
    RunContext context;
    try {
      require_fit(posed.size_mm(), room_of(posed.mesh(), depth_mm), film, {}, context);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string refused = error_at(200, 30);
  double size_mm = 0, depth_mm = 0;
  const std::size_t told = refused.find("--size ");
  ASSERT_NE(told, std::string::npos) << refused;
  ASSERT_EQ(std::sscanf(refused.c_str() + told, "--size %lf and --depth %lf", &size_mm, &depth_mm),
            2)
      << refused;
  EXPECT_EQ(error_at(size_mm, depth_mm), "") << refused;
  // Up to the tape it is 10 mm more than to where film is left beside it.
  EXPECT_NE(error_at(size_mm + 22, depth_mm * (size_mm + 22) / size_mm), "");
}

// A size is the object's own, however it hangs.
TEST(Fit, TheSizeThatIsToldFits) {
  const auto pyramid = std::make_shared<const Object>(make_sample("pyramid"));
  const auto error_at = [&](double size_mm) {
    const PosedObject posed(pyramid, {.size_mm = size_mm, .rotate_deg = {0, 0, 45}});
    const FilmOptions film{80, 80, FilmShape::kRectangle, 10, 1000};
    RunContext context;
    try {
      require_fit(posed.size_mm(), room_of(posed.mesh(), 100), film, {}, context);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_TRUE(contains(error_at(60), "--size 35 or less")) << error_at(60);  // 50 / sqrt(2)
  EXPECT_EQ(error_at(35), "");
  EXPECT_EQ(error_at(42), "");
  EXPECT_NE(error_at(43), "");
}

TEST(Fit, AHugeMisfitAsksForTheUnits) {
  TriangleMesh object = funnel();
  for (Vec3& p : object.positions) p *= 1000;
  EXPECT_TRUE(contains(fit_error(object, {.depth_mm = 50000}), "--units"));
}

}  // namespace
}  // namespace hydrodip
