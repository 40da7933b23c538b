// Several jobs in one process at the same time, and jobs that are stopped at any of the places
// where they look.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "job/dips_side_by_side.h"
#include "job/job_part.h"
#include "job/jobs.h"
#include "samples/samples.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;

// Past the sphere's equator film tears all around: a job that also looks for a better way, which
// takes ten times as long as all else. Not so far it is dipped in some hundredths of a second.
constexpr double kShallow_mm = 12, kWholly_mm = 60;

JobConfig small_job(const fs::path& model, const fs::path& output, int threads, double step_mm,
                    double depth_mm) {
  JobConfig config;
  config.design.trajectory.depth_mm = depth_mm;
  config.model = model;
  config.output = output;
  config.design.film.elements = 2000;
  config.design.dip.step_mm = step_mm;
  config.design.dpi = 36;
  config.preview_width_px = 200;
  config.preview_texture_px = 64;
  config.threads = threads;
  return config;
}

// Everything but the report, which tells times.
std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> hashes;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("report.", 0) != 0) hashes[name] = sha256_hex(read_file(entry.path()));
  }
  return hashes;
}

class SideBySideJobs : public ::testing::Test {
 protected:
  void SetUp() override { write_sample("sphere", make_sample("sphere"), folder_.path()); }
  JobConfig job(const std::string& output, int threads, double step_mm = 1,
                double depth_mm = kShallow_mm) const {
    return small_job(folder_ / "sphere.obj", folder_ / output, threads, step_mm, depth_mm);
  }

  const TemporaryFolder folder_;
};

TEST_F(SideBySideJobs, GiveTheFilesThatEachGivesAlone) {
  struct One {
    int threads;
    double step_mm, depth_mm;
  };
  const std::array<One, 3> ones = {
      {{1, 1, kShallow_mm}, {2, 1.5, kWholly_mm}, {4, 0.75, kShallow_mm}}};
  std::array<std::map<std::string, std::string>, 3> alone;
  for (std::size_t n = 0; n < ones.size(); ++n) {
    // With as many threads as there are: those of the others must not show.
    RunContext context;
    print_job(job("alone", 0, ones[n].step_mm, ones[n].depth_mm), context);
    alone[n] = files_of(folder_ / "alone");
    ASSERT_GE(alone[n].size(), 5U);
  }
  EXPECT_NE(alone[0], alone[1]);  // different jobs

  std::array<std::thread, 3> jobs;
  std::array<std::exception_ptr, 3> failures;
  for (std::size_t n = 0; n < ones.size(); ++n)
    jobs[n] = std::thread([&, n] {
      try {
        RunContext context;
        const int times = ones[n].depth_mm == kWholly_mm ? 1 : 2;
        for (int repeat = 0; repeat < times; ++repeat)
          print_job(job(std::to_string(n), ones[n].threads, ones[n].step_mm, ones[n].depth_mm),
                    context);
      } catch (...) {
        failures[n] = std::current_exception();
      }
    });
  for (std::thread& one : jobs) one.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  for (std::size_t n = 0; n < ones.size(); ++n)
    EXPECT_EQ(files_of(folder_ / std::to_string(n)), alone[n]) << ones[n].threads << " threads";
}

TEST_F(SideBySideJobs, OneIsCancelledAndTheOtherGoesOn) {
  RunContext kept, stopped;
  stopped.cancel_at_check(500);
  std::thread other(
      [&] { EXPECT_THROW(print_job(job("stopped", 2, 1, kWholly_mm), stopped), Cancelled); });
  print_job(job("kept", 2), kept);
  other.join();
  EXPECT_FALSE(fs::exists(folder_ / "stopped"));
  EXPECT_TRUE(fs::exists(folder_ / "kept" / "film.ply"));
}

// The places are the checks, of which a job with one thread always makes the same number.
class Cancellation : public SideBySideJobs {
 protected:
  template <typename Job>
  void expect_stops_anywhere(const Job& job) {
    constexpr std::int64_t kPlaces = 16;
    // Twice: what a process computes once is looked at in the first run alone.
    std::int64_t checks = 0;
    for (int run = 0; run < 2; ++run) {
      RunContext whole;
      whole.cancel_at_check(std::int64_t(1) << 60);
      fs::remove_all(folder_ / "out");  // an older result is looked at, too
      job(whole);
      checks = whole.checks();
    }
    ASSERT_GT(checks, kPlaces);
    fs::remove_all(folder_ / "out");
    for (std::int64_t place = 0; place <= kPlaces; ++place) {
      const std::int64_t n = 1 + (checks - 1) * place / kPlaces;
      RunContext context;
      context.cancel_at_check(n);
      EXPECT_THROW(job(context), Cancelled) << "at check " << n << " of " << checks;
      // With one thread, nothing goes on and looks again, but tasks that are side by side.
      EXPECT_LE(context.checks(), n + 16) << "at check " << n << " of " << checks;
      EXPECT_FALSE(fs::exists(folder_ / "out")) << "at check " << n << " of " << checks;
    }
  }
};

TEST_F(Cancellation, StopsPrintingAtAnyCheck) {
  expect_stops_anywhere([&](const RunContext& context) { print_job(job("out", 1, 2), context); });
}

TEST_F(Cancellation, StopsLookingForABetterWay) {
  RunContext context;
  bool looked = false;
  context.on_progress([&](const std::string& activity, double) {
    if (activity != "trying ways to hold it") return;
    looked = true;
    context.cancel();
  });
  EXPECT_THROW(print_job(job("out", 1, 2, kWholly_mm), context), Cancelled);
  EXPECT_TRUE(looked);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(Cancellation, StopsInspectingAtAnyCheck) {
  expect_stops_anywhere([&](const RunContext& context) { inspect_job(job("out", 1, 2), context); });
}

TEST_F(Cancellation, StopsASampleAtAnyCheck) {
  expect_stops_anywhere(
      [&](const RunContext& context) { sample_job("sphere", folder_ / "out", context); });
}

// Six sheets may each have something to mind: whoever prints has to know of which.
TEST(DipsSideBySide, SayWhichDipAWarningIsOf) {
  const RunContext context;
  dip_side_by_side(3, "dipping", context, [](std::size_t i, const RunContext& own) {
    if (i != 1) own.warn(i == 0 ? "film is short" : "ink is thin");
  });
  EXPECT_EQ(context.warnings(),
            (std::vector<std::string>{"dip 1: film is short", "dip 3: ink is thin"}));
}

// One at a time, too, and all else that it tells is heard.
TEST(JobPart, WarnsUnderItsName) {
  const RunContext context;
  std::vector<std::string> heard;
  context.on_progress([&](const std::string& activity, double) { heard.push_back(activity); });
  context.on_log([&](const std::string& line) { heard.push_back(line); });
  do_part("dip 2", context, [](const RunContext& own) {
    own.progress("dipping", 0.5);
    own.log("a round");
    own.warn("ink is thin");
  });
  EXPECT_EQ(context.warnings(), std::vector<std::string>{"dip 2: ink is thin"});
  EXPECT_EQ(heard, (std::vector<std::string>{"dipping", "a round"}));
  context.cancel();
  EXPECT_THROW(do_part("dip 3", context, [](const RunContext& own) { own.progress("dipping", 0); }),
               Cancelled);
}

}  // namespace
}  // namespace hydrodip
