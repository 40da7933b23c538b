#include "sweep/sweep_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/run_scope.h"
#include "settings/settings.h"
#include "sweep/sweep_axes.h"
#include "sweep/sweep_file.h"
#include "sweep/sweep_inputs.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;
using Json = SweepFile::Json;

constexpr const char* kModel = "model";
constexpr const char* kModelFile = "object.file";

struct Listed {
  std::vector<RunValues> values;
  std::vector<std::string> models;
};

Listed listed(const SweepFile& file, const fs::path& folder) {
  Listed list;
  for (const Json& run : file.runs()) {
    list.values.emplace_back();
    list.models.emplace_back();
    for (const auto& [name, value] : file.entries(run)) {
      if (name == kModel)
        list.models.back() = file.file_at(value, "run.model", folder);
      else
        list.values.back().emplace_back(name, file.text(value, name, folder));
    }
  }
  return list;
}

std::vector<std::string> models_of(const SweepFile& file, const fs::path& folder) {
  const Json& sweep = file.table("sweep");
  std::vector<std::string> models;
  if (!sweep.contains("models")) return models;
  if (!sweep["models"].is_array()) file.refuse("sweep.models: must be a list of files");
  for (const Json& model : sweep["models"])
    models.push_back(file.file_at(model, "sweep.models", folder));
  return models;
}

RunValues held_values(const SweepFile& file, const fs::path& folder) {
  RunValues held;
  for (const auto& [name, value] : file.entries(file.table("set")))
    held.emplace_back(name, file.text(value, name, folder));
  return held;
}

std::vector<std::string> varied_names(const std::vector<SweepRun>& runs) {
  std::vector<std::string> names;
  std::map<std::string, std::set<std::string>> seen;
  for (const SweepRun& run : runs) {
    seen[kModel].insert(run.model);
    for (const auto& [name, value] : run.values) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
      seen[name].insert(value);
    }
  }
  // What some runs do not set at all differs as well.
  for (const std::string& name : names)
    for (const SweepRun& run : runs)
      if (std::ranges::none_of(run.values, [&](const auto& v) { return v.first == name; }))
        seen[name].insert("");
  std::erase_if(names, [&](const std::string& name) { return seen[name].size() < 2; });
  if (seen[kModel].size() > 1) names.insert(names.begin(), kModel);
  return names;
}

// What the method would pass over has no place in the file.
void require_heard(const SweepFile& file, const std::string& method) {
  if (method == "list" && file.has("vary"))
    file.refuse(
        "[[run]] tables name each run, [vary] makes runs of its own: keep one of the two, and put "
        "what holds for all under [set]");
  if (method != "list" && file.has("run"))
    file.refuse(fmt::format(
        "[[run]] tables are for method = \"list\", not \"{}\": leave out the one or the other",
        method));
  for (const char* key : {"runs", "seed"})
    if (method != "latin" && file.says(key))
      file.refuse(fmt::format("sweep.{}: is for method = \"latin\", and this sweep's is \"{}\"",
                              key, method));
}

// Files are named as from the sweep's folder.
std::string as_from_here(const std::string& name, const std::string& value,
                         const fs::path& folder) {
  return names_file(name, value) ? (folder / value).string() : value;
}

bool sets(const SweepRun& run, const std::string& name) {
  return std::ranges::any_of(run.values, [&](const auto& value) { return value.first == name; });
}

}  // namespace

SweepPlan read_sweep(const fs::path& file, const fs::path& folder, const RunContext& context) {
  const RunScope scope(context);
  const SweepFile sweep(file);
  SweepPlan plan;
  plan.command = sweep_command_of(sweep.choice("command", sweep_command_names()));
  plan.quality = sweep.choice("quality", {"normal", "draft", "fine"});
  plan.keep_files = sweep.choice("keep", {"report", "all"}) == "all";
  const std::string method =
      sweep.choice("method", {sweep.has("run") ? "list" : "grid", "grid", "list", "latin"});
  require_heard(sweep, method);
  if (sweep.says("job")) plan.job = sweep.file_at(sweep.table("sweep")["job"], "sweep.job", folder);

  Listed runs;
  if (method == "list")
    runs = listed(sweep, folder);
  else if (method == "latin")
    runs.values = latin_runs(sweep, folder, sweep.whole("runs", 100, 1, kMostRuns),
                             sweep.whole("seed", 1, 0, ~std::uint64_t{0} >> 1));
  else
    runs.values = grid_runs(sweep, folder, context);
  if (runs.values.empty()) sweep.refuse("there are no runs in it: write [[run]] tables");
  runs.models.resize(runs.values.size());

  std::vector<std::string> models = models_of(sweep, folder);
  if (models.empty()) models.emplace_back();
  sweep.require_few_enough(double(models.size()) * double(runs.values.size()));
  const RunValues held = held_values(sweep, folder);
  FileHashes hashes;
  std::set<std::string> ids;
  for (const std::string& model : models)
    for (std::size_t i = 0; i < runs.values.size(); ++i) {
      context.check_cancelled();
      SweepRun run;
      run.model = runs.models[i].empty() ? model : runs.models[i];
      run.values = held;
      run.values.insert(run.values.end(), runs.values[i].begin(), runs.values[i].end());
      note_inputs(plan, run, folder, hashes, context);  // says what is wrong
      if (ids.insert(run.id).second)
        plan.runs.push_back(std::move(run));
      else
        ++plan.same;
    }
  plan.varied = varied_names(plan.runs);
  return plan;
}

std::string value_of(const SweepRun& run, const std::string& name) {
  if (name == kModel) return run.model;
  std::string value;
  for (const auto& [own, text] : run.values)
    if (own == name) value = text;  // the last one counts
  return value;
}

JobConfig sweep_config(const SweepPlan& plan, const SweepRun& run, const fs::path& folder) {
  if (!run.model.empty() && sets(run, kModelFile))
    throw InputError(fmt::format(
        "{} and models under [sweep] (or model in a [[run]]) both name the model of a run: leave "
        "out one of them",
        kModelFile));
  SettingSources sources;
  if (!plan.quality.empty()) sources.quality = quality_settings(plan.quality);
  if (!plan.job.empty()) sources.configs.push_back(folder / plan.job);
  // A sweep's poses are its own.
  sources.options.push_back({"plan.suggest", std::string("off"), false, "'off'", "sweep"});
  if (!plan.keep_files)
    sources.options.push_back({"preview.pictures", std::string("off"), false, "'off'", "sweep"});
  for (const auto& [name, value] : run.values)
    sources.sets.push_back(
        {name, as_from_here(name, value, folder), false, "'" + value + "'", "the sweep"});
  // As 'hydrodip print' refuses what would be passed over.
  JobConfig config = configured("", std::move(sources));
  if (!run.model.empty()) config.model = folder / run.model;
  if (config.model.empty())
    throw InputError(
        "the sweep names no model: write models = [\"FILE\"] under [sweep], or a job with one");
  return config;
}

}  // namespace hydrodip
