#include <gtest/gtest.h>
#include <pthread.h>

#include <chrono>
#include <memory>
#include <thread>

#include "base/context.h"
#include "base/error.h"
#include "base/file.h"
#include "image/image.h"
#include "report/plain_words.h"
#include "samples/samples.h"
#include "studio/api_error.h"
#include "studio/bundle.h"
#include "studio/client.h"
#include "studio/document.h"
#include "studio/event_stream.h"
#include "studio/run_file.h"
#include "studio/sample_shelf.h"
#include "studio/shown_mesh.h"
#include "studio/tasks.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

TEST(Bundle, ArraysLieWhereItSays) {
  Json head;
  head["name"] = "a";
  Bundle bundle(head);
  bundle.add("bytes", std::vector<std::uint8_t>{1, 2, 3}, 1);
  bundle.add("floats", std::vector<float>{0.5F, -1, 2, 3}, 2);
  bundle.add("none", std::vector<std::uint32_t>{}, 3);
  const std::vector<std::uint8_t> bytes = bundle.finish();
  const ReadBundle read(std::string(bytes.begin(), bytes.end()));
  EXPECT_EQ(read.head["name"], "a");
  EXPECT_EQ(read.array<std::uint8_t>("bytes"), (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_EQ(read.array<float>("floats"), (std::vector<float>{0.5F, -1, 2, 3}));
  EXPECT_TRUE(read.array<std::uint32_t>("none").empty());
  // Pages take arrays as they lie: from the whole answer's beginning, at multiples of eight.
  EXPECT_EQ((bytes.size() - read.data.size()) % 8, 0u);
  for (const auto& [name, at] : read.head["arrays"].items())
    EXPECT_EQ(at["offset"].get<std::size_t>() % 8, 0u) << name;
}

// What is shown live is what would be printed.
TEST(Document, IsSettledAsAJobsFileIs) {
  const TemporaryFolder folder;
  write_file(folder / "inks.icc", "any");
  write_file(folder / "correction.json", "none");
  const JobFiles files(folder.path());
  const JobConfig config = config_of({{"ink", {{"profile", "inks.icc"}}}}, files);
  EXPECT_EQ(config.printer.model, InkModel::kProfile);
  EXPECT_EQ(config_of({{"dip", {{"scheme", "paper"}}}}, files).design.film.grading, 1);
  for (const Json& wrong : {Json{{"film", {{"correction", "correction.json"}}}},
                            Json{{"process", {{"soak_min_s", 90}, {"soak_max_s", 60}}}},
                            Json{{"ink", {{"profile", "inks.icc"}, {"model", "device"}}}}})
    EXPECT_THROW(config_of(wrong, files), ApiError) << wrong;
}

TEST(EventStream, OnlyTheNewestOfAKindWaits) {
  EventStream stream;
  for (int n = 0; n < 5; ++n) stream.push("working", Json{{"n", n}, {"of", 5}}, true);
  stream.push("result", Json{{"n", 7}, {"of", 5}});
  std::string text;
  ASSERT_TRUE(stream.next(text, std::chrono::milliseconds(1)));
  EXPECT_EQ(
      text,
      "event: working\ndata: {\"n\":4,\"of\":5}\n\nevent: result\ndata: {\"n\":7,\"of\":5}\n\n");
  ASSERT_TRUE(stream.next(text, std::chrono::milliseconds(1)));
  EXPECT_EQ(text, "") << "a sign of life comes every two seconds";
  stream.close();
  EXPECT_FALSE(stream.next(text, std::chrono::milliseconds(1)));
}

TEST(PlainWords, HaveNoOptionsInThem) {
  EXPECT_EQ(in_plain_words("Turn steep sides down (--rotate, --down), dip less deep (--depth)."),
            "Turn steep sides down, dip less deep.");
  EXPECT_EQ(in_plain_words("use a film that bears more (material.tear_stretch)."),
            "use a film that bears more.");
  EXPECT_EQ(in_plain_words("shrink it with --size 71 or less, turn it with --rotate, or take a "
                           "larger --film"),
            "shrink it to 71 mm or less, turn it, or take a larger sheet of film");
  EXPECT_EQ(in_plain_words("Take them away: 'hydrodip plan' looks for ways."), "Take them away.");
  EXPECT_EQ(in_plain_words("Plan more dips (--dips): 'hydrodip plan' says how much each one adds."),
            "Plan more dips.");
  EXPECT_EQ(
      in_plain_words("Make more dips ('hydrodip plan' with --dips 4 looks for them), or wait."),
      "Make more dips, or wait.");
  EXPECT_EQ(in_plain_words("12 mm (x) and 3 % (CIEDE2000)"), "12 mm (x) and 3 % (CIEDE2000)");
}

TEST(SampleShelf, PlacesWhatTheSampleIsAndKeepsNothingOfOtherBuilds) {
  const TemporaryFolder folder;
  for (const char* name : {"shelf/other-build/box", "made", "first", "second"})
    std::filesystem::create_directories(folder / name);
  write_sample("box", make_sample("box"), folder / "made");
  SampleShelf shelf(folder / "shelf");
  for (const char* to : {"first", "second"}) {
    EXPECT_EQ(shelf.place("box", folder / to), "box.obj");
    for (const char* file : {"box.obj", "box.mtl", "box.png"})
      EXPECT_EQ(read_file(folder / to / file), read_file(folder / "made" / file)) << file;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "shelf/other-build"));
  EXPECT_THROW(shelf.place("boks", folder / "first"), InputError);
  RunContext cancelled;
  cancelled.cancel();
  EXPECT_NO_THROW(shelf.fill(cancelled));
}

// While it lives, this process can begin no thread: none has so much room.
class NoThreads {
 public:
  NoThreads() {
    ::pthread_getattr_default_np(&before_);
    pthread_attr_t huge;
    ::pthread_attr_init(&huge);
    ::pthread_attr_setstacksize(&huge, std::size_t(1) << 47U);
    ::pthread_setattr_default_np(&huge);
    ::pthread_attr_destroy(&huge);
  }
  ~NoThreads() {
    ::pthread_setattr_default_np(&before_);
    ::pthread_attr_destroy(&before_);
  }
  NoThreads(const NoThreads&) = delete;
  NoThreads& operator=(const NoThreads&) = delete;

 private:
  pthread_attr_t before_;
};

// A machine that has no thread left refuses a task, and nothing of it is kept.
TEST(Tasks, OneThatCannotBeginIsNone) {
  const TemporaryFolder folder;
  Tasks tasks([](const Json&) {});
  TaskRequest print;
  print.name = "t1";
  print.kind = "print";
  print.job = folder / "missing.toml";
  print.folder = folder / "print";
  {
    const NoThreads none;
    EXPECT_THROW(tasks.start(print), ApiError);
  }
  EXPECT_FALSE(tasks.any_running());
  EXPECT_TRUE(tasks.list().empty());
  EXPECT_NO_THROW(tasks.start(print));
  while (tasks.any_running()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(tasks.list().at(0)["state"], "failed");
}

// Textures are packed when a page asks, which may be when the job's time is over.
TEST(ShownTexture, IsOfTheJob) {
  const auto image = std::make_shared<const Image>(8, 8);
  RunContext job;
  EXPECT_FALSE(ShownTexture(image, job).picture().bytes.empty());
  job.cancel();
  EXPECT_THROW(ShownTexture(image, job).picture(), Cancelled);
}

TEST(RunFile, ALaterRunFindsOnlyWhatAKilledOneLeft) {
  const TemporaryFolder folder;
  {
    RunFile first(folder.path());
    EXPECT_EQ(first.earlier().port, 0);
    first.keep(4714, "secret");
    RunFile beside(folder.path());  // a second studio at the same time
    EXPECT_EQ(beside.earlier().port, 0);
    EXPECT_EQ(beside.earlier().token, "");
    EXPECT_EQ(beside.another().port, 4714);
    EXPECT_EQ(beside.another().token, "secret");
    std::filesystem::copy(folder / "run.json", folder / "as-it-was.json");
  }
  EXPECT_EQ(RunFile(folder.path()).earlier().token, "");  // that one had ended well
  std::filesystem::copy(folder / "as-it-was.json", folder / "run.json",
                        std::filesystem::copy_options::overwrite_existing);
  RunFile next(folder.path());
  EXPECT_EQ(next.earlier().port, 4714);
  EXPECT_EQ(next.earlier().token, "secret");
  EXPECT_EQ(next.another().port, 0);
}

}  // namespace
}  // namespace hydrodip
