#include "sweep/sweep_jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "sweep/scripts.h"
#include "sweep/sweep_table.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

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

// Of the first run that has an outcome; it is done if none has. 0: it failed, or is not wanted.
double seconds_of_one(const SweepPlanRequest& request, const SweepPlan& plan,
                      const RunContext& context, std::string& trouble) {
  const std::string& id = plan.runs.front().id;
  if (request.trial) {
    context.progress("trying the first run", 0);
    run_sweep(request.folder, plan, {{}, id, false}, context.quiet());
  }
  const auto outcome = read_outcome(request.folder, id);
  if (!outcome) return 0;
  if (!outcome->error.empty()) trouble = outcome->error;
  return outcome->error.empty() ? outcome->seconds : 0;
}

}  // namespace

JobResult sweep_plan_job(const SweepPlanRequest& request, const RunContext& context) {
  OutputFolder output(request.folder);
  const SweepPlan plan = read_sweep(request.file, request.folder);
  const std::vector<std::string> files = {"sweep.json", "parallel.sh", "slurm.sh"};
  output.announce(files, {request.file});
  std::string trouble;
  const double seconds = seconds_of_one(request, plan, context, trouble);
  const int tasks = request.tasks > 0 ? request.tasks : tasks_for(plan.runs.size(), seconds);
  write_file(output.path("sweep.json"), manifest_json(plan));
  write_file(output.path("parallel.sh"), parallel_script(tasks));
  write_file(output.path("slurm.sh"),
             slurm_script(tasks, fs::weakly_canonical(fs::absolute(request.folder))));
  make_runnable(output.path("parallel.sh"));
  make_runnable(output.path("slurm.sh"));
  output.commit();

  JobResult result;
  result.folder = request.folder;
  result.files = files;
  const std::string folder = request.folder.string();
  result.text = fmt::format("{} runs", plan.runs.size());
  if (seconds > 0)
    result.text += fmt::format(", about {:.2g} s each: {} on one core", seconds,
                               duration(seconds * double(plan.runs.size())));
  result.text += fmt::format(
      "\nhere:          hydrodip sweep run {0}\nGNU parallel:  {0}/parallel.sh\nSlurm:         "
      "sbatch "
      "{0}/slurm.sh   ({1} tasks)\nand then:      hydrodip sweep collect {0}\n",
      folder, tasks);
  result.text += output.told_replaced();
  if (!trouble.empty()) result.text += "the first run failed: " + trouble + "\n";
  result.json = dump({{"folder", folder},
                      {"runs", plan.runs.size()},
                      {"seconds_each", seconds > 0 ? Json(seconds) : Json()},
                      {"tasks", tasks}});
  return result;
}

JobResult sweep_run_job(const fs::path& folder, const SweepWork& work, const RunContext& context) {
  const SweepPlan plan = read_manifest(folder);
  const SweepDone done = run_sweep(folder, plan, work, context);
  JobResult result;
  result.folder = folder;
  result.text = fmt::format("{} done, {} failed", done.done, done.failed);
  if (done.before > 0) result.text += fmt::format(", {} were done before", done.before);
  if (done.elsewhere > 0)
    result.text += fmt::format(", {} are being done elsewhere", done.elsewhere);
  result.text += fmt::format("\n'hydrodip sweep collect {}' puts them together\n", folder.string());
  result.json = dump({{"done", done.done},
                      {"failed", done.failed},
                      {"before", done.before},
                      {"elsewhere", done.elsewhere}});
  return result;
}

JobResult sweep_collect_job(const fs::path& folder, const RunContext& context) {
  const SweepPlan plan = read_manifest(folder);
  OutputFolder output(folder);
  const SweepTable table = make_table(folder, plan);
  JobResult result;
  result.folder = folder;
  result.files = {"table.csv", "table.json"};
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
      fmt::format("{} runs: {} done, {} failed, {} missing\n", table.rows.size(),
                  count(RunState::kDone), count(RunState::kFailed), count(RunState::kMissing));
  constexpr std::size_t kShown = 10;
  std::size_t shown = 0;
  for (const SweepRow& row : table.rows)
    if (row.state == RunState::kFailed && shown++ < kShown)
      result.text += fmt::format("  {} failed: {}\n", row.run->id, row.error);
  if (shown > kShown) result.text += fmt::format("  and {} more, see table.csv\n", shown - kShown);
  result.text += fmt::format("wrote to {}:", folder.string());
  for (const std::string& file : result.files) result.text += " " + file;
  result.text += "\n" + output.told_replaced();
  result.json = dump({{"runs", table.rows.size()},
                      {"done", count(RunState::kDone)},
                      {"failed", count(RunState::kFailed)},
                      {"missing", count(RunState::kMissing)},
                      {"files", result.files}});
  return result;
}

}  // namespace hydrodip
