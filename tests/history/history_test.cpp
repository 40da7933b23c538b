#include "history/history.h"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "contains.h"
#include "full_disk.h"
#include "history/history_job.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;

struct FixedClock : Clock {
  double now_s() override { return 0; }
  bool wait_readable(int, double) override { return false; }
  std::string utc() override { return "2026-02-03T04:05:06Z"; }
};

std::string guided_log(const std::string& started, const std::string& label, const std::string& end,
                       const std::string& report_sha256 = "abc") {
  return "{\"time\":\"" + started +
         "\",\"elapsed_s\":0.0,\"event\":\"start\",\"job\":\"mask\",\"depth_mm\":12.0,"
         "\"report_sha256\":\"" +
         report_sha256 + "\",\"batch\":\"B1\",\"label\":\"" + label +
         "\"}\n"
         "{\"time\":\"t\",\"event\":\"water\",\"when\":\"before\",\"celsius\":28.5}\n"
         "{\"time\":\"t\",\"event\":\"soaked\",\"seconds\":70.0}\n"
         "{\"time\":\"t\",\"event\":\"activator\",\"used_g\":1.5}\n"
         "{\"time\":\"t\",\"event\":\"activator\",\"used_g\":3.25}\n"
         "{\"time\":\"t\",\"event\":\"water\",\"when\":\"after\",\"celsius\":27.5}\n" +
         end;
}
const std::string kDone =
    "{\"time\":\"t\",\"event\":\"end\",\"outcome\":\"done\",\"guided\":true}\n";

void write_run(const TemporaryFolder& job, const std::string& name, const std::string& log) {
  fs::create_directories(job / name);
  write_file(job / name / "log.jsonl", log);
}

TEST(History, TakesInWhatTheLogsSay) {
  const TemporaryFolder job;
  write_run(job, "rig-2", guided_log("2026-01-02T10:00:00Z", "8", kDone));
  write_run(job, "rig-1", guided_log("2026-01-01T10:00:00Z", "7", kDone));
  // Moving the stage is no dip.
  write_run(job, "rig-3", "{\"time\":\"t\",\"event\":\"start\",\"action\":\"home\"}\n" + kDone);
  const std::vector<DipRun> runs = History(job.path()).runs();
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].id, "rig-1");
  EXPECT_EQ(runs[0].label, "7");
  EXPECT_EQ(runs[0].batch, "B1");
  EXPECT_EQ(runs[0].outcome, "done");
  EXPECT_EQ(runs[0].water_before_c, 28.5);
  EXPECT_EQ(runs[0].water_after_c, 27.5);
  EXPECT_EQ(runs[0].soak_s, 70);
  EXPECT_EQ(runs[0].activator_g, 3.25);  // sprayed twice: the gun was weighed against the start
  EXPECT_EQ(runs[1].label, "8");
}

TEST(History, TakesInWhereTheFilmLayAndWhatWasNoted) {
  const TemporaryFolder job;
  write_run(job, "rig-1",
            guided_log("2026-01-01T10:00:00Z", "7",
                       "{\"time\":\"t\",\"event\":\"registered\",\"x_mm\":-0.4,\"y_mm\":1.2,"
                       "\"turn_deg\":0.25}\n"
                       "{\"time\":\"t\",\"event\":\"notes\",\"text\":\"slid a little\"}\n" +
                           kDone));
  const DipRun run = History(job.path()).runs().front();
  EXPECT_EQ(run.registration_x_mm, -0.4);
  EXPECT_EQ(run.registration_y_mm, 1.2);
  EXPECT_EQ(run.registration_deg, 0.25);
  EXPECT_EQ(run.notes, "slid a little");
  RigJob shown;
  shown.folder = job.path();
  FixedClock clock;
  EXPECT_TRUE(contains(history_job(shown, {}, clock).text, " -0.40 +1.20"));
}

// The computer went off in mid-line; and later the same run is read again.
// What breaks off before film is on the water spoils nothing; what is given up afterwards does.
TEST(History, FilmIsUsedUpFromTheMomentItLiesOnTheWater) {
  const TemporaryFolder job;
  const std::string start =
      "{\"time\":\"2026-01-01T10:00:00Z\",\"event\":\"start\",\"depth_mm\":12.0}\n";
  const std::string laid = "{\"time\":\"t\",\"event\":\"film on the water\"}\n";
  const auto end = [](const std::string& outcome) {
    return "{\"time\":\"t\",\"event\":\"end\",\"outcome\":\"" + outcome + "\"}\n";
  };
  write_run(job, "rig-1", start + end("failed"));
  write_run(job, "rig-2", start + laid + end("cancelled"));
  write_run(job, "rig-3", start + laid + end("failed"));
  const std::vector<DipRun> runs = History(job.path()).runs();
  ASSERT_EQ(runs.size(), 3U);
  const SheetUse sheet{0.06, 0.5};
  EXPECT_EQ(runs[0].outcome, "cancelled");
  EXPECT_EQ(use_of(runs[0], sheet, {}).film_m2, 0);
  EXPECT_EQ(runs[1].outcome, "cancelled");
  EXPECT_EQ(use_of(runs[1], sheet, {}).film_m2, 0.06);
  EXPECT_EQ(runs[2].outcome, "failed");
  EXPECT_EQ(use_of(runs[2], sheet, {}).film_m2, 0.06);
}

TEST(History, ForgivesABrokenLogAndReadsItAgain) {
  const TemporaryFolder job;
  write_run(job, "rig-1", guided_log("2026-01-01T10:00:00Z", "7", "{\"time\":\"t\",\"eve"));
  EXPECT_EQ(History(job.path()).runs().front().outcome, "unfinished");
  write_run(job, "rig-1", guided_log("2026-01-01T10:00:00Z", "7", kDone));
  EXPECT_EQ(History(job.path()).runs().front().outcome, "done");
}

TEST(History, WhatPeopleSaidOutlastsTheLogsAndTheirFolders) {
  const TemporaryFolder job;
  write_run(job, "rig-1", guided_log("2026-01-01T10:00:00Z", "7", kDone));
  History(job.path()).amend("rig-1", {{"outcome", "failed"}, {"registration_x_mm", "-0.4"}});
  fs::remove_all(job / "rig-1");
  const std::vector<DipRun> runs = History(job.path()).runs();
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].outcome, "failed");
  EXPECT_EQ(runs[0].registration_x_mm, -0.4);
  EXPECT_EQ(runs[0].activator_g, 3.25);
}

TEST(History, RefusesWhatNoRunHas) {
  const TemporaryFolder job;
  History history(job.path());
  const std::string id = history.add("2026-01-01T10:00:00Z", "", {{"label", "1"}});
  EXPECT_EQ(id, "hand-1");
  EXPECT_TRUE(contains(refusal([&] { history.amend("hand-2", {{"label", "2"}}); }), "hand-1"));
  EXPECT_TRUE(contains(refusal([&] { history.amend(id, {{"lable", "2"}}); }), "label"));
  EXPECT_TRUE(contains(refusal([&] { history.amend(id, {{"outcome", "fine"}}); }), "good"));
  EXPECT_TRUE(contains(refusal([&] { history.amend(id, {{"activator_g", "3,5 g"}}); }), "number"));
  EXPECT_NE(refusal([&] { history.amend(id, {{"water_before_c", "282"}}); }), "");
  history.amend(id, {{"activator_g", "3,5"}});  // as much of the world writes it
  EXPECT_EQ(history.runs().front().activator_g, 3.5);
  EXPECT_EQ(history.add("2026-01-01T10:00:00Z", "", {}), "hand-2");
}

// What was added by mistake goes; what the guide kept stays, and so do the others' names.
TEST(History, WhatWasAddedByMistakeCanBeTakenAway) {
  const TemporaryFolder job;
  write_run(job, "rig-1", guided_log("2026-01-01T10:00:00Z", "7", kDone));
  History history(job.path());
  for (const char* label : {"1", "2", "3"})
    history.add("2026-01-02T10:00:00Z", "", {{"label", label}});
  history.amend("hand-1", {{"outcome", "failed"}});
  history.remove("hand-1");
  EXPECT_EQ(history.add("2026-01-02T10:00:00Z", "", {{"label", "4"}}), "hand-4");
  std::string labels;
  for (const DipRun& run : History(job.path()).runs()) labels += run.id + "=" + run.label + " ";
  EXPECT_EQ(labels, "rig-1=7 hand-2=2 hand-3=3 hand-4=4 ");
  EXPECT_TRUE(contains(refusal([&] { history.remove("hand-1"); }), "there is no run 'hand-1'"));
  EXPECT_TRUE(contains(refusal([&] { history.remove("rig-1"); }), "log.jsonl"));
  // The number comes again, and nothing of what was said of it.
  history.amend("hand-4", {{"notes", "of another"}});
  history.remove("hand-4");
  EXPECT_EQ(history.add("2026-01-03T10:00:00Z", "", {}), "hand-4");
  EXPECT_EQ(history.runs().back().notes, "");
}

TEST(History, SaysWhatIsWrongWithItsFile) {
  const TemporaryFolder job;
  write_file(job / "history.sqlite", std::string(5000, 'x'));
  EXPECT_TRUE(contains(refusal([&] { History history(job.path()); }), "history.sqlite"));
  EXPECT_NE(refusal([&] { History history(job / "nowhere"); }), "");
}

// Files that this process has open under that name.
long open_as(const fs::path& file) {
  const fs::directory_iterator all("/proc/self/fd");
  return std::count_if(begin(all), end(all), [&](const fs::directory_entry& entry) {
    std::error_code gone;
    return fs::read_symlink(entry.path(), gone) == file;
  });
}

TEST(History, AFileOfANewerProgramStaysAsItIs) {
  const TemporaryFolder job;
  const fs::path file = fs::canonical(job.path()) / "history.sqlite";
  sqlite3* newer = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &newer), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(newer,
                         "CREATE TABLE hydrodip (schema_version INTEGER NOT NULL);"
                         "INSERT INTO hydrodip VALUES (2)",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(newer);
  const auto before = read_file(file);
  EXPECT_TRUE(contains(refusal([&] { History history(job.path()); }), "newer hydrodip"));
  EXPECT_EQ(read_file(file), before);
  EXPECT_EQ(open_as(file), 0);
}

TEST(History, KeepsTheReportThatARunWasMadeBy) {
  const TemporaryFolder job;
  const std::string report = "{\"a\": 1}";
  write_file(job / "report.json", report);
  const std::string sha = sha256_hex(report);
  EXPECT_EQ(History(job.path()).report(sha), report);
  write_file(job / "report.json", std::string("{\"a\": 2}"));
  EXPECT_EQ(History(job.path()).report(sha), report);
  EXPECT_EQ(History(job.path()).report("none"), "");
}

// A full disk, a medium that cannot be written to: what is there can be looked at, new runs too.
TEST(History, LookingNeedsNoRoomAndNoPermission) {
  const TemporaryFolder job;
  write_file(job / "report.json", std::string("{}"));
  History(job.path()).add("2026-01-01T10:00:00Z", "", {{"notes", "by hand"}});
  write_run(job, "rig-1", guided_log("2026-01-02T10:00:00Z", "7", kDone));
  const auto before = read_file(job / "history.sqlite");
  write_file(job / "report.json", std::string("{\"new\": 1}"));
  const auto expect_shown = [&] {
    const std::vector<DipRun> runs = History(job.path(), true).runs();
    ASSERT_EQ(runs.size(), 2U);
    EXPECT_EQ(runs[0].notes, "by hand");
    EXPECT_EQ(runs[1].label, "7");
    EXPECT_NE(refusal([&] { History(job.path()).amend("hand-1", {{"notes", "none"}}); }), "");
  };
  {
    const FullDisk full(0);
    expect_shown();
  }
  EXPECT_EQ(read_file(job / "history.sqlite"), before);
  fs::permissions(job / "history.sqlite", fs::perms::owner_read);
  // Nothing is kept from root.
  if (::access((job / "history.sqlite").c_str(), W_OK) != 0) expect_shown();
  EXPECT_EQ(read_file(job / "history.sqlite"), before);
}

TEST(History, AFullDiskKeepsNoFileInWhichNothingIs) {
  const std::string report = "{\"a\": \"" + std::string(100000, 'x') + "\"}";
  for (const rlim_t most_bytes : {0, 5000, 30000, 60000, 120000}) {
    const TemporaryFolder job;
    write_file(job / "report.json", report);
    const auto entries = [&] {
      return std::distance(fs::directory_iterator(job.path()), fs::directory_iterator());
    };
    {
      const FullDisk full(most_bytes);
      const std::string said = refusal([&] { History(job.path()).add("", "", {}); });
      EXPECT_TRUE(contains(said, "free space")) << said;
    }
    EXPECT_EQ(entries(), 1) << most_bytes;
    EXPECT_EQ(History(job.path()).add("", "", {}), "hand-1");
  }
}

RigJob priced_job() {
  RigJob job;
  job.sheet = {0.06, 0.5};
  job.config.cost.film_per_m2 = 20;    // 1.2 a sheet
  job.config.cost.ink_ml_per_m2 = 10;  // 0.3 ml
  job.config.cost.ink_per_ml = 0.5;    // 0.15
  job.config.cost.activator_per_g = 0.1;
  job.config.cost.per_piece = 2;
  return job;
}

TEST(Cost, IsWhatFilmInkActivatorAndPieceCost) {
  DipRun run;
  run.outcome = "good";
  run.activator_g = 3;
  const RigJob job = priced_job();
  const DipUse use = use_of(run, job.sheet, job.config.cost);
  EXPECT_NEAR(use.film_m2, 0.06, 1e-12);
  EXPECT_NEAR(*use.ink_ml, 0.3, 1e-12);
  EXPECT_NEAR(use.cost, 1.2 + 0.15 + 0.3 + 2, 1e-12);
}

// Given up before the film was on the water: nothing was used.
TEST(Cost, OfARunThatNeverBeganIsNothing) {
  DipRun run;
  run.outcome = "cancelled";
  const RigJob job = priced_job();
  EXPECT_EQ(use_of(run, job.sheet, job.config.cost).cost, 0);
  run.soak_s = 60;
  EXPECT_GT(use_of(run, job.sheet, job.config.cost).cost, 0);
}

// Of several dips each takes a sheet, and together they make one piece.
TEST(Cost, OfThePieceIsCountedWithItsFirstDip) {
  DipRun run;
  run.outcome = "good";
  RigJob job = priced_job();
  const double first = use_of(run, job.sheet, job.config.cost).cost;
  job.sheet.first_of_piece = false;
  EXPECT_NEAR(use_of(run, job.sheet, job.config.cost).cost, first - 2, 1e-12);
}

std::string report_of(double width_mm, double cyan, int dip) {
  return "{\"command\":\"print\",\"parameters\":{\"film.width_mm\":{\"value\":" +
         std::to_string(width_mm) +
         "},\"film.height_mm\":{\"value\":300}},\"ink\":{\"mean\":{\"cyan\":" +
         std::to_string(cyan) + "}},\"dip_of_several\":{\"number\":" + std::to_string(dip) +
         ",\"of\":2},\"figures\":{\"depth_mm\":9}}";
}

TEST(Cost, TakesFilmAndInkFromThePrint) {
  const auto use = sheet_use(report_of(200, 0.25, 2));
  ASSERT_TRUE(use);
  EXPECT_NEAR(use->film_m2, 0.06, 1e-12);
  EXPECT_NEAR(use->ink_coverage, 0.25, 1e-9);
  EXPECT_FALSE(use->first_of_piece);
  EXPECT_TRUE(sheet_use(report_of(200, 0.25, 1))->first_of_piece);
  EXPECT_FALSE(sheet_use("[1]"));
  EXPECT_FALSE(sheet_use(""));
}

// The job was printed anew, on a smaller sheet, after the first dip.
TEST(HistoryJob, ChargesEachDipByItsOwnPrint) {
  const TemporaryFolder folder;
  const auto print = [&](double width_mm) {
    const std::string report = report_of(width_mm, 0.5, 1);
    write_file(folder / "report.json", report);
    return sha256_hex(report);
  };
  FixedClock clock;
  write_run(folder, "rig-1", guided_log("2026-01-01T10:00:00Z", "1", kDone, print(200)));
  const auto look = [&] {
    RigJob job = load_rig_job(folder.path(), {});
    job.config.cost = priced_job().config.cost;
    return history_job(job, {}, clock);
  };
  const double alone = nlohmann::json::parse(look().json)["totals"]["cost"];
  EXPECT_NEAR(alone, 1.2 + 0.15 + 0.325 + 2, 1e-9);
  write_run(folder, "rig-2", guided_log("2026-01-02T10:00:00Z", "2", kDone, print(100)));
  const auto json = nlohmann::json::parse(look().json);
  EXPECT_NEAR(json["runs"][0]["cost"], alone, 1e-9);
  EXPECT_NEAR(json["runs"][1]["cost"], 0.6 + 0.075 + 0.325 + 2, 1e-9);
  EXPECT_NEAR(json["totals"]["film_m2"], 0.09, 1e-9);
  EXPECT_EQ(json["runs"][0]["same_print"], false);
  EXPECT_EQ(json["runs"][1]["same_print"], true);
  HistoryRequest first;
  first.settings_run = "rig-1";
  EXPECT_EQ(history_job(load_rig_job(folder.path(), {}), first, clock).text,
            report_of(200, 0.5, 1));
  // Of a print that nobody looked at while it was there, no more is known than today's.
  write_run(folder, "rig-3", guided_log("2026-01-03T10:00:00Z", "3", kDone, "gone"));
  EXPECT_TRUE(contains(look().text, "today's stands for them: rig-3")) << look().text;
}

TEST(HistoryJob, SaysWhichInkIsNotInTheCost) {
  const TemporaryFolder folder;
  RigJob job = priced_job();
  job.folder = folder.path();
  job.sheet.ink_coverage = 0;
  FixedClock clock;
  HistoryRequest request;
  request.add = true;
  const JobResult result = history_job(job, request, clock);
  EXPECT_TRUE(contains(result.text, "without the ink of 1 dip"));
  EXPECT_TRUE(nlohmann::json::parse(result.json)["totals"]["ink_ml"].is_null());
  EXPECT_TRUE(contains(result.text, "ink not known")) << result.text;
}

TEST(HistoryJob, APieceThatCostsSomethingIsAPrice) {
  const TemporaryFolder folder;
  RigJob job;
  job.folder = folder.path();
  job.config.cost.per_piece = 2;
  FixedClock clock;
  HistoryRequest request;
  request.add = true;
  request.fields = {{"outcome", "good"}};
  EXPECT_TRUE(contains(history_job(job, request, clock).text, "cost: 2.00; a good piece: 2.00"));
}

TEST(HistoryJob, WhoAsksForADipsSettingsChangesNothing) {
  const TemporaryFolder folder;
  const std::string report = report_of(200, 0.5, 1);
  write_file(folder / "report.json", report);
  write_run(folder, "rig-1", guided_log("2026-01-01T10:00:00Z", "1", kDone, sha256_hex(report)));
  const RigJob job = load_rig_job(folder.path(), {});
  FixedClock clock;
  HistoryRequest asks;
  asks.settings_run = "rig-1";
  EXPECT_EQ(history_job(job, asks, clock).text, report);
  // It was printed, and what was said beside it was lost.
  HistoryRequest adds = asks, amends = asks, removes = asks, chooses = asks;
  adds.add = true;
  amends.amend_run = "rig-1";
  amends.fields = {{"outcome", "failed"}};
  removes.remove_run = "rig-1";
  chooses.batch_only = "B1";
  for (const HistoryRequest& request : {adds, amends, removes, chooses})
    EXPECT_TRUE(contains(refusal([&] { history_job(job, request, clock); }), "--settings rig-1"));
  const std::vector<DipRun> runs = History(folder.path()).runs();
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].outcome, "done");
}

TEST(HistoryJob, ALookLeavesAFolderWithoutDipsAsItIs) {
  const TemporaryFolder folder;
  RigJob job = priced_job();
  job.folder = folder.path();
  FixedClock clock;
  EXPECT_TRUE(contains(history_job(job, {}, clock).text, "nothing was dipped yet"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
  // What a log says is kept, so that a damaged one takes nothing away.
  write_run(folder, "rig-1", guided_log("2026-01-01T10:00:00Z", "1", kDone));
  history_job(job, {}, clock);
  write_run(folder, "rig-1", "");
  EXPECT_FALSE(contains(history_job(job, {}, clock).text, "nothing was dipped yet"));
}

TEST(HistoryJob, WhatIsRefusedMakesNoHistory) {
  const TemporaryFolder folder;
  write_file(folder / "report.json", std::string("{}"));
  RigJob job = priced_job();
  job.folder = folder.path();
  FixedClock clock;
  HistoryRequest bad, of_none, remove_none;
  bad.add = true;
  bad.fields = {{"outcome", "bad"}};
  of_none.amend_run = "rig-3";
  of_none.fields = {{"outcome", "good"}};
  remove_none.remove_run = "hand-1";
  for (const HistoryRequest& request : {bad, of_none, remove_none})
    EXPECT_NE(refusal([&] { history_job(job, request, clock); }), "");
  EXPECT_FALSE(fs::exists(folder / "history.sqlite"));
}

// Of no dips all is known.
TEST(HistoryJob, NoDipsUseNoInk) {
  const TemporaryFolder folder;
  RigJob job = priced_job();
  job.folder = folder.path();
  write_run(folder, "rig-1",
            "{\"time\":\"t\",\"event\":\"start\",\"depth_mm\":12.0}\n"
            "{\"time\":\"t\",\"event\":\"end\",\"outcome\":\"cancelled\",\"guided\":true}\n");
  FixedClock clock;
  const JobResult told = history_job(job, {}, clock);
  EXPECT_TRUE(contains(told.text, "0.000 m2 of film, about 0.00 ml of ink")) << told.text;
  EXPECT_EQ(nlohmann::json::parse(told.json)["totals"]["ink_ml"], 0);
}

TEST(HistoryJob, SaysWhichRunsItCannotRead) {
  const TemporaryFolder folder;
  RigJob job = priced_job();
  job.folder = folder.path();
  FixedClock clock;
  write_run(folder, "rig-1", "");
  write_run(folder, "rig-2", "{\"time\":\"t\",\"eve");
  write_run(folder, "rig-3", "{\"event\":\"start\",\"action\":\"home\"}\n");
  write_run(folder, "rig-4", guided_log("2026-01-01T10:00:00Z", "1", kDone));
  EXPECT_EQ(History(folder.path()).unread(), (std::vector<std::string>{"rig-1", "rig-2"}));
  EXPECT_TRUE(
      contains(history_job(job, {}, clock).text, "rig-2: its log.jsonl is empty or damaged"));
  // One that was taken in before is there.
  write_run(folder, "rig-4", "");
  EXPECT_EQ(History(folder.path()).unread(), (std::vector<std::string>{"rig-1", "rig-2"}));
}

TEST(HistoryJob, ABatchThatThereIsNotAndNotesOfSeveralLines) {
  const TemporaryFolder folder;
  RigJob job = priced_job();
  job.folder = folder.path();
  FixedClock clock;
  HistoryRequest request;
  request.add = true;
  request.fields = {{"batch", "B7"}, {"notes", "slid\nand tore"}};
  EXPECT_TRUE(contains(history_job(job, request, clock).text, "slid and tore"));
  HistoryRequest other;
  other.batch_only = "B8";
  EXPECT_TRUE(contains(refusal([&] { history_job(job, other, clock); }), "there are: B7"));
}

TEST(HistoryJob, ChargesFailedPiecesToTheGoodOnes) {
  const TemporaryFolder folder;
  RigJob job = priced_job();
  job.folder = folder.path();
  job.config.cost.currency = "EUR";
  FixedClock clock;
  const auto dip = [&](const std::string& outcome) {
    HistoryRequest request;
    request.add = true;
    request.fields = {{"outcome", outcome}};
    return history_job(job, request, clock);
  };
  dip("good");
  dip("failed");
  const JobResult result = dip("good");
  // Three times 3.35, for two pieces.
  EXPECT_TRUE(contains(result.text, "cost: 10.05 EUR; a good piece: 5.03 EUR") ||
              contains(result.text, "cost: 10.05 EUR; a good piece: 5.02 EUR"))
      << result.text;
  EXPECT_TRUE(contains(result.text, "3 dips: 2 good, 1 failed"));
}

// Tomorrow it may be good: then it pays for itself.
TEST(HistoryJob, ChargesNoGoodPieceWithADipThatNobodyHasJudged) {
  const TemporaryFolder folder;
  RigJob job = priced_job();
  job.folder = folder.path();
  FixedClock clock;
  const auto dip = [&](const std::string& outcome) {
    HistoryRequest request;
    request.add = true;
    if (!outcome.empty()) request.fields = {{"outcome", outcome}};
    return history_job(job, request, clock);
  };
  const auto totals_of = [](const JobResult& result) {
    return nlohmann::json::parse(result.json)["totals"];
  };
  const double piece = totals_of(dip("good"))["cost_per_good_piece"];
  const JobResult result = dip("");
  EXPECT_NEAR(totals_of(result)["cost_per_good_piece"], piece, 1e-12);
  EXPECT_NEAR(totals_of(result)["cost"], 2 * piece, 1e-12);
  EXPECT_TRUE(contains(result.text, "a good piece: 3.35 (without 1 dip not judged)"))
      << result.text;
  EXPECT_NEAR(totals_of(dip("good"))["cost_per_good_piece"], piece, 1e-12);
  EXPECT_NEAR(totals_of(dip("failed"))["cost_per_good_piece"], 1.5 * piece, 1e-12);
}

}  // namespace
}  // namespace hydrodip
