#include "studio/mends.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

#include "samples/samples.h"
#include "settings/settings.h"

namespace hydrodip {
namespace {

// The pyramid over a sheet that is too small for it.
class Misfit : public ::testing::Test {
 protected:
  void SetUp() override {
    config.design.film.width_mm = config.design.film.height_mm = 80;
    config.object.pose.rotate_deg = {0, 0, 45};
  }

  PosedObject posed() const { return {pyramid, config.object.pose}; }
  Json mend_of(const std::string& group) const {
    for (const Json& mend : room_mends(config, posed()))
      if (mend["patch"].contains(group)) return mend;
    return nullptr;
  }

  const std::shared_ptr<const Object> pyramid =
      std::make_shared<const Object>(make_sample("pyramid"));
  JobConfig config;
};

TEST_F(Misfit, TheSizeThatIsOfferedFitsATurnedObject) {
  ASSERT_NE(misfit(config, posed().mesh()), "");
  const Json mend = mend_of("object");
  ASSERT_FALSE(mend.is_null());
  config.object.pose.size_mm = mend["patch"]["object"]["size_mm"];
  EXPECT_EQ(config.object.pose.size_mm, 35);  // of 60 mm free film 50, and those by sqrt(2)
  EXPECT_EQ(misfit(config, posed().mesh()), "");
}

// At one depth a smaller pyramid is as wide at the water line, until all of it is wet.
TEST_F(Misfit, TheSizeThatIsOfferedFitsAtTheDepthThatIsGiven) {
  config.design.trajectory.depth_mm = 20;
  config.object.pose.size_mm = 80;
  ASSERT_NE(misfit(config, posed().mesh()), "");
  config.object.pose.size_mm = mend_of("object")["patch"]["object"]["size_mm"];
  EXPECT_EQ(misfit(config, posed().mesh()), "");
}

// Nobody says twice how deep it goes.
TEST_F(Misfit, APathIsOfferedNoDepth) {
  config.object.pose = {};
  config.design.film.width_mm = config.design.film.height_mm = 200;
  config.bath.depth_mm = 10;
  EXPECT_FALSE(mend_of("dip").is_null());
  config.design.trajectory.path = {{.shift_x_mm = 5}, {.lower_mm = 20, .shift_x_mm = 5}};
  ASSERT_NE(misfit(config, posed().mesh()), "");
  EXPECT_TRUE(mend_of("dip").is_null());
}

// What hangs beside the film is not too large for it.
TEST_F(Misfit, WhatIsShiftedTooFarIsOfferedTheMiddle) {
  config.object.pose = {};
  config.design.film.width_mm = config.design.film.height_mm = 150;  // 65 mm free from the middle
  config.design.trajectory.path = {{.shift_x_mm = 500}, {.lower_mm = 10, .shift_x_mm = 500}};
  EXPECT_EQ(
      misfit(config, posed().mesh()),
      "Shifted by 500 mm (x) it reaches beyond the free film inside the taped rim, which ends "
      "65 mm from its middle.");
  EXPECT_EQ(mend_of("path")["patch"], Json::parse(R"({"path": null, "dip": {"depth_mm": 10.0}})"));
  EXPECT_TRUE(mend_of("object").is_null());
  config.design.trajectory.path = {};
  EXPECT_EQ(misfit(config, posed().mesh()), "");
  // One that is too large besides is that.
  config.design.film.width_mm = 20;
  config.design.trajectory.path = {{.shift_y_mm = 500}, {.lower_mm = 10, .shift_y_mm = 500}};
  EXPECT_TRUE(misfit(config, posed().mesh()).starts_with("Too large: "));
}

// A sheet that is offered is the smallest that has the room and lies flat in the bath.
TEST_F(Misfit, TheSheetThatIsOfferedIsTheSmallestThatFits) {
  config.object.pose = {};
  const Json mend = mend_of("film");
  ASSERT_FALSE(mend.is_null());
  const double width = mend["patch"]["film"]["width_mm"],
               height = mend["patch"]["film"]["height_mm"];
  for (const FilmFormat& format : film_formats())
    for (const bool lying : {false, true}) {
      JobConfig other = config;
      other.design.film.width_mm = lying ? format.height_mm : format.width_mm;
      other.design.film.height_mm = lying ? format.width_mm : format.height_mm;
      if (!misfit(other, posed().mesh()).empty() || !sheet_fits_bath(other.design.film, other.bath))
        continue;
      EXPECT_LE(width * height, format.width_mm * format.height_mm + 1e-9) << format.name;
    }
  config.design.film.width_mm = width;
  config.design.film.height_mm = height;
  EXPECT_EQ(misfit(config, posed().mesh()), "");
  config.bath.width_mm = config.bath.height_mm = 100;  // for none of them
  EXPECT_TRUE(mend_of("film").is_null());
}

TEST_F(Misfit, NoDepthIsOfferedAtWhichItDoesNotFit) {
  config.object.pose = {};
  config.design.film.width_mm = config.design.film.height_mm = 200;
  config.bath.depth_mm = 10.7;
  const Json mend = mend_of("dip");
  ASSERT_FALSE(mend.is_null());
  EXPECT_EQ(mend["patch"]["dip"]["depth_mm"], 10);
  JobConfig mended = config;
  mended.design.trajectory.depth_mm = 10;
  EXPECT_EQ(misfit(mended, posed().mesh()), "");
  // Turned over, its base is as wide at any depth.
  config.object.pose.rotate_deg = {180, 0, 0};
  config.design.film.width_mm = config.design.film.height_mm = 50;
  EXPECT_TRUE(mend_of("dip").is_null());
}

// A way that turns cannot be told as one straight down.
TEST_F(Misfit, WhatTurnsOnItsWayIsNotOfferedTheMiddle) {
  config.object.pose = {};
  config.design.film.width_mm = config.design.film.height_mm = 150;
  config.design.trajectory.path = {{.shift_x_mm = 500},
                                   {.lower_mm = 10, .shift_x_mm = 500, .turn_x_deg = 5}};
  EXPECT_TRUE(mend_of("path").is_null());
  EXPECT_TRUE(misfit(config, posed().mesh()).starts_with("Too large: "));
}

// Film of six triangles in a row, each torn at its own depth.
TEST(TearMends, TheDepthThatIsOfferedIsALittleBeforeMuchIsTorn) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const auto dipped = [](const std::vector<double>& torn_at_mm, double depth_mm) {
    auto mesh = std::make_shared<FilmMesh>();
    DippedFilm film;
    for (std::size_t t = 0; t < torn_at_mm.size(); ++t) {
      const auto v = std::int32_t(3 * t);
      // The first is a thread.
      const double wide = t == 0 ? 1e-3 : 1;
      mesh->u.insert(mesh->u.end(), {{2.0 * t, 0}, {2 * t + wide, 0}, {2.0 * t, 1}});
      mesh->triangles.push_back({v, v + 1, v + 2});
      film.state.insert(film.state.end(), 3, VertexState::kAttached);
      film.position.insert(film.position.end(), 3, Vec3::Zero());
    }
    film.shared_mesh = mesh;
    film.torn_at_mm = torn_at_mm;
    film.torn.assign(torn_at_mm.size(), 0);
    film.depth_mm = depth_mm;
    return film;
  };
  JobConfig config;
  const auto offered = [&](const DippedFilm& film) {
    for (const Json& mend : tear_mends(config, film))
      if (mend["patch"].contains("dip")) return mend["patch"]["dip"]["depth_mm"].get<double>();
    return 0.0;
  };
  const DippedFilm film = dipped({3, 12.3, kNever, 15, kNever, kNever}, 20);
  EXPECT_EQ(offered(film), 11.5);
  EXPECT_EQ(offered(dipped({3, kNever, kNever}, 20)), 0);  // a thread is none
  EXPECT_EQ(offered(dipped({3, 1.2, kNever}, 20)), 0);     // not worth it
  // How much film floats beside the object does not matter.
  DippedFilm wide = film;
  auto mesh = std::make_shared<FilmMesh>(film.mesh());
  mesh->u.insert(mesh->u.end(), {{100, 0}, {200, 0}, {100, 100}});
  mesh->triangles.push_back({18, 19, 20});
  wide.shared_mesh = mesh;
  wide.state.insert(wide.state.end(), 3, VertexState::kUnattached);
  wide.position.insert(wide.position.end(), 3, Vec3::Zero());
  wide.torn_at_mm.push_back(kNever);
  wide.torn.push_back(0);
  EXPECT_EQ(offered(wide), 11.5);
  config.design.trajectory.tilt_deg = 10;  // a tilted dip's depth is another's
  EXPECT_EQ(offered(film), 0);
  config.design.trajectory = {.path = {{}, {.lower_mm = 20}}};
  EXPECT_EQ(offered(film), 0);
}

TEST(AirMends, TheLargestPocketsTiltIsOffered) {
  TrappedAir air;
  EXPECT_TRUE(air_mends(air).empty());
  air.pockets.resize(2);
  air.pockets[1].lets_out = Tilt{40, 90};
  EXPECT_TRUE(air_mends(air).empty());
  air.pockets[0].lets_out = Tilt{12, 270};
  ASSERT_EQ(air_mends(air).size(), 1U);
  EXPECT_EQ(air_mends(air)[0]["patch"],
            Json::parse(R"({"dip": {"tilt_deg": 12.0, "tilt_toward_deg": 270.0}})"));
}

}  // namespace
}  // namespace hydrodip
