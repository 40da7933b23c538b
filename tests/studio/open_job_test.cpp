// What a job does when the store has it no more, or no room for it.
#include "studio/open_job.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "base/error.h"
#include "base/file.h"
#include "full_disk.h"
#include "studio/api_error.h"
#include "studio/models.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

class OpenJobTest : public testing::Test {
 protected:
  std::unique_ptr<OpenJob> open() {
    name = store.create();
    return open_again();
  }
  std::unique_ptr<OpenJob> open_again() {
    return std::make_unique<OpenJob>(store, name, "run-1", numbers);
  }
  static OpenJob::Change turned() {
    OpenJob::Change change;
    change.client = "c1";
    change.document["object"]["down"] = "+x";
    return change;
  }

  TemporaryFolder folder;
  JobStore store{folder.path()};
  std::string name;
  std::shared_ptr<std::atomic<long>> numbers = std::make_shared<std::atomic<long>>(0);
};

std::string code_of(const std::function<void()>& what) {
  try {
    what();
  } catch (const ApiError& error) {
    return error.code;
  }
  return "";
}

// A tab may close whenever it likes, also where nothing can be written any more.
TEST_F(OpenJobTest, ATabClosesWhereNothingCanBeKept) {
  const auto job = open();
  const auto stream = job->connect("c1");
  std::filesystem::remove_all(folder.path());
  EXPECT_NO_THROW(job->disconnect("c1", stream));
  EXPECT_TRUE(job->idle_since());
  EXPECT_NO_THROW(job->say_goodbye("over"));
}

// Its tab may be known to be gone only when another job has been worked on for a while.
TEST_F(OpenJobTest, LeavingItIsNoChangeOfIt) {
  const auto job = open();
  const auto stream = job->connect("c1");
  job->put(turned());
  const auto changed = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  std::filesystem::last_write_time(store.home(name) / "state.json", changed);
  ASSERT_TRUE(store.read(name)["open"]);
  job->disconnect("c1", stream);
  EXPECT_FALSE(store.read(name)["open"]);
  EXPECT_EQ(std::filesystem::last_write_time(store.home(name) / "state.json"), changed);
  const auto again = job->connect("c1");
  auto change = turned();
  change.document["object"]["down"] = "-x";
  job->put(change);
  EXPECT_GT(std::filesystem::last_write_time(store.home(name) / "state.json"), changed);
}

// The edit holds for everybody who has the job open, whether or not the disk has room for it.
TEST_F(OpenJobTest, AnEditThatCannotBeKeptIsSaidAndHolds) {
  const auto job = open();
  const auto stream = job->connect("c1");
  const auto other = job->connect("c2");
  std::string told;
  ASSERT_TRUE(other->next(told, std::chrono::milliseconds(0)));
  std::filesystem::remove_all(store.home(name));
  EXPECT_EQ(code_of([&] { job->put(turned()); }), "failed");
  EXPECT_EQ(job->describe()["document"]["object"]["down"], "+x");
  told.clear();
  ASSERT_TRUE(other->next(told, std::chrono::milliseconds(0)));
  EXPECT_NE(told.find("event: document"), std::string::npos) << told;
}

TEST_F(OpenJobTest, OneThatIsLookedAtIsNotLetGo) {
  const auto job = open();
  const auto stream = job->connect("c1");
  EXPECT_FALSE(job->let_go());
  EXPECT_NO_THROW(job->put(turned()));
  job->disconnect("c1", stream);
  EXPECT_TRUE(job->let_go());
}

// Whoever came by a moment before it was forgotten is told so, and nothing of it comes back.
TEST_F(OpenJobTest, OneThatIsForgottenTakesNothingMore) {
  const auto job = open();
  ASSERT_TRUE(job->let_go());
  store.forget(name);
  EXPECT_EQ(code_of([&] { job->connect("c1"); }), "not-found");
  EXPECT_EQ(code_of([&] { job->put(turned()); }), "not-found");
  EXPECT_EQ(code_of([&] { job->start_task({{"kind", "print"}}); }), "not-found");
  EXPECT_FALSE(std::filesystem::exists(store.home(name)));
}

// What was saved is there until it is saved again.
TEST_F(OpenJobTest, ANewNameOnAFullDiskLosesNoFile) {
  const auto job = open();
  job->save("first");
  const std::filesystem::path files = store.home(name) / "files";
  ASSERT_TRUE(std::filesystem::exists(files / "first.toml"));
  {
    const FullDisk full(0);
    EXPECT_NE(code_of([&] { job->save("second"); }), "");
  }
  EXPECT_TRUE(std::filesystem::exists(files / "first.toml"));
  EXPECT_TRUE(job->describe()["where"].get<std::string>().ends_with("first.toml"));
  EXPECT_TRUE(job->save("second")["where"].get<std::string>().ends_with("second.toml"));
  EXPECT_TRUE(std::filesystem::exists(files / "second.toml"));
  EXPECT_FALSE(std::filesystem::exists(files / "first.toml"));
}

// A job file in the folder that another has the name of keeps its own.
TEST_F(OpenJobTest, SavedAgainItKeepsTheNameThatItGot) {
  const auto job = open();
  const std::filesystem::path files = store.home(name) / "files";
  write_file(files / "job.toml", "another");
  for (int time = 0; time < 3; ++time)
    EXPECT_TRUE(job->save("job")["where"].get<std::string>().ends_with("job-2.toml"));
}

// What the running print reads and tells the hash of is its own.
TEST_F(OpenJobTest, ASecondPrintChangesNothingOfTheFirst) {
  const auto job = open();
  write_file(store.home(name) / "files/toy.obj", kRedToy);
  write_file(store.home(name) / "files/toy.mtl", kRed);
  OpenJob::Change change;
  change.client = "c1";
  change.document = {{"object", {{"file", "toy.obj"}}},
                     {"film", {{"elements", 640000}}},
                     {"dip", {{"step_mm", 0.02}}}};
  job->put(change);
  const std::string task = job->start_task({{"kind", "print"}});
  const auto printed = read_file(store.home(name) / "job.toml");
  change.document["object"]["size_mm"] = 33;
  job->put(change);
  EXPECT_EQ(code_of([&] { job->start_task({{"kind", "print"}}); }), "busy");
  EXPECT_TRUE(read_file(store.home(name) / "job.toml") == printed);
  job->cancel_task(task);
}

// A page that saw the job before it was let go knows a task by its name.
TEST_F(OpenJobTest, NoTwoTasksOfARunHaveOneName) {
  auto job = open();
  write_file(store.home(name) / "files/part.stl", kTetrahedron);
  OpenJob::Change change;
  change.client = "c1";
  change.document["object"]["file"] = "part.stl";
  job->put(change);
  const std::string first = job->start_task({{"kind", "print"}});
  job.reset();
  job = open_again();
  EXPECT_NE(job->start_task({{"kind", "print"}}), first);
}

// A large model that is read when the program ends does not hold it up.
TEST_F(OpenJobTest, WorkForOneThatIsOverIsCancelled) {
  for (const bool forgotten : {false, true}) {
    const auto job = open();
    for (const char* file : {"part.stl", "toy.mtl"})
      write_file(store.home(name) / "files" / file, kTetrahedron);
    OpenJob::Change change;
    change.client = "c1";
    change.document["object"]["file"] = "part.stl";
    job->put(change);
    EXPECT_NO_THROW(job->pack());
    EXPECT_NO_THROW(job->adopt({"part.stl", "toy.mtl"}, "c1"));
    if (forgotten) {
      ASSERT_TRUE(job->let_go());
    } else {
      job->say_goodbye("over");
    }
    EXPECT_THROW(job->pack(), Cancelled);
    EXPECT_THROW(job->adopt({"part.stl", "toy.mtl"}, "c1"), Cancelled);
  }
}

// A tab that comes again, as after a lost line, takes the place that it had.
TEST_F(OpenJobTest, TheLastTabMayComeAgain) {
  const auto job = open();
  for (int tab = 1; tab <= 12; ++tab) job->connect("c" + std::to_string(tab));
  EXPECT_EQ(code_of([&] { job->connect("c12"); }), "");
  EXPECT_EQ(code_of([&] { job->connect("c13"); }), "busy");
}

}  // namespace
}  // namespace hydrodip
