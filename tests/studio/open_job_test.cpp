// What a job does when the store has it no more, or no room for it.
#include "studio/open_job.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "studio/api_error.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

class OpenJobTest : public testing::Test {
 protected:
  std::unique_ptr<OpenJob> open() {
    name = store.create();
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

}  // namespace
}  // namespace hydrodip
