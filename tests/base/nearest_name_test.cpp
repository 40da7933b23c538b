#include "base/nearest_name.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

const std::vector<std::string> kNames = {"film.elements", "film.width_mm", "dip.step_mm"};

TEST(NearestName, FindsSwappedMissingAndExtraLetters) {
  EXPECT_EQ(nearest_name("film.elemnets", kNames), "film.elements");
  EXPECT_EQ(nearest_name("film.elemnts", kNames), "film.elements");
  EXPECT_EQ(nearest_name("film.widthh_mm", kNames), "film.width_mm");
  EXPECT_EQ(nearest_name("FILM.ELEMENTS", kNames), "film.elements");
}

// In short names one mistake is forgiven, and letters that change places are one.
TEST(NearestName, ForgivesOneSwapInAShortName) {
  EXPECT_EQ(nearest_name("prnit", {"print"}), "print");
  EXPECT_EQ(nearest_name("prmmt", {"print"}), "");
}

TEST(NearestName, FindsTheLastPartAlone) {
  EXPECT_EQ(nearest_name("elements", kNames), "film.elements");
  EXPECT_EQ(nearest_name("step_mn", kNames), "dip.step_mm");
}

TEST(NearestName, UnitsAndGroupsDoNotMatter) {
  const std::vector<std::string> names = {"dip.tilt_toward_deg", "dip.tilt_deg", "film.margin_mm",
                                          "process.speed_mm_per_min", "dip.depth_mm"};
  EXPECT_EQ(nearest_name("depth", names), "dip.depth_mm");
  EXPECT_EQ(nearest_name("tilt", names), "dip.tilt_deg");
  EXPECT_EQ(nearest_name("margin", names), "film.margin_mm");
  EXPECT_EQ(nearest_name("margin_cm", names), "film.margin_mm");
  EXPECT_EQ(nearest_name("speed", names), "process.speed_mm_per_min");
  EXPECT_EQ(nearest_name("object.depth", names), "dip.depth_mm");
  EXPECT_EQ(nearest_name("art_size", {"turn_deg", "size_mm"}), "size_mm");
}

TEST(NearestName, SaysNothingWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("colour", kNames), "");
  EXPECT_EQ(nearest_name("", kNames), "");
  EXPECT_EQ(nearest_name(std::string(100000, 'x'), kNames), "");
  EXPECT_EQ(did_you_mean("zzzz", kNames), "");
}

TEST(NearestName, PutsItIntoAQuestion) {
  EXPECT_EQ(did_you_mean("film.elemnts", kNames), "; did you mean 'film.elements'?");
}

}  // namespace
}  // namespace hydrodip
