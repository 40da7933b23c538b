#include "sweep/sweep_manifest.h"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/json_nesting.h"
#include "base/json_text.h"
#include "base/obstacle.h"
#include "sweep/sweep_command.h"
#include "sweep/sweep_inputs.h"

namespace hydrodip {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kSchemaVersion = 2;

}  // namespace

std::string manifest_json(const SweepPlan& plan) {
  Json runs = Json::array();
  for (const SweepRun& run : plan.runs) {
    Json values = Json::object();
    for (const auto& [name, value] : run.values) values[name] = value;
    runs.push_back({{"id", run.id}, {"model", run.model}, {"values", values}});
  }
  const Json json = {{"hydrodip_sweep", kSchemaVersion},
                     {"command", name_of(plan.command)},
                     {"quality", plan.quality},
                     {"job", plan.job},
                     {"keep", plan.keep_files ? "all" : "report"},
                     {"varied", plan.varied},
                     {"inputs", plan.inputs},
                     {"model_files", plan.model_files},
                     {"runs", runs}};
  return json_text(json);
}

SweepPlan read_manifest(const fs::path& folder) {
  const fs::path file = folder / "sweep.json";
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    throw InputError(
        fmt::format("{}: {}; name the folder that 'hydrodip sweep plan FILE.toml -o DIR' made",
                    folder.string(), why_absent(folder, "sweep.json")));
  const std::vector<std::uint8_t> bytes = read_file(file);
  try {
    const Json json = parsed_json<Json>(bytes);
    if (json.at("hydrodip_sweep").get<int>() != kSchemaVersion)
      throw InputError(
          fmt::format("{}: made by another version; plan the sweep again", file.string()));
    SweepPlan plan;
    plan.command = sweep_command_of(json.at("command").get<std::string>());
    plan.quality = json.at("quality").get<std::string>();
    plan.job = json.at("job").get<std::string>();
    plan.keep_files = json.at("keep") == "all";
    plan.varied = json.at("varied").get<std::vector<std::string>>();
    plan.inputs = json.at("inputs").get<decltype(plan.inputs)>();
    plan.model_files = json.at("model_files").get<decltype(plan.model_files)>();
    for (const Json& entry : json.at("runs")) {
      SweepRun run;
      run.id = entry.at("id").get<std::string>();
      if (run.id.size() != kIdDigits ||
          run.id.find_first_not_of("0123456789abcdef") != std::string::npos)
        throw InputError(fmt::format("{}: '{}' is no run's id", file.string(), run.id));
      run.model = entry.at("model").get<std::string>();
      for (const auto& [name, value] : entry.at("values").items())
        run.values.emplace_back(name, value.get<std::string>());
      plan.runs.push_back(std::move(run));
    }
    return plan;
  } catch (const Json::exception&) {
    throw InputError(
        fmt::format("{}: this is no sweep's manifest; plan the sweep again", file.string()));
  }
}

}  // namespace hydrodip
