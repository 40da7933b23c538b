#include "job/profile_jobs.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "full_disk.h"
#include "settings/profiles.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

// Locks are between descriptors, so that threads stand for processes.
TEST(ProfileJobsTest, WhatSeveralSaveAtOnceIsKeptOfAll) {
  const TemporaryFolder folder;
  const std::vector<std::string> names = {"film.margin_mm", "print.scale_x",     "print.scale_y",
                                          "print.bleed_mm", "print.skew_deg",    "dip.step_mm",
                                          "film.elements",  "material.z_stretch"};
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    const std::string profile = "shop-" + std::to_string(round);
    std::vector<std::thread> people;
    for (const std::string& name : names)
      people.emplace_back([&, name] {
        ProfileEdit edit;
        const std::string value = name == "film.elements" ? "9000" : "1";
        edit.add.sets = {{name, value, false, "'" + value + "'", "--set"}};
        save_profile(folder / "profiles", profile, edit);
      });
    for (std::thread& person : people) person.join();
    EXPECT_EQ(names_in_profile(folder / "profiles" / (profile + ".toml")).size(), names.size());
  }
}

TEST(ProfileJobsTest, AFullDiskLeavesNoFolder) {
  const TemporaryFolder folder;
  ProfileEdit edit;
  edit.add.sets = {{"film.margin_mm", std::string("1"), false, "'1'", "--set"}};
  {
    const FullDisk full(0);
    EXPECT_THROW(save_profile(folder / "config" / "profiles", "shop", edit), InputError);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace hydrodip
