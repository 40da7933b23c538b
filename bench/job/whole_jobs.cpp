// What whole jobs take, from the model file to the last output: print at 600 dpi with all rounds,
// and simulate as a draft. `bench_jobs [MODEL [TEXTURE [SIZE_MM]]]`; without a model, the sample
// mask.

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "job/jobs.h"
#include "settings/settings.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

using Clock = std::chrono::steady_clock;

struct Timed {
  double seconds = 0;
  nlohmann::json report;
  double of(std::initializer_list<const char*> stages) const {
    double sum = 0;
    for (const auto& stage : report["seconds"]["stages"])
      for (const char* name : stages)
        if (stage["stage"] == name) sum += stage["seconds"].get<double>();
    return sum;
  }
};

Timed run(JobResult (*job)(const JobConfig&, const RunContext&), const JobConfig& config) {
  RunContext context;
  const auto start = Clock::now();
  job(config, context);
  Timed timed;
  timed.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  timed.report = nlohmann::json::parse(std::ifstream(config.output / "report.json"));
  return timed;
}

JobConfig job(const std::filesystem::path& model, const std::filesystem::path& texture,
              const std::string& size_mm, const std::filesystem::path& output) {
  JobConfig config;
  apply_settings(config, film_settings("a4"));
  if (!size_mm.empty()) apply_settings(config, {parse_set("object.size_mm=" + size_mm)});
  config.model = model;
  config.object.load.texture = texture;
  config.output = output;
  return config;
}

void print_at_600_dpi(JobConfig config) {
  config.design.dpi = 600;
  const Timed timed = run(print_job, config);
  int rounds = 0;
  for (const auto& round : timed.report["rounds"]) rounds += round["process"] == "ink" ? 1 : 0;
  fmt::print(
      "print_600dpi: {:.1f} s, {} rounds, {:.0f} % torn; dips {:.1f} s, raster, files and "
      "previews {:.1f} s\n",
      timed.seconds, rounds, 100 * timed.report["coverage"]["torn_share"].get<double>(),
      timed.of({"dip"}), timed.of({"invert", "sheet", "preview"}));
}

void draft(JobConfig config) {
  apply_settings(config, quality_settings("draft"));
  Timed best = run(simulate_job, config);
  for (int n = 0; n < 4; ++n) {
    Timed timed = run(simulate_job, config);
    if (timed.seconds < best.seconds) best = std::move(timed);
  }
  fmt::print("draft: {:.2f} s (best of 5); load {:.2f}, dip {:.2f}, previews {:.2f} s\n",
             best.seconds, best.of({"load"}), best.of({"dip"}), best.of({"preview"}));
}

void run(const std::filesystem::path& model, const std::filesystem::path& texture,
         const std::string& size_mm) {
  const TemporaryFolder folder;
  RunContext context;
  if (model.empty()) sample_job("mask", folder.path(), context);
  const std::filesystem::path dipped = model.empty() ? folder / "mask.obj" : model;
  const JobConfig config = job(dipped, texture, size_mm, folder / "job");
  fmt::print("{} on A4 film\n", dipped.filename().string());
  print_at_600_dpi(config);
  draft(config);
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  try {
    hydrodip::run(argc > 1 ? argv[1] : "", argc > 2 ? argv[2] : "", argc > 3 ? argv[3] : "");
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
  return 0;
}
