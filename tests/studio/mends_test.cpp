#include "studio/mends.h"

#include <gtest/gtest.h>

#include "samples/samples.h"

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

}  // namespace
}  // namespace hydrodip
