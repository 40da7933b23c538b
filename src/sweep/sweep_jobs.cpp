#include "sweep/sweep_jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "base/shell_word.h"
#include "sweep/scripts.h"
#include "sweep/sweep_manifest.h"
#include "sweep/sweep_table.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void make_runnable(const fs::path& file) {
  std::error_code ignored;
  fs::permissions(file, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                  fs::perm_options::add, ignored);
}

std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", std::ceil(seconds));
  if (seconds < 6000) return fmt::format("{:.0f} min", std::ceil(seconds / 60));
  return fmt::format("{:.1f} h", seconds / 3600);
}

constexpr const char* kParallel = "parallel.sh";
constexpr const char* kScripts[] = {kParallel, "slurm.sh"};

// Those that somebody has changed.
std::vector<std::string> edited_scripts(const fs::path& folder) {
  std::vector<std::string> edited;
  std::error_code ignored;
  for (const char* script : kScripts) {
    if (!fs::is_regular_file(folder / script, ignored)) continue;
    const std::vector<std::uint8_t> bytes = read_file(folder / script);
    if (!is_as_made({bytes.begin(), bytes.end()})) edited.emplace_back(script);
  }
  return edited;
}

// No more than there are runs.
int tasks_of(const SweepPlanRequest& request, const SweepPlan& plan, double seconds) {
  return request.tasks > 0 ? int(std::min(std::size_t(request.tasks), plan.runs.size()))
                           : tasks_for(plan.runs.size(), seconds);
}

std::string count_of(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

// 0.12, 1.2, 12, 120
std::string two_digits(double value) {
  return value < 10 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

// The first run. Returns what was wrong, if it was not done.
std::string run_trial(const SweepPlanRequest& request, const SweepPlan& plan,
                      const RunContext& context) {
  const auto leave_nothing = [&] {
    std::error_code ignored;
    for (const char* part : {"claims", "runs", "work"})
      fs::remove(request.folder / part, ignored);  // empty
  };
  try {
    const SweepWork first{{}, plan.runs.front().id, false, request.version};
    return run_sweep(request.folder, plan, first, context).what_changed;
  } catch (const Cancelled&) {
    leave_nothing();
    throw Cancelled("cancelled; the sweep was not planned");
  } catch (const NoRoomForResults& why) {
    leave_nothing();
    throw InputError(fmt::format("{} The sweep was not planned", why.what()));
  }
}

// Of the first run that has an outcome; it is done if none has. 0: it failed, or is not wanted.
double seconds_of_one(const SweepPlanRequest& request, const SweepPlan& plan,
                      const RunContext& context, std::string& trouble) {
  const std::string& id = plan.runs.front().id;
  if (request.trial) {
    context.progress("trying the first run", 0);
    trouble = run_trial(request, plan, context.quiet());
  }
  const auto outcome = read_outcome(request.folder, id);
  if (!outcome) return 0;
  if (!outcome->error.empty()) trouble = outcome->error;
  return outcome->error.empty() ? outcome->seconds : 0;
}

std::map<std::string, int> versions_of(const SweepTable& table) {
  std::map<std::string, int> runs;
  for (const SweepRow& row : table.rows)
    if (row.state != RunState::kMissing) ++runs[row.version];
  return runs;
}

}  // namespace

JobResult sweep_plan_job(const SweepPlanRequest& request, const RunContext& context) {
  OutputFolder output(request.folder);
  const SweepPlan plan = read_sweep(request.file, request.folder, context);
  const std::vector<std::string> edited = edited_scripts(request.folder);
  std::vector<std::string> files = {"sweep.json"};
  for (const char* script : kScripts)
    if (std::ranges::find(edited, script) == edited.end()) files.emplace_back(script);
  output.announce(files, {request.file});
  std::string trouble;
  const double seconds = seconds_of_one(request, plan, context, trouble);
  const int tasks = tasks_of(request, plan, seconds);
  for (const char* script : kScripts) {
    if (std::ranges::find(files, script) == files.end()) continue;
    write_file(output.path(script),
               script == kParallel
                   ? parallel_script(tasks)
                   : slurm_script(tasks, fs::weakly_canonical(fs::absolute(request.folder))));
    make_runnable(output.path(script));
  }
  write_file(output.path("sweep.json"), manifest_json(plan));
  output.commit();

  JobResult result;
  result.folder = request.folder;
  result.files = files;
  const std::string folder = shell_word(request.folder.string());
  result.text = count_of(plan.runs.size(), "run");
  if (seconds > 0)
    result.text += fmt::format(", about {} s each: {} on one core", two_digits(seconds),
                               duration(seconds * double(plan.runs.size())));
  if (plan.same > 0)
    result.text += fmt::format(
        "\n{} more would be the same as one of these, as all that they read "
        "is the same, and {} left out",
        plan.same, plan.same == 1 ? "is" : "are");
  result.text += fmt::format(
      "\nhere:          hydrodip sweep run {0}\nGNU parallel:  {0}/parallel.sh\nSlurm:         "
      "sbatch "
      "{0}/slurm.sh   ({1})\nand then:      hydrodip sweep collect {0}\n",
      folder, count_of(std::size_t(tasks), "task"));
  for (const std::string& script : edited)
    result.text += fmt::format(
        "kept {}, which was edited: remove it, and the next 'sweep plan' writes a new one\n",
        script);
  result.text += output.told_replaced();
  if (!trouble.empty()) result.text += "the first run failed: " + trouble + "\n";
  result.json = json_answer("sweep plan", {{"folder", request.folder.string()},
                                           {"runs", plan.runs.size()},
                                           {"same", plan.same},
                                           {"seconds_each", seconds > 0 ? Json(seconds) : Json()},
                                           {"tasks", tasks}});
  return result;
}

JobResult sweep_run_job(const fs::path& folder, const SweepWork& work, const RunContext& context) {
  const SweepPlan plan = read_manifest(folder);
  const SweepDone done = [&] {
    try {
      return run_sweep(folder, plan, work, context);
    } catch (const NoRoomForResults& why) {
      throw InputError(
          fmt::format("{} The runs that are done are kept; free space, and 'hydrodip sweep run {}' "
                      "does the rest",
                      why.what(), shell_word(folder.string())));
    }
  }();
  if (done.changed > 0)
    throw InputError(fmt::format("{} ({}: {} done, {} failed, {} not done for that)",
                                 done.what_changed, folder.string(), done.done + done.before,
                                 done.failed, done.changed));
  JobResult result;
  result.folder = folder;
  result.text = fmt::format("{} done, {} failed", done.done, done.failed);
  const auto were = [](int runs) { return fmt::format("{} {}", runs, runs == 1 ? "was" : "were"); };
  if (done.before > 0) result.text += fmt::format(", {} done before", were(done.before));
  if (done.elsewhere > 0)
    result.text += fmt::format(", {} taken by another 'sweep run'", were(done.elsewhere));
  if (!done.by_others.empty())
    result.text += fmt::format(
        "\nother versions did some of those before: {}; this is hydrodip {}, and --again does them "
        "once more",
        told_versions(done.by_others), work.version);
  result.text +=
      fmt::format("\nput them together: hydrodip sweep collect {}\n", shell_word(folder.string()));
  result.json = json_answer("sweep run", {{"done", done.done},
                                          {"failed", done.failed},
                                          {"before", done.before},
                                          {"elsewhere", done.elsewhere},
                                          {"by_other_versions", done.by_others}});
  return result;
}

JobResult sweep_collect_job(const fs::path& folder, const RunContext& context) {
  const RunScope scope(context);
  const SweepPlan plan = read_manifest(folder);
  OutputFolder output(folder);
  const SweepTable table = make_table(folder, plan);
  JobResult result;
  result.folder = folder;
  result.files = {"table.csv", "table.json"};
  output.announce({"table.csv", "table.json", "response.svg"}, {});
  output.supersede({"response.svg"});
  write_file(output.path("table.csv"), table_csv(table, plan));
  write_file(output.path("table.json"), table_json(table, plan));
  const std::string response = response_svg(table, plan);
  if (!response.empty()) {
    write_file(output.path("response.svg"), response);
    result.files.emplace_back("response.svg");
  }
  context.check_cancelled();
  output.commit();

  const auto count = [&](RunState state) {
    return std::ranges::count(table.rows, state, &SweepRow::state);
  };
  result.text =
      fmt::format("{}: {} done, {} failed, {} missing\n", count_of(table.rows.size(), "run"),
                  count(RunState::kDone), count(RunState::kFailed), count(RunState::kMissing));
  constexpr std::size_t kShown = 10;
  std::size_t shown = 0;
  for (const SweepRow& row : table.rows)
    if (row.state == RunState::kFailed && shown++ < kShown)
      result.text += fmt::format("  {} failed: {}\n", row.run->id, row.error);
  if (shown > kShown) result.text += fmt::format("  and {} more, see table.csv\n", shown - kShown);
  const std::map<std::string, int> versions = versions_of(table);
  if (versions.size() > 1)
    result.text += fmt::format(
        "several versions of the program did them: {} (table.csv has which did what); 'hydrodip "
        "sweep run {} --again' does once more what other versions did\n",
        told_versions(versions), shell_word(folder.string()));
  result.text += fmt::format("wrote to {}:", folder.string());
  for (const std::string& file : result.files) result.text += " " + file;
  result.text += "\n" + output.told_replaced();
  result.json = json_answer("sweep collect", {{"runs", table.rows.size()},
                                              {"done", count(RunState::kDone)},
                                              {"failed", count(RunState::kFailed)},
                                              {"missing", count(RunState::kMissing)},
                                              {"by_version", versions},
                                              {"files", result.files}});
  return result;
}

}  // namespace hydrodip
