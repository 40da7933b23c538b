// How long jobs go on after they were cancelled, at random moments of print at 600 dpi, calibrate,
// inspect and sample: the largest of 200, those above the goal, and where they were.
// `bench_cancel_latency [MOMENTS [JOB...]]`: only jobs whose name has one of these words in it.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "calibrate/calibrate.h"
#include "job/jobs.h"
#include "settings/settings.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMoments = 200;
constexpr double kGoal_ms = 50;

struct Work {
  std::string name;
  double share;  // of the moments
  std::function<void(const RunContext&)> run;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Stop {
  double latency_ms = 0;
  std::string where;
};

// Cancels once the job has run for so long. No latency if it had ended by then.
Stop stop_after(const Work& work, double seconds) {
  RunContext context;
  std::mutex telling;
  std::string where = "before the first activity";
  context.on_progress([&](const std::string& activity, double fraction) {
    const std::lock_guard lock(telling);
    where = fmt::format("{} ({:.0f} %)", activity, 100 * fraction);
  });
  Clock::time_point ended;
  bool stopped = false;
  std::exception_ptr failure;
  std::thread job([&] {
    try {
      work.run(context);
    } catch (const Cancelled&) {
      stopped = true;
    } catch (...) {
      failure = std::current_exception();
    }
    ended = Clock::now();
  });
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  Stop stop;
  {
    const std::lock_guard lock(telling);
    stop.where = fmt::format("{} after {:.2f} s: {}", work.name, seconds, where);
  }
  const Clock::time_point asked = Clock::now();
  context.cancel();
  job.join();
  if (failure) std::rethrow_exception(failure);
  if (stopped) stop.latency_ms = std::chrono::duration<double, std::milli>(ended - asked).count();
  return stop;
}

JobConfig print_config(const TemporaryFolder& folder, const std::string& sample) {
  JobConfig config;
  apply_settings(config, film_settings("a4"));
  config.model = folder / (sample + ".obj");
  config.output = folder / "out";
  config.design.dpi = 600;
  return config;
}

// A small grid of quick dips, as the tests have it.
JobConfig calibration_config(const std::filesystem::path& output) {
  JobConfig config;
  config.design.film.width_mm = config.design.film.height_mm = 110;
  config.design.film.elements = 6000;
  config.design.dip.step_mm = 0.4;
  config.output = output;
  return config;
}

std::vector<Work> all_work(const TemporaryFolder& folder) {
  std::vector<Work> all;
  for (const std::string sample : {"mask", "sphere"}) {
    RunContext context;
    sample_job(sample, folder.path(), context);
    const JobConfig config = print_config(folder, sample);
    all.push_back(
        {"print " + sample, 0.35, [config](const RunContext& job) { print_job(config, job); }});
  }
  CalibrationRequest synthesis;
  synthesis.scans = {"sphere"};
  RunContext context;
  synth_job(calibration_config(folder / "scans"), synthesis, context);
  CalibrationRequest request;
  request.scans = {"sphere=" + (folder / "scans" / "sphere-scan.csv").string()};
  request.z_stretch = "0.4:0.8:0.2";
  request.stiffness_ratio = "40";
  request.poisson = "0.2";
  all.push_back({"calibrate", 0.1, [&folder, request](const RunContext& job) {
                   // From nothing: what is simulated is kept for the next time.
                   const std::filesystem::path output = folder / "calibration";
                   std::filesystem::remove_all(output);
                   calibrate_job(calibration_config(output), request, job);
                 }});
  const JobConfig inspected = print_config(folder, "mask");
  all.push_back(
      {"inspect", 0.15, [inspected](const RunContext& job) { inspect_job(inspected, job); }});
  all.push_back({"sample", 0.05,
                 [&folder](const RunContext& job) { sample_job("mask", folder / "sample", job); }});
  return all;
}

bool wanted(const Work& work, const std::vector<std::string>& only) {
  return only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& word) {
           return work.name.find(word) != std::string::npos;
         });
}

void run(int moments, const std::vector<std::string>& only) {
  const TemporaryFolder folder;
  std::vector<Stop> stops;
  std::mt19937 random(18);
  for (const Work& work : all_work(folder)) {
    if (!wanted(work, only)) continue;
    RunContext whole;
    const Clock::time_point start = Clock::now();
    work.run(whole);
    const double length = seconds_since(start);
    std::uniform_real_distribution<double> moment(0, length);
    Stop worst;
    const int count = std::max(1, int(moments * work.share));
    for (int n = 0; n < count; ++n) {
      stops.push_back(stop_after(work, moment(random)));
      const Stop& stop = stops.back();
      if (stop.latency_ms > kGoal_ms) {
        fmt::print("{:5.1f} ms: {}\n", stop.latency_ms, stop.where);
        std::fflush(stdout);
      }
      if (stop.latency_ms >= worst.latency_ms) worst = stop;
    }
    fmt::print("{:<12} {:6.2f} s, {:3} moments, largest {:5.1f} ms: {}\n", work.name, length, count,
               worst.latency_ms, worst.where);
    std::fflush(stdout);
  }
  std::sort(stops.begin(), stops.end(),
            [](const Stop& a, const Stop& b) { return a.latency_ms < b.latency_ms; });
  fmt::print("cancel_latency: {} moments, largest {:.1f} ms ({}), 95 % below {:.1f} ms\n",
             stops.size(), stops.back().latency_ms, stops.back().where,
             stops[stops.size() * 95 / 100].latency_ms);
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> words(argv + 1, argv + std::max(argc, 1));
    hydrodip::run(words.empty() ? hydrodip::kMoments : std::atoi(words[0].c_str()),
                  words.empty() ? words : std::vector(words.begin() + 1, words.end()));
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
  return 0;
}
