#include "settings/profiles.h"

#include <gtest/gtest.h>

#include "base/file.h"
#include "contains.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

ProfileEdit sets(const std::vector<std::string>& texts) {
  ProfileEdit edit;
  for (const std::string& text : texts) edit.add.sets.push_back(parse_set(text));
  return edit;
}

JobConfig with_profile(const std::filesystem::path& file) {
  JobConfig config;
  SettingSources sources;
  sources.profiles = {file};
  apply_sources(config, sources);
  return config;
}

TEST(Profiles, AreReadBackAsTheyWereSaved) {
  const TemporaryFolder folder;
  const auto file = folder / "shop.toml";
  write_file(file, edited_profile({}, sets({"film.margin_mm=12.5", "cost.currency=A \"B\" \\ €",
                                            "ink.compensation=off", "object.base_color=#102030",
                                            "dip.pivot_mm=1,-2,0.1"})));
  const JobConfig config = with_profile(file);
  EXPECT_EQ(config.design.film.margin_mm, 12.5);
  EXPECT_EQ(config.cost.currency, "A \"B\" \\ €");
  EXPECT_EQ(config.design.trajectory.pivot_mm, Vec3(1, -2, 0.1));
  EXPECT_EQ(names_in_profile(file).size(), 5U);
}

TEST(Profiles, ChangeOneValueAndKeepTheOthers) {
  const TemporaryFolder folder;
  const auto file = folder / "shop.toml";
  write_file(file, edited_profile({}, sets({"film.margin_mm=12", "cost.ink_per_ml=0.5"})));
  write_file(file, edited_profile(file, sets({"film.margin_mm=7"})));
  EXPECT_EQ(with_profile(file).design.film.margin_mm, 7);
  EXPECT_EQ(with_profile(file).cost.ink_per_ml, 0.5);
  ProfileEdit forget;
  forget.remove = {"film.margin_mm"};
  write_file(file, edited_profile(file, forget));
  EXPECT_EQ(with_profile(file).design.film.margin_mm, JobConfig().design.film.margin_mm);
  EXPECT_EQ(with_profile(file).cost.ink_per_ml, 0.5);
}

// A value that happens to be the default is set all the same: defaults of a later version differ.
TEST(Profiles, KeepValuesThatAreDefaultsToday) {
  const TemporaryFolder folder;
  const auto file = folder / "shop.toml";
  write_file(file, edited_profile({}, sets({"film.margin_mm=10"})));
  EXPECT_EQ(names_in_profile(file), std::vector<std::string>{"film.margin_mm"});
}

TEST(Profiles, AreFoundByNameAndByFile) {
  const TemporaryFolder folder;
  write_file(folder / "shop.toml", std::string("[film]\nmargin_mm = 3\n"));
  EXPECT_EQ(find_profile("shop", folder.path()), folder / "shop.toml");
  EXPECT_EQ(find_profile("./shop", folder.path()), "./shop");
  EXPECT_EQ(find_profile("shop.toml", folder.path()), "shop.toml");
  EXPECT_TRUE(contains(refusal([&] { find_profile("shpo", folder.path()); }), "shop"));
  EXPECT_EQ(profile_names(folder.path()), std::vector<std::string>{"shop"});
  EXPECT_TRUE(profile_names(folder / "nowhere").empty());
}

TEST(Profiles, HoldNothingOfASingleJob) {
  const TemporaryFolder folder;
  const auto file = folder / "job.toml";
  for (const char* text : {"[object]\nfile = \"a.obj\"\n", "[[artwork]]\nimage = \"a.png\"\n",
                           "[[dip]]\ndepth_mm = 3\n", "path = [[0, 0, 0, 0, 0, 0]]\n"}) {
    write_file(file, std::string(text));
    EXPECT_TRUE(contains(refusal([&] { edited_profile(file, {}); }), "belongs to one job")) << text;
  }
  EXPECT_NE(refusal([&] { edited_profile({}, sets({"film.margin_mm=-1"})); }), "");
  EXPECT_NE(refusal([&] { edited_profile({}, sets({"film.marginmm=1"})); }), "");
}

TEST(Profiles, StayInTheirFolder) {
  for (const char* name : {"", "../up", "a/b", ".hidden", "a b", "/etc/passwd", "x\n"})
    EXPECT_NE(refusal([&] { profile_path("folder", name); }), "") << name;
  EXPECT_EQ(profile_path("folder", "my-shop_2.a"),
            std::filesystem::path("folder/my-shop_2.a.toml"));
}

// A profile is used from anywhere: what it names is named in full.
TEST(Profiles, NameFilesInFull) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "inks");
  write_file(folder / "inks" / "p.icc", std::string("x"));
  write_file(folder / "a.toml", std::string("[ink]\nprofile = \"inks/p.icc\"\n"));
  std::filesystem::create_directories(folder / "elsewhere");
  const auto copy = folder / "elsewhere" / "b.toml";
  write_file(copy, edited_profile(folder / "a.toml", {}));
  EXPECT_TRUE(
      std::filesystem::equivalent(with_profile(copy).printer.profile, folder / "inks" / "p.icc"));
}

}  // namespace
}  // namespace hydrodip
