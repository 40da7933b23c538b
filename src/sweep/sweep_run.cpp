#include "sweep/sweep_run.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/json_nesting.h"
#include "job/jobs.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

fs::path outcome_file(const fs::path& folder, const std::string& id) {
  return folder / "runs" / (id + ".json");
}

// Held while a run is done. The lock goes with the process, however it ends.
class Claim {
 public:
  Claim(const fs::path& folder, const std::string& id) : file_(folder / "claims" / id) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
      throw InputError(
          fmt::format("{}: cannot be written; the sweep's folder has to be writable by whoever "
                      "runs it",
                      file_.string()));
    held_ = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
  }
  ~Claim() {
    if (held_) ::unlink(file_.c_str());
    ::close(descriptor_);
  }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

  bool held() const { return held_; }

 private:
  fs::path file_;
  int descriptor_ = -1;
  bool held_ = false;
};

bool has_failed(const fs::path& folder, const std::string& id) {
  const auto outcome = read_outcome(folder, id);
  return outcome && !outcome->error.empty();
}

bool is_pending(const fs::path& folder, const std::string& id, bool again) {
  std::error_code ignored;
  return !fs::exists(outcome_file(folder, id), ignored) || (again && has_failed(folder, id));
}

JobResult run_job(SweepCommand command, const JobConfig& config, const RunContext& context) {
  switch (command) {
    case SweepCommand::kSimulate:
      return simulate_job(config, context);
    case SweepCommand::kPrint:
      return print_job(config, context);
    case SweepCommand::kOrient:
      return orient_job(config, context);
  }
  throw std::logic_error("an unknown command in a sweep");
}

// In a folder of its own, which is left only if its files are to be kept.
std::string report_of(const SweepPlan& plan, const SweepRun& run, const fs::path& folder,
                      const RunContext& context) {
  JobConfig config = sweep_config(plan, run, folder);
  config.threads = 1;
  const fs::path files = folder / (plan.keep_files ? "files" : "work") / run.id;
  config.output = files;
  const auto remove = [&] {
    std::error_code ignored;
    if (!plan.keep_files) fs::remove_all(files, ignored);
  };
  try {
    const JobResult result = run_job(plan.command, config, context);
    remove();
    return result.json;
  } catch (...) {
    remove();
    throw;
  }
}

// The same wherever the sweep's folder is seen from: paths as the manifest has them.
Json independent_of_place(const std::string& text, const fs::path& folder) {
  Json report = Json::parse(text);
  report.erase("folder");
  const auto from_folder = [&](Json& path) {
    const fs::path relative = fs::path(path.get<std::string>()).lexically_relative(folder);
    if (!relative.empty()) path = relative.string();
  };
  if (report.contains("inputs"))
    for (Json& input : report["inputs"]) from_folder(input.at("path"));
  if (report.contains("parameters"))
    from_folder(report["parameters"].at("object.file").at("value"));
  return report;
}

void write_outcome(const fs::path& folder, const SweepRun& run, const SweepOutcome& outcome,
                   int exit_code) {
  Json json = {{"id", run.id}, {"exit_code", exit_code}, {"seconds", outcome.seconds}};
  if (outcome.error.empty())
    json["report"] = independent_of_place(outcome.report, folder);
  else
    json["error"] = outcome.error;
  // Under its final name when it is whole. Only who holds the claim writes it.
  const fs::path unfinished = folder / "work" / (run.id + ".json");
  write_file(unfinished, json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
  std::error_code error;
  fs::rename(unfinished, outcome_file(folder, run.id), error);
  if (error)
    throw InputError(fmt::format("{}: cannot be written ({})",
                                 outcome_file(folder, run.id).string(), error.message()));
}

// Whether it went well. What is wrong with a run is its outcome; only Cancelled leaves.
bool do_run(const SweepPlan& plan, const SweepRun& run, const fs::path& folder,
            const RunContext& context) {
  const auto start = std::chrono::steady_clock::now();
  SweepOutcome outcome;
  int exit_code = 0;
  try {
    outcome.report = report_of(plan, run, folder, context);
  } catch (const InputError& error) {
    outcome.error = error.what();
    exit_code = 2;
  } catch (const DipError& error) {
    outcome.error = error.what();
    exit_code = 3;
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_outcome(folder, run, outcome, exit_code);
  return exit_code == 0;
}

std::vector<const SweepRun*> chosen(const SweepPlan& plan, const SweepWork& work) {
  std::vector<const SweepRun*> runs;
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const bool wanted = work.id.empty() ? work.shard.has(i) : plan.runs[i].id == work.id;
    if (wanted) runs.push_back(&plan.runs[i]);
  }
  if (runs.empty() && !work.id.empty())
    throw InputError(fmt::format("the sweep has no run '{}'; sweep.json lists them", work.id));
  return runs;
}

}  // namespace

std::optional<SweepOutcome> read_outcome(const fs::path& folder, const std::string& id) {
  const fs::path file = outcome_file(folder, id);
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  const std::vector<std::uint8_t> bytes = read_file(file);
  const Json json = parsed_json<Json>(bytes);
  const bool usable =
      json.is_object() && json.contains("seconds") && json["seconds"].is_number() &&
      (json.contains("report") ? json["report"].is_object()
                               : json.contains("error") && json["error"].is_string());
  if (!usable)
    throw InputError(fmt::format(
        "{}: this is no run's outcome; remove it, and 'hydrodip sweep run' does the run again",
        file.string()));
  SweepOutcome outcome;
  outcome.seconds = json["seconds"].get<double>();
  if (json.contains("report"))
    outcome.report = json["report"].dump();
  else
    outcome.error = json["error"].get<std::string>();
  return outcome;
}

SweepDone run_sweep(const fs::path& folder, const SweepPlan& plan, const SweepWork& work,
                    const RunContext& context) {
  std::error_code error;
  fs::create_directories(folder / "claims", error);
  fs::create_directories(folder / "runs", error);
  fs::create_directories(folder / "work", error);
  std::atomic<int> done = 0, failed = 0, before = 0, elsewhere = 0;
  std::vector<std::function<void()>> tasks;
  for (const SweepRun* run : chosen(plan, work)) {
    if (!is_pending(folder, run->id, work.again)) {
      ++before;
      continue;
    }
    tasks.emplace_back([&, run] {
      const Claim claim(folder, run->id);
      if (!claim.held() || !is_pending(folder, run->id, work.again)) {
        ++elsewhere;
        return;
      }
      ++(do_run(plan, *run, folder, context.quiet().with_threads(1)) ? done : failed);
    });
  }
  if (!tasks.empty()) context.side_by_side("running the sweep", tasks);
  return {done, failed, before, elsewhere};
}

}  // namespace hydrodip
