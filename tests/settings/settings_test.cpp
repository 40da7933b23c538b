#include "settings/settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/error.h"
#include "contains.h"
#include "refusal.h"
#include "settings/path_file.h"

namespace hydrodip {
namespace {

class Settings : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("settings_") + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file(const std::string& text, const std::string& name = "job.toml") {
    auto path = folder_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

  JobConfig from_toml(const std::string& text) {
    JobConfig config;
    apply_settings(config, read_settings(file(text)));
    return config;
  }

  std::string toml_error(const std::string& text) {
    try {
      from_toml(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  static std::string set_error(const std::string& text) {
    JobConfig config;
    try {
      apply_settings(config, {parse_set(text)});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
};

TEST_F(Settings, TablesAndDottedKeysMeanTheSame) {
  const JobConfig nested =
      from_toml("[film]\nwidth_mm = 200\nelements = 5000\n[dip]\nscheme = 'paper'\n");
  const JobConfig dotted =
      from_toml("film.width_mm = 200.0\nfilm.elements = 5000\ndip.scheme = 'paper'\n");
  for (const JobConfig& config : {nested, dotted}) {
    EXPECT_EQ(config.design.film.width_mm, 200);
    EXPECT_EQ(config.design.film.elements, 5000);
    EXPECT_EQ(config.design.dip.scheme, DipScheme::kPaper);
    EXPECT_EQ(config.design.film.height_mm, FilmOptions{}.height_mm);
  }
}

TEST_F(Settings, EveryParameterRoundTripsItsDefault) {
  for (const Parameter& p : parameters()) {
    const ParameterValue value = p.default_value();
    Setting setting{p.name, std::string(), true, "", "test"};
    if (const double* number = std::get_if<double>(&value)) setting.value = *number;
    if (const auto* text = std::get_if<std::string>(&value)) setting.value = *text;
    if (const auto* v = std::get_if<std::array<double, 3>>(&value))
      setting.value = std::vector<double>(v->begin(), v->end());
    JobConfig config;
    ASSERT_NO_THROW(apply_settings(config, {setting})) << p.name;
    EXPECT_EQ(p.get(config), value) << p.name;
    EXPECT_FALSE(p.help.empty()) << p.name;
  }
}

TEST_F(Settings, TheContractsNamesAndDefaultsExist) {
  const auto number = [](const char* name) {
    return std::get<double>(find_parameter(name, "test").default_value());
  };
  EXPECT_EQ(number("film.elements"), 40000);
  EXPECT_EQ(number("film.margin_mm"), 10);
  EXPECT_EQ(number("dip.step_mm"), 0.1);
  EXPECT_EQ(number("dip.depth_mm"), 0);
  EXPECT_EQ(number("material.z_stretch"), 0.65);
  EXPECT_EQ(number("material.poisson"), 0);
  EXPECT_EQ(number("material.ink_stiffness_ratio"), 600);
  EXPECT_EQ(number("print.dpi"), 300);
  EXPECT_EQ(number("print.bleed_mm"), 1);
  for (const char* name : {"film.width_mm", "film.height_mm", "film.shape", "dip.scheme",
                           "material.tear_stretch", "ink.rounds_max"})
    EXPECT_NO_THROW(find_parameter(name, "test")) << name;
}

TEST_F(Settings, QualityGivesWayToEverythingElse) {
  SettingSources sources;
  sources.quality = quality_settings("draft");
  JobConfig draft;
  apply_sources(draft, sources);
  EXPECT_EQ(draft.design.film.elements, 10000);
  EXPECT_FALSE(draft.pictures);
  sources.sets = {parse_set("film.elements=2000")};
  JobConfig own;
  apply_sources(own, sources);
  EXPECT_EQ(own.design.film.elements, 2000);
  EXPECT_EQ(own.design.dip.step_mm, draft.design.dip.step_mm);
  EXPECT_TRUE(quality_settings("normal").empty());
  EXPECT_THROW(quality_settings("finer"), InputError);
}

TEST_F(Settings, UnknownNamesSayTheNearestOneAndWhereTheyStand) {
  EXPECT_EQ(set_error("film.elemnts=5"),
            "--set: unknown parameter 'film.elemnts'; did you mean 'film.elements'?");
  const std::string message = toml_error("\n[film]\nelemnts = 5\n");
  EXPECT_TRUE(contains(message, "job.toml:3: unknown parameter 'film.elemnts'")) << message;
  EXPECT_TRUE(contains(toml_error("[[film]]\nwidth_mm = 3\n"), "unknown parameter 'film'"));
}

TEST_F(Settings, UnknownNamesWithoutGroupOrUnitFindTheirs) {
  for (const auto& [given, meant] : {std::pair("depth", "dip.depth_mm"),
                                     {"tilt", "dip.tilt_deg"},
                                     {"margin", "film.margin_mm"},
                                     {"dip.margin", "film.margin_mm"},
                                     {"print.resolution", "print.dpi"}})
    EXPECT_TRUE(
        contains(set_error(std::string(given) + "=5"), std::string("did you mean '") + meant + "'"))
        << set_error(std::string(given) + "=5");
  EXPECT_TRUE(contains(toml_error("[[artwork]]\nart_size = 5\n"), "did you mean 'size_mm'"));
  EXPECT_TRUE(contains(toml_error("[[artworks]]\nimage = 'a.png'\n"), "did you mean 'artwork'"));
  EXPECT_TRUE(contains(toml_error("[artwork]\nimage = 'a.png'\n"), "[[artwork]]"));
}

TEST_F(Settings, UnknownGroupsAreRefusedEvenIfEmpty) {
  EXPECT_EQ(toml_error("\n[objekt]\n"),
            (folder_ / "job.toml").string() + ":2: unknown group 'objekt'; did you mean 'object'?");
  EXPECT_TRUE(contains(toml_error("[film.foo]\n"), "unknown group 'film.foo'"));
  for (const char* known : {"[film]\n", "[dips]\n", "[dip]\n", "[object]\n[run]\n"})
    EXPECT_EQ(toml_error(known), "accepted") << known;
}

TEST_F(Settings, TablesAreNumbered) {
  for (const char* name :
       {"artwork[1x].image", "artwork[ 1].text", "artwork[0].text", "artwork[1]y].text",
        "part[1]y].job", "part[2x].job", "part[-1].job", "dip[1x].down", "dip[0].down"}) {
    EXPECT_TRUE(contains(set_error(std::string(name) + "=+z"), "unknown parameter")) << name;
  }
  EXPECT_TRUE(contains(set_error("part[1].jop=a.stl"), "a part has a job and a count"));
  EXPECT_EQ(set_error("part[1].job=a.stl"), "accepted");
  EXPECT_EQ(set_error("artwork[1].text=a"), "accepted");
  EXPECT_EQ(set_error("dip[1].down=+z"), "accepted");
}

// "must be a number from 0 to 500, not '12'" tells nobody what is wrong.
TEST_F(Settings, AQuotedNumberIsToldToBeText) {
  const std::string told = "which is text: leave out its quotation marks";
  EXPECT_TRUE(contains(toml_error("film.margin_mm = '12'"), told));
  EXPECT_TRUE(contains(toml_error("film.elements = '4000'"), told));
  EXPECT_TRUE(contains(toml_error("[[part]]\njob = 'a.stl'\ncount = '2'\n"), told));
  EXPECT_TRUE(contains(toml_error("[[artwork]]\nimage = 'a.png'\nopacity = '0.5'\n"), told));
  EXPECT_TRUE(contains(toml_error("[[artwork]]\nimage = 'a.png'\nsize_mm = '40'\n"), told));
  EXPECT_TRUE(contains(toml_error("[[dip]]\ndepth_mm = '5'\n"), told));
  // Of three numbers one alone is as wrong without them.
  for (const char* other : {"object.rotate_deg = '90'", "[[artwork]]\ntext = 'a'\nat_mm = '5'\n",
                            "film.margin_mm = 'wide'", "film.margin_mm = 999999.0",
                            "film.shape = '3'", "film.margin_mm = '12 mm'"})
    EXPECT_FALSE(contains(toml_error(other), told)) << other;
}

TEST_F(Settings, WhatIsOnOrOffMayBeTrueOrFalse) {
  const JobConfig config = from_toml(
      "[preview]\npictures = false\n[plan]\nsuggest = true\n[output]\nno_clobber = true\n"
      "[[artwork]]\ntext = 'a'\nthrough = true\n");
  EXPECT_FALSE(config.pictures);
  EXPECT_TRUE(config.plan.suggest);
  EXPECT_EQ(config.earlier_result, EarlierResult::kKept);
  EXPECT_TRUE(config.object.artwork.at(0).through);
  EXPECT_TRUE(contains(toml_error("[film]\nshape = true\n"), "not 'true'"));
  EXPECT_TRUE(contains(toml_error("[film]\nelements = true\n"), "not 'true'"));
  EXPECT_TRUE(contains(toml_error("[[artwork]]\ntext = true\n"), "not 'true'"));
}

TEST_F(Settings, ValuesOutOfRangeNameParameterValueAndRange) {
  EXPECT_EQ(set_error("print.dpi=5000"),
            "--set: print.dpi must be a number from 36 to 1200 dpi, not '5000'");
  const std::string message = toml_error("print.dpi = -1\n");
  EXPECT_TRUE(contains(message, "job.toml:1: print.dpi must be")) << message;
  EXPECT_TRUE(contains(message, "not '-1'")) << message;
  EXPECT_TRUE(contains(set_error("material.poisson=0.5"), "0 to 0.499"));
}

TEST_F(Settings, WhatIsNotANumberIsRefused) {
  for (const char* value : {"abc", "", "nan", "inf", "-inf", "1e999", "3mm", "0x10", "1,5", "--3"})
    EXPECT_TRUE(contains(set_error(std::string("film.width_mm=") + value), "must be a number"))
        << value;
  for (const char* value : {"nan", "inf", "true", "'210'", "[1]", "1979-05-27"})
    EXPECT_TRUE(contains(toml_error(std::string("film.width_mm = ") + value), "must be a number"))
        << value;
  EXPECT_TRUE(contains(set_error("film.elements=1000.5"), "a whole number"));
  EXPECT_TRUE(contains(set_error("film.elements=1e30"), "a whole number"));
}

TEST_F(Settings, WrongChoicesListTheRightOnes) {
  EXPECT_EQ(set_error("film.shape=oval"),
            "--set: film.shape must be one of rectangle, disc, not 'oval'");
  EXPECT_TRUE(contains(toml_error("film.shape = 3"), "one of rectangle, disc"));
  EXPECT_TRUE(contains(set_error("object.base_color=red"), "a colour such as"));
  EXPECT_TRUE(contains(set_error("object.base_color=#12345g"), "a colour such as"));
}

TEST_F(Settings, ColoursAreSrgbInTextAndLinearInside) {
  const LinearColor base = from_toml("object.base_color = '#ff8000'").object.base;
  EXPECT_EQ(base.r, 1);
  EXPECT_EQ(base.g, srgb8_to_linear(128));
  EXPECT_NEAR(base.g, std::pow((128 / 255.0 + 0.055) / 1.055, 2.4), 1e-6);  // IEC 61966-2-1
  EXPECT_EQ(base.b, 0);
  EXPECT_EQ(base.a, 1);
  JobConfig config;
  config.object.base = base;
  const Parameter& parameter = find_parameter("object.base_color", "test");
  EXPECT_EQ(parameter.get(config), ParameterValue("#ff8000"));
}

TEST_F(Settings, ZeroStandsBesideTheRangeOnlyWhereItMeansSomething) {
  EXPECT_EQ(set_error("material.tear_stretch=0"), "accepted");
  EXPECT_TRUE(contains(set_error("material.tear_stretch=0.5"), "or 0 (the film never tears)"));
  EXPECT_EQ(set_error("dip.depth_mm=0"), "accepted");
  EXPECT_NE(set_error("dip.step_mm=0"), "accepted");
}

TEST_F(Settings, AnglesComeAsTextOrArray) {
  EXPECT_EQ(from_toml("object.rotate_deg = [0, 90, -45.5]").object.pose.rotate_deg,
            Vec3(0, 90, -45.5));
  EXPECT_EQ(from_toml("object.rotate_deg = '0, 90, -45.5'").object.pose.rotate_deg,
            Vec3(0, 90, -45.5));
  for (const char* value : {"1,2", "1,2,3,4", "1,2,", ",,", "a,b,c", "1,2,nan"})
    EXPECT_TRUE(contains(set_error(std::string("object.rotate_deg=") + value), "X,Y,Z")) << value;
  EXPECT_TRUE(contains(toml_error("object.rotate_deg = [1, 'a', 3]"), "X,Y,Z"));
}

TEST_F(Settings, BrokenTomlSaysFileLineAndColumn) {
  const std::string message = toml_error("[film]\nwidth_mm = = 3\n");
  EXPECT_TRUE(contains(message, "job.toml:2:")) << message;
  EXPECT_TRUE(contains(message, "not valid TOML")) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_TRUE(contains(toml_error("film.width_mm = 1\nfilm.width_mm = 2\n"), "job.toml:2:"));
  EXPECT_TRUE(contains(toml_error(std::string("a = '\xff\xfe\x00'", 9)), "not valid TOML"));
  EXPECT_TRUE(contains(toml_error(std::string(5000, '[')), "nested more than 32 levels deep"));
  EXPECT_TRUE(contains(toml_error("a = \"\"\"\n[=]\n\"\"\"\n[=]\nb = 1\n"), "job.toml:4:1"));
}

// toml++ looks whether each of these is blank, by a table that has holes.
TEST_F(Settings, LettersOfOtherAlphabetsOutsideQuotesAreRefused) {
  for (const char* text :
       {"gr\xc3\xb6\xc3\x9f"
        "e = 1\n",
        "film.width_mm = \xc3\xa4\n", "\xef\xbb\xbd", "film.width_mm = 200 \xd2\x80\n"})
    EXPECT_TRUE(contains(toml_error(text), "not valid TOML")) << text;
}

TEST_F(Settings, DeepKeysAndTheSmallestIntegerAreRefusedInOneSentence) {
  std::string deep = "a";
  for (int i = 0; i < 9999; ++i) deep += ".a";
  EXPECT_TRUE(contains(toml_error(deep + " = 1\n"), "levels deep"));
  EXPECT_TRUE(contains(toml_error("[" + deep + "]\n"), "levels deep"));
  EXPECT_TRUE(contains(toml_error("a = " + std::string(9999, '[') + "\n"), "levels deep"));
  // Numbers with decimals and strings with dots are no keys.
  std::string many = "object.rotate_deg = [0.1";
  for (int i = 0; i < 99; ++i) many += ", 0.1";
  EXPECT_FALSE(contains(toml_error(many + "]\n"), "levels deep"));
  EXPECT_FALSE(contains(toml_error("print.job_name = \"" + deep + "\"\n"), "levels deep"));
  const std::string least = toml_error("object.rotate_deg = [-9223372036854775808, 2, 3]\n");
  EXPECT_TRUE(contains(least, "[-9223372036854775808, 2, 3]")) << least;
  EXPECT_TRUE(contains(toml_error("film.elements = -9223372036854775808\n"), "film.elements"));
}

// As Windows' editors save "Unicode".
TEST_F(Settings, TextInUtf16MeansTheSame) {
  std::string utf16 = "\xff\xfe";
  for (const char c : std::string("[film]\r\nwidth_mm = 200\r\n")) utf16 += {c, '\0'};
  EXPECT_EQ(from_toml(utf16).design.film.width_mm, 200);
}

TEST_F(Settings, NulCharactersAndEndlessNamesEndInOneWholeSentence) {
  EXPECT_TRUE(contains(toml_error("print.job_name = \"a\\u0000b\"\n"),
                       "print.job_name must be text without NUL characters"));
  EXPECT_TRUE(contains(toml_error("\"a\\u0000b\" = 1\n"), "'a?b'; 'hydrodip params' lists"));
  EXPECT_LT(toml_error(std::string(100'000, 'k') + " = 1\n").size(), 300U);
}

TEST_F(Settings, MissingFileIsRefused) {
  EXPECT_THROW(read_settings(folder_ / "nowhere.toml"), InputError);
  EXPECT_THROW(read_settings(folder_), InputError);
}

TEST_F(Settings, LaterSourcesWin) {
  SettingSources sources;
  sources.profiles = {
      file("print.dpi = 100\nprint.bleed_mm = 2\nprint.samples = 2\n"
           "film.width_mm = 111\n",
           "profile.toml")};
  sources.configs = {file("print.dpi = 200\nfilm.width_mm = 222\nprint.bleed_mm = 3\n")};
  sources.options = film_settings("a4");
  sources.sets = {parse_set("print.dpi=400")};
  JobConfig config;
  apply_sources(config, sources);
  EXPECT_EQ(config.design.inverse.samples_per_axis, 2);  // profile over default
  EXPECT_EQ(config.design.inverse.bleed_mm, 3);          // config over profile
  EXPECT_EQ(config.design.film.width_mm, 210);           // option over config
  EXPECT_EQ(config.design.dpi, 400);                     // --set over all
}

TEST_F(Settings, TablesOfALaterFileTakeThePlaceOfAnEarlierOnes) {
  SettingSources sources;
  sources.configs = {
      file("[[artwork]]\nimage = 'a.png'\nat_mm = [1, 2, 3]\n[[artwork]]\ntext = 'b'\n"
           "[[dip]]\ndown = '-z'\ndepth_mm = 20\n[[dip]]\ndown = '+z'\n"
           "[[part]]\njob = 'c.toml'\ncount = 3\n",
           "job.toml"),
      file("[[artwork]]\ntext = 'c'\n[[dip]]\ndown = '+x'\n", "later.toml"),
      file("dip.step_mm = 0.2\n", "last.toml")};
  JobConfig config;
  apply_sources(config, sources);
  ASSERT_EQ(config.object.artwork.size(), 1U);
  EXPECT_EQ(config.object.artwork[0].text, "c");
  EXPECT_TRUE(config.object.artwork[0].image.empty());
  EXPECT_FALSE(config.object.artwork[0].at_mm);
  ASSERT_EQ(config.dips.size(), 1U);
  EXPECT_FALSE(config.dips[0].depth_mm);
  ASSERT_EQ(config.parts.size(), 1U);
  EXPECT_EQ(config.parts[0].count, 3);
}

TEST_F(Settings, ThePapersSchemeHasARegularGridUnlessAskedOtherwise) {
  const auto grading = [&](const std::string& toml, const std::vector<Setting>& sets) {
    SettingSources sources;
    sources.configs = {file(toml)};
    sources.sets = sets;
    JobConfig config;
    apply_sources(config, sources);
    return config.design.film.grading;
  };
  const Setting paper = parse_set("dip.scheme=paper");
  EXPECT_EQ(grading("", {}), FilmOptions{}.grading);
  EXPECT_EQ(grading("", {paper}), 1);
  EXPECT_EQ(grading("film.grading = 4\n", {paper}), 4);
  EXPECT_EQ(grading("dip.scheme = 'paper'\n", {parse_set("film.grading=3")}), 3);
  EXPECT_EQ(grading("dip.scheme = 'paper'\n", {parse_set("dip.scheme=contact-line")}),
            FilmOptions{}.grading);
}

TEST_F(Settings, FilmDoesNotSurelyHoldWhereNoFilmDoes) {
  const auto apply = [](const std::vector<Setting>& sets) {
    SettingSources sources;
    sources.sets = sets;
    JobConfig config;
    apply_sources(config, sources);
  };
  EXPECT_NO_THROW(apply({parse_set("material.safe_stretch=1.6")}));
  EXPECT_NO_THROW(
      apply({parse_set("material.safe_stretch=1.8"), parse_set("material.lost_stretch=1.9")}));
  EXPECT_THROW(apply({parse_set("material.safe_stretch=1.7")}), InputError);
  EXPECT_THROW(apply({parse_set("material.lost_stretch=1.2")}), InputError);
}

JobConfig config_of(const std::vector<std::string>& sets) {
  SettingSources sources;
  for (const std::string& set : sets) sources.sets.push_back(parse_set(set));
  JobConfig config;
  apply_sources(config, sources);
  return config;
}

TEST_F(Settings, RangesOfTheProcessDoNotRunBackwards) {
  EXPECT_NO_THROW(config_of({"process.soak_min_s=10", "process.soak_max_s=10"}));
  for (const char* set : {"process.water_min_c=31", "process.soak_max_s=59", "process.dry_min_h=4"})
    EXPECT_THROW(config_of({set}), InputError) << set;
}

TEST_F(Settings, AProfileOfInksIsUsedOrRefused) {
  EXPECT_EQ(config_of({}).printer.model, InkModel::kDevice);
  EXPECT_EQ(config_of({"ink.profile=a.icc"}).printer.model, InkModel::kProfile);
  EXPECT_THROW(config_of({"ink.profile=a.icc", "ink.model=device"}), InputError);
}

TEST_F(Settings, MethodsHaveNames) {
  EXPECT_EQ(from_toml("").design.dip.method, DipMethod::kFull);
  EXPECT_EQ(from_toml("dip.method = 'single-step'").design.dip.method, DipMethod::kSingleStep);
  EXPECT_EQ(from_toml("dip.method = 'projection'").design.dip.method, DipMethod::kProjection);
  EXPECT_TRUE(contains(toml_error("dip.method = 'project'"), "projection"));
}

TEST_F(Settings, PathsInAFileAreRelativeToIt) {
  const JobConfig config = from_toml("object.texture = 'skin.png'\n");
  EXPECT_EQ(config.object.load.texture, folder_ / "skin.png");
  EXPECT_EQ(from_toml("object.texture = '/abs/skin.png'").object.load.texture, "/abs/skin.png");
  EXPECT_TRUE(from_toml("object.texture = ''").object.load.texture.empty());
}

// Excel's, in German and as Unicode text; quoted; by hand.
TEST_F(Settings, PathsAreReadAsSpreadsheetsSaveThem) {
  const std::string plain =
      "lower_mm,shift_x_mm,shift_y_mm,turn_x_deg,turn_y_deg,turn_z_deg\n"
      "0,0,0,0,0,0\n15,2.5,-0.5,0,1e1,0\n";
  const auto with = [&](char separator, char point, const std::string& line_end) {
    std::string text;
    for (const char c : plain)
      text += c == ','    ? std::string(1, separator)
              : c == '.'  ? std::string(1, point)
              : c == '\n' ? line_end
                          : std::string(1, c);
    return text;
  };
  const auto in_utf16 = [](const std::string& text) {
    std::string wide = "\xff\xfe";
    for (const char c : text) wide += {c, '\0'};
    return wide;
  };
  const auto expected = read_path(file(plain, "plain.csv"));
  ASSERT_EQ(expected.size(), 2U);
  EXPECT_EQ(expected[1].shift_x_mm, 2.5);
  EXPECT_EQ(expected[1].shift_y_mm, -0.5);
  for (const std::string& text :
       {with(';', ',', "\r\n"), "\xef\xbb\xbf" + with(',', '.', "\r\n"),
        in_utf16(with('\t', ',', "\r\n")), with(' ', '.', "\n"),
        "\"lower_mm\",\"shift_x_mm\"" + plain.substr(plain.find(",shift_y_mm"))}) {
    const auto saved = file(text, "saved.csv");
    EXPECT_TRUE(is_path_file(saved)) << text;
    EXPECT_EQ(rows_of(read_path(saved)), rows_of(expected)) << text;
  }
}

// A report names every file that a job was made from; of a path none but the rows is left.
TEST_F(Settings, FilesOfPathsAreRemembered) {
  const std::string header = "lower_mm,shift_x_mm,shift_y_mm,turn_x_deg,turn_y_deg,turn_z_deg\n";
  const auto way = file("# tilted\n\n" + header + "0,0,0,0,0,0\n5,0,0,0,0,0\n", "way.csv");
  const auto other = file(header + "0,0,0,0,0,0\n6,0,0,0,0,0\n", "other.csv");
  SettingSources sources;
  const auto job = file("path = 'other.csv'\n");
  sources.configs = {job};
  sources.options = {{"path", way.string(), false, "", "--path"}};
  using Files = std::vector<std::filesystem::path>;
  EXPECT_EQ(configured("model.obj", sources).settings_files, (Files{job, way}));
  EXPECT_TRUE(is_path_file(way));
  EXPECT_FALSE(is_path_file(job));
  sources.options.clear();
  EXPECT_EQ(configured("model.obj", sources).settings_files, (Files{job, other}));
  const auto dips = file("[[dip]]\ndown = '-z'\n[[dip]]\npath = 'way.csv'\n", "dips.toml");
  sources.configs = {dips};
  EXPECT_EQ(configured("model.obj", sources).settings_files, (Files{dips, way}));
  const auto rows = file("path = [[0,0,0,0,0,0], [5,0,0,0,0,0]]\n", "rows.toml");
  sources.configs = {rows};
  EXPECT_EQ(configured("model.obj", sources).settings_files, Files{rows});
}

// Each dip's depth is looked for, wherever another one is said: it would be passed over.
TEST_F(Settings, ADepthForDipsThatAreLookedForIsRefusedWhereverItIsSaid) {
  const auto told = [](const SettingSources& sources) -> std::string {
    try {
      configured("model.obj", sources);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const Setting dips{"plan.dips", 2.0, false, "2", "--dips"};
  const Setting depth{"dip.depth_mm", 5.0, false, "5", "--depth"};
  SettingSources option, job, profile;
  option.options = {dips, depth};
  EXPECT_NE(told(option).find("--depth: each of several dips"), std::string::npos) << told(option);
  job.options = {dips};
  job.configs = {file("[dip]\nstep_mm = 1\ndepth_mm = 5\n", "deep.toml")};
  EXPECT_NE(told(job).find("deep.toml:3: dip.depth_mm: each of several"), std::string::npos)
      << told(job);
  profile.options = {dips};
  profile.profiles = job.configs;
  EXPECT_NE(told(profile).find("deep.toml:3"), std::string::npos) << told(profile);
  // One dip goes as deep as is said, and so does one of a table; what is taken back counts nowhere.
  job.options.clear();
  EXPECT_EQ(told(job), "");
  job.options = {dips, {"dip.depth_mm", std::string("auto"), false, "auto", "--depth"}};
  EXPECT_EQ(told(job), "");
  job.options = {dips};
  job.configs = {file("[[dip]]\ndepth_mm = 5\n", "table.toml")};
  EXPECT_EQ(told(job), "");
}

TEST_F(Settings, WhatTablesOfDipsSayIsSaidThereOnly) {
  const auto is_refused = [&](const Setting& setting) {
    SettingSources sources;
    sources.configs = {file("[[dip]]\ndown = '-z'\n", "dips.toml")};
    sources.options = {setting};
    return !refusal([&] { configured("model.obj", sources); }).empty();
  };
  EXPECT_TRUE(is_refused({"object.rotate_deg", std::string("0,0,9"), false, "", "--rotate"}));
  EXPECT_TRUE(is_refused({"object.down", std::string("+y"), false, "", "--down"}));
  EXPECT_TRUE(is_refused({"dip.depth_mm", 9.0, false, "", "--depth"}));
  EXPECT_FALSE(is_refused({"dip.step_mm", 0.5, false, "", "--set"}));
}

TEST_F(Settings, PathsLeadSomewhereInABath) {
  const auto is_taken = [&](const std::string& rows) {
    SettingSources sources;
    sources.configs = {file("path = [" + rows + "]\n", "way.toml")};
    return refusal([&] { configured("model.obj", sources); }).empty();
  };
  EXPECT_TRUE(is_taken("[0,0,0,0,0,0], [5000,5000,-5000,3600,-3600,0]"));
  EXPECT_FALSE(is_taken("[0,0,0,0,0,0]"));
  for (const char* row : {"[5001,0,0,0,0,0]", "[5,-5001,0,0,0,0]", "[5,0,5001,0,0,0]",
                          "[5,0,0,3601,0,0]", "[5,0,0,0,-3601,0]", "[5,0,0,0,0,3601]"})
    EXPECT_FALSE(is_taken(std::string("[0,0,0,0,0,0], ") + row)) << row;
}

TEST_F(Settings, SetNeedsNameAndValue) {
  for (const char* text : {"film.width_mm", "=3", ""}) EXPECT_THROW(parse_set(text), InputError);
  EXPECT_EQ(std::get<std::string>(parse_set("print.job_name=a=b").value), "a=b");
}

std::pair<double, double> film_size(const std::string& film) {
  JobConfig config;
  apply_settings(config, film_settings(film));
  return {config.design.film.width_mm, config.design.film.height_mm};
}

TEST(Film, NamesAndSizes) {
  EXPECT_EQ(film_size("a4"), std::pair(210.0, 297.0));
  EXPECT_EQ(film_size("a4-landscape"), std::pair(297.0, 210.0));
  EXPECT_EQ(film_size("letter"), std::pair(215.9, 279.4));
  EXPECT_EQ(film_size("a3"), std::pair(297.0, 420.0));
  EXPECT_EQ(film_size("200x150.5"), std::pair(200.0, 150.5));
}

TEST(Film, WhatIsNoFilmIsRefused) {
  for (const char* film : {"", "a5", "lettre", "200", "200x", "x200", "axb", "-3x200", "1x1",
                           "200x300x400", "nanxnan", "-landscape"})
    EXPECT_THROW(film_size(film), InputError) << film;
}

TEST(Parameters, NamesAreUniqueAndGrouped) {
  std::vector<std::string> names;
  for (const Parameter& p : parameters()) {
    // A path is a table of its own.
    EXPECT_TRUE(contains(p.name, ".") || p.name == "path") << p.name;
    EXPECT_EQ(std::count(names.begin(), names.end(), p.name), 0) << p.name;
    names.push_back(p.name);
  }
}

TEST(Parameters, TheTableShowsThemAll) {
  const std::string table = parameters_table(), json = parameters_json();
  for (const Parameter& p : parameters()) {
    EXPECT_TRUE(contains(table, p.name));
    EXPECT_TRUE(contains(json, "\"" + p.name + "\""));
  }
}

}  // namespace
}  // namespace hydrodip
