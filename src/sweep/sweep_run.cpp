#include "sweep/sweep_run.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/file_lock.h"
#include "base/json_nesting.h"
#include "base/json_text.h"
#include "job/jobs.h"
#include "settings/params.h"
#include "sweep/sweep_inputs.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

fs::path outcome_file(const fs::path& folder, const std::string& id) {
  return folder / "runs" / (id + ".json");
}

// Held while a run is done.
class Claim {
 public:
  Claim(const fs::path& folder, const std::string& id) : file_(folder / "claims" / id) {
    lock_ = locked();
    // Whoever had it has just removed it.
    for (int tries = 0; tries < 10 && lock_.state() == FileLock::State::kGone; ++tries)
      lock_ = locked();
  }
  ~Claim() {
    if (held()) ::unlink(file_.c_str());
  }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

  bool held() const { return lock_.state() != FileLock::State::kTaken; }
  // Another may hold it as well.
  bool is_unlocked() const { return held() && lock_.state() != FileLock::State::kHeld; }

 private:
  FileLock locked() const {
    const int descriptor = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0)
      throw InputError(
          fmt::format("{}: cannot be written; the sweep's folder has to be writable by whoever "
                      "runs it",
                      file_.string()));
    return {descriptor, file_};
  }

  fs::path file_;
  FileLock lock_;
};

// However they came about: in this call, another, or when the sweep was planned.
std::size_t count_done(const fs::path& folder, const std::vector<const SweepRun*>& runs) {
  return std::size_t(std::count_if(runs.begin(), runs.end(), [&](const SweepRun* run) {
    std::error_code none;
    return fs::exists(outcome_file(folder, run->id), none);
  }));
}

// No two of them need to come to the same, and an id says nothing of them.
bool is_of_another_version(const SweepOutcome& outcome, const SweepWork& work) {
  return !work.version.empty() && outcome.version != work.version;
}

bool is_pending(const std::optional<SweepOutcome>& outcome, const fs::path& folder,
                const SweepPlan& plan, const std::string& id, const SweepWork& work) {
  if (!outcome) return true;
  if (work.again && is_of_another_version(*outcome, work)) return true;
  if (!outcome->error.empty()) return work.again;
  // It was done when its files were not wanted.
  std::error_code ignored;
  return plan.keep_files && !fs::exists(folder / "files" / id, ignored);
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
    require_as_planned(plan, result.json, folder);
    remove();
    return result.json;
  } catch (const ChangedInput&) {
    std::error_code ignored;
    fs::remove_all(files, ignored);
    throw;
  } catch (...) {
    remove();
    throw;
  }
}

// The same wherever the sweep's folder is seen from: paths as the manifest has them.
Json independent_of_place(const std::string& text, const fs::path& folder) {
  Json report = Json::parse(text);
  report.erase("folder");
  const auto from_folder = [&](Json& path) {  // as it is written there
    const fs::path relative = fs::path(path.get<std::string>()).lexically_relative(folder);
    if (!relative.empty()) path = relative.string();
  };
  if (report.contains("inputs"))
    for (Json& input : report["inputs"]) from_folder(input.at("path"));
  if (report.contains("parameters"))
    for (const auto& [name, parameter] : report["parameters"].items())
      if (Json& value = parameter.at("value");
          value.is_string() && names_file(name, value.get<std::string>()))
        from_folder(value);
  return report;
}

void write_outcome(const fs::path& folder, const SweepRun& run, const SweepOutcome& outcome,
                   int exit_code) {
  Json json = {{"id", run.id}, {"exit_code", exit_code}, {"seconds", outcome.seconds}};
  if (!outcome.version.empty()) json["version"] = outcome.version;
  if (outcome.error.empty())
    json["report"] = independent_of_place(outcome.report, folder);
  else
    json["error"] = outcome.error;
  write_whole(outcome_file(folder, run.id), json_line(json) + "\n");
}

// Of no run is it the fault.
bool is_out_of_space(const std::string& sentence) {
  for (const int error : {ENOSPC, EDQUOT})
    if (sentence.find(std::generic_category().message(error)) != std::string::npos) return true;
  return false;
}

// Whether it went well. What is wrong with a run is its outcome; Cancelled leaves, and what
// is not the run's fault: ChangedInput and NoRoomForResults.
bool do_run(const SweepPlan& plan, const SweepRun& run, const fs::path& folder,
            const std::string& version, const RunContext& context) {
  const auto start = std::chrono::steady_clock::now();
  SweepOutcome outcome;
  outcome.version = version;
  int exit_code = 0;
  try {
    outcome.report = report_of(plan, run, folder, context);
  } catch (const ChangedInput&) {
    throw;
  } catch (const InputError& error) {
    if (is_out_of_space(error.what())) throw NoRoomForResults(error.what());
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

// Programs that did not note theirs left their number in the report.
std::string version_in(const Json& outcome) {
  const auto text = [](const Json& version) {
    return version.is_string() ? version.get<std::string>() : std::string();
  };
  if (outcome.contains("version")) return text(outcome["version"]);
  const Json::json_pointer in_report("/report/tool/version");
  return outcome.contains(in_report) ? text(outcome[in_report]) : "";
}

}  // namespace

std::optional<SweepOutcome> read_outcome(const fs::path& folder, const std::string& id) {
  const fs::path file = outcome_file(folder, id);
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return {};
  const std::vector<std::uint8_t> bytes = read_file(file);
  const Json json = parsed_json<Json>(bytes);
  const bool usable =
      json.is_object() && json.contains("id") && json["id"] == id && json.contains("seconds") &&
      json["seconds"].is_number() &&
      (json.contains("report") ? json["report"].is_object()
                               : json.contains("error") && json["error"].is_string());
  if (!usable) return {};
  SweepOutcome outcome;
  outcome.seconds = json["seconds"].get<double>();
  if (json.contains("report"))
    outcome.report = json["report"].dump();
  else
    outcome.error = json["error"].get<std::string>();
  outcome.version = version_in(json);
  return outcome;
}

std::string told_versions(const std::map<std::string, int>& runs_by_version) {
  std::string told;
  for (const auto& [version, runs] : runs_by_version)
    told += fmt::format("{}{} by {}", told.empty() ? "" : ", ", runs,
                        version.empty() ? "a version that is not noted" : "hydrodip " + version);
  return told;
}

SweepDone run_sweep(const fs::path& folder, const SweepPlan& plan, const SweepWork& work,
                    const RunContext& context) {
  std::error_code error;
  fs::create_directories(folder / "claims", error);
  fs::create_directories(folder / "runs", error);
  fs::create_directories(folder / "work", error);
  std::atomic<int> done = 0, failed = 0, before = 0, elsewhere = 0, changed = 0;
  std::atomic<bool> told_of_locks = false;
  std::mutex mutex;
  std::string what_changed;
  std::map<std::string, int> by_others;
  FileHashes hashes;
  std::vector<std::function<void()>> tasks;
  const std::vector<const SweepRun*> runs = chosen(plan, work);
  tasks.reserve(runs.size());
  for (const SweepRun* run : runs)
    tasks.emplace_back([&, run] {
      const auto is_pending_now = [&](const std::optional<SweepOutcome>& outcome) {
        return is_pending(outcome, folder, plan, run->id, work);
      };
      if (const auto known = read_outcome(folder, run->id); !is_pending_now(known)) {
        ++before;
        if (!is_of_another_version(*known, work)) return;
        const std::lock_guard lock(mutex);
        ++by_others[known->version];
        return;
      }
      const Claim claim(folder, run->id);
      if (claim.is_unlocked() && !told_of_locks.exchange(true))
        context.warn(fmt::format(
            "{}: its file system has no locks, so that nobody sees which runs another 'hydrodip "
            "sweep run' is at: let one at a time work there, or give each its --shard.",
            folder.string()));
      if (!claim.held() || !is_pending_now(read_outcome(folder, run->id))) {
        ++elsewhere;
        return;
      }
      try {
        require_unchanged(plan, *run, folder, hashes);
        ++(do_run(plan, *run, folder, work.version, context.quiet().with_threads(1)) ? done
                                                                                     : failed);
      } catch (const ChangedInput& why) {
        const std::lock_guard lock(mutex);
        if (what_changed.empty()) what_changed = why.what();
        ++changed;
      }
    });
  if (tasks.empty()) return {};
  try {
    context.side_by_side("running the sweep", tasks);
  } catch (const Cancelled&) {
    throw Cancelled(fmt::format(
        "cancelled; {} of {} runs are done and kept, the others not: 'hydrodip sweep run' does the "
        "rest",
        count_done(folder, runs), runs.size()));
  }
  return {done, failed, before, elsewhere, changed, what_changed, by_others};
}

}  // namespace hydrodip
