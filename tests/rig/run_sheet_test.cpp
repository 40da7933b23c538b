// The run sheet as another program reads it.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "rig/rig.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 512> buffer;
  while (pipe && std::fgets(buffer.data(), buffer.size(), pipe)) text += buffer.data();
  if (pipe) ::pclose(pipe);
  return text;
}

class RunSheetTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              ("run_sheet_" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    // A pyramid, point down.
    std::ofstream(folder_ / "model.obj")
        << "v -40 -30 25\nv 40 -30 25\nv 40 30 25\nv -40 30 25\nv 0 0 0\n"
           "f 1 2 3\nf 1 3 4\nf 2 1 5\nf 3 2 5\nf 4 3 5\nf 1 4 5\n";
    const auto input = read_file(folder_ / "model.obj");
    const nlohmann::json report = {
        {"title", "pyramid"},
        {"inputs",
         {{{"role", "model"},
           {"path", (folder_ / "model.obj").string()},
           {"sha256", sha256_hex(input)}}}},
        {"parameters",
         {{"process.soak_min_s", {{"value", 63}}},
          {"process.soak_max_s", {{"value", 77}}},
          {"process.speed_mm_per_min", {{"value", 90}}},
          {"film.width_mm", {{"value", 215.9}}},
          {"film.height_mm", {{"value", 279.4}}}}},
        {"figures", {{"depth_mm", 24.25}, {"object_size_mm", {80, 60, 25}}}}};
    write_file(folder_ / "report.json", report.dump());
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string read_back(const std::string& tool) const {
    return output_of(tool + " '" + (folder_ / "run-sheet.pdf").string() + "'" +
                     (tool == "pdfinfo" ? "" : " -"));
  }

  fs::path folder_;
  RunContext context_;
};

TEST_F(RunSheetTest, SaysTheJobsFigures) {
  rig_sheet(load_rig_job(folder_, {}), "", "", context_);
  const std::string text = read_back("pdftotext -layout");
  for (const char* figure :
       {"pyramid", "63 to 77 s", "90 mm/min", "24.25 mm", "3.50 ± 0.50 g", "27 to 30 °C", "15.0 l",
        "80.0 mm wide", "16.2 s", "ink side up", "3 mm all around", "Gun before, g", "Notes"})
    EXPECT_NE(text.find(figure), std::string::npos) << figure << "\n" << text;
}

TEST_F(RunSheetTest, WhatIsNothingIsNotAskedFor) {
  nlohmann::json report = nlohmann::json::parse(read_file(folder_ / "report.json"));
  auto& parameters = report["parameters"];
  parameters["process.activator_g"] = {{"value", 0}};
  parameters["process.soak_max_s"] = {{"value", 63}};
  parameters["process.dry_min_h"] = parameters["process.dry_max_h"] = {{"value", 0}};
  write_file(folder_ / "report.json", report.dump());
  rig_sheet(load_rig_job(folder_, {}), "", "", context_);
  std::string text = read_back("pdftotext -layout");
  for (const char* no : {"Spray", "Gun", "63 to 63", "0 to 0", "0.00 g"})
    EXPECT_EQ(text.find(no), std::string::npos) << no << "\n" << text;
  EXPECT_NE(text.find("Wait 63 s until"), std::string::npos) << text;
  // Nobody sprays less than nothing.
  parameters["process.activator_g"] = {{"value", 0.3}};
  write_file(folder_ / "report.json", report.dump());
  rig_sheet(load_rig_job(folder_, {}), "", "", context_);
  text = read_back("pdftotext -layout");
  EXPECT_NE(text.find("Spray 0.30 g of activator, 0.00 to 0.80 g"), std::string::npos) << text;
}

// What is to be measured and taped is what the sheet has.
TEST_F(RunSheetTest, TheRulerAndTheTapeAreTheSheetsOwn) {
  nlohmann::json report = nlohmann::json::parse(read_file(folder_ / "report.json"));
  rig_sheet(load_rig_job(folder_, {}), "", "", context_);
  EXPECT_NE(read_back("pdftotext -layout").find("the 100 mm ruler"), std::string::npos);
  report["parameters"]["film.width_mm"] = {{"value", 120}};
  write_file(folder_ / "report.json", report.dump());
  rig_sheet(load_rig_job(folder_, {}), "", "", context_);
  EXPECT_NE(read_back("pdftotext -layout").find("the 90 mm ruler"), std::string::npos);
  report["parameters"]["film.margin_mm"] = {{"value", 0}};
  write_file(folder_ / "report.json", report.dump());
  rig_sheet(load_rig_job(folder_, {}), "", "", context_);
  const std::string text = read_back("pdftotext -layout");
  for (const char* no : {"mm ruler", "Ruler, mm", "Tape 0", " 0 mm all around", "0 mm of tape"})
    EXPECT_EQ(text.find(no), std::string::npos) << no << "\n" << text;
}

// Whatever their script is; those that no font has are told of.
TEST_F(RunSheetTest, NamesStandAsTheyAreWritten) {
  RigJob job = load_rig_job(folder_, {});
  job.title = "\u041c\u0430\u0441\u043a\u0430 \u0142\u00f3d\u017a";
  job.batch = "Größe M?";
  job.label = "\u03a9 3";
  EXPECT_EQ(rig_sheet(job, "", "", context_).text.find("warning"), std::string::npos);
  const std::string text = read_back("pdftotext -enc UTF-8 -raw");
  for (const std::string& name : {job.title, job.batch, job.label})
    EXPECT_NE(text.find(name), std::string::npos) << name << " not in:\n" << text;
  job.batch = "\xf4\x8f\xbf\xbd";
  const std::string told = rig_sheet(job, "", "", context_).text;
  EXPECT_NE(told.find("of the batch, which stands as '?' in run-sheet.pdf"), std::string::npos)
      << told;
}

// A name longer than the page ends in dots, between letters.
TEST_F(RunSheetTest, LongNamesAreCutBetweenLetters) {
  RigJob job = load_rig_job(folder_, {});
  job.title.clear();
  for (int i = 0; i < 2000; ++i) job.title += "\u043c";
  EXPECT_EQ(rig_sheet(job, "", "", context_).text.find("warning"), std::string::npos);
  EXPECT_NE(read_back("pdftotext -enc UTF-8 -raw").find("\u043c\u043c..."), std::string::npos);
}

// Printed with paths as they are typed in the folder above the job's; seen from anywhere.
TEST_F(RunSheetTest, FindsTheModelFromAnotherFolder) {
  const fs::path job = folder_ / "job";
  fs::create_directories(job);
  fs::create_directories(folder_ / "models");
  fs::copy_file(folder_ / "model.obj", folder_ / "models" / "pyramid.obj");
  nlohmann::json report = nlohmann::json::parse(read_file(folder_ / "report.json"));
  report["inputs"][0]["path"] = "models/pyramid.obj";
  write_file(job / "report.json", report.dump());
  const RigJob found = load_rig_job(job, {});
  EXPECT_NO_THROW(require_model(found));
  EXPECT_TRUE(fs::equivalent(found.config.model, folder_ / "models" / "pyramid.obj"));
  // Another model of that name, nearer by, is not the one.
  fs::create_directories(job / "models");
  write_file(job / "models" / "pyramid.obj", std::string("another"));
  EXPECT_TRUE(
      fs::equivalent(load_rig_job(job, {}).config.model, folder_ / "models" / "pyramid.obj"));
  fs::remove_all(job / "models");
  fs::remove_all(folder_ / "models");
  try {
    require_model(load_rig_job(job, {}));
    FAIL() << "there is no model";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("models/pyramid.obj: the model that the job in"),
              std::string::npos)
        << error.what();
  }
}

// A rolled dip: by hand along the rows, never by a stage that only lowers.
TEST_F(RunSheetTest, AWayThatTurnsStandsOnItRowByRow) {
  nlohmann::json report = nlohmann::json::parse(read_file(folder_ / "report.json"));
  for (int row = 0; row <= 4; ++row)
    report["way_in"].push_back({{"travelled_mm", 9.0 * row},
                                {"lower_mm", 5.0 * row},
                                {"shift_x_mm", 0},
                                {"shift_y_mm", -1.5 * row},
                                {"turn_x_deg", 12.5 * row},
                                {"turn_y_deg", 0},
                                {"turn_z_deg", 0}});
  write_file(folder_ / "report.json", report.dump());
  const RigJob job = load_rig_job(folder_, {});
  rig_sheet(job, "", "", context_);
  const std::string text = read_back("pdftotext -layout");
  // 36 mm at 90 mm/min.
  for (const char* words : {"Way in", "24.0", "20.0", "-6.0", "50.0", "Along the way in"})
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
  EXPECT_NE(read_back("pdfinfo").find("Pages:           2"), std::string::npos);
  EXPECT_THROW(require_lowering_only(job), InputError);
  // Held at a slant and lowered straight: a stage can.
  for (auto& point : report["way_in"]) {
    point["shift_y_mm"] = 3;
    point["turn_x_deg"] = 20;
  }
  write_file(folder_ / "report.json", report.dump());
  EXPECT_NO_THROW(require_lowering_only(load_rig_job(folder_, {})));
  report["way_in"][2].erase("lower_mm");
  write_file(folder_ / "report.json", report.dump());
  EXPECT_THROW(load_rig_job(folder_, {}), InputError);
}

TEST_F(RunSheetTest, FitsBothPapersOnTwoPages) {
  for (const auto& [paper, size] : {std::pair("a4", "595.2"), std::pair("letter", "612 x 792")}) {
    rig_sheet(load_rig_job(folder_, {}), paper, "", context_);
    const std::string info = read_back("pdfinfo");
    EXPECT_NE(info.find(size), std::string::npos) << info;
    EXPECT_NE(info.find("Pages:           2"), std::string::npos) << info;
  }
  EXPECT_THROW(rig_sheet(load_rig_job(folder_, {}), "a5", "", context_), InputError);
}

TEST_F(RunSheetTest, TheSameJobGivesTheSameBytes) {
  rig_sheet(load_rig_job(folder_, {}), "", folder_ / "a.pdf", context_);
  rig_sheet(load_rig_job(folder_, {}), "", folder_ / "b.pdf", context_);
  EXPECT_EQ(read_file(folder_ / "a.pdf"), read_file(folder_ / "b.pdf"));
}

TEST_F(RunSheetTest, WithoutModelAndPreviewItSaysWhatIsMissing) {
  fs::remove(folder_ / "model.obj");
  EXPECT_THROW(rig_sheet(load_rig_job(folder_, {}), "", "", context_), InputError);
  EXPECT_FALSE(fs::exists(folder_ / "run-sheet.pdf"));
}

}  // namespace
}  // namespace hydrodip
