#include "history/run_log.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/json_nesting.h"

namespace hydrodip {
namespace {

using Json = nlohmann::json;

std::string text(const Json& entry, const char* key) {
  const auto found = entry.find(key);
  return found != entry.end() && found->is_string() ? found->get<std::string>() : "";
}

std::optional<double> number(const Json& entry, const char* key) {
  const auto found = entry.find(key);
  if (found == entry.end() || !found->is_number()) return {};
  return found->get<double>();
}

void take_in(const Json& entry, DipRun& run) {
  const std::string event = text(entry, "event");
  if (event == "start") {
    run.started_utc = text(entry, "time");
    run.report_sha256 = text(entry, "report_sha256");
    run.batch = text(entry, "batch");
    run.label = text(entry, "label");
  } else if (event == "water") {
    (text(entry, "when") == "after" ? run.water_after_c : run.water_before_c) =
        number(entry, "celsius");
  } else if (event == "film on the water") {
    run.soak_s = 0;  // until it is known
  } else if (event == "soaked") {
    run.soak_s = number(entry, "seconds");
  } else if (event == "activator") {
    run.activator_g = number(entry, "used_g");
  } else if (event == "registered") {
    run.registration_x_mm = number(entry, "x_mm");
    run.registration_y_mm = number(entry, "y_mm");
    run.registration_deg = number(entry, "turn_deg");
  } else if (event == "notes") {
    run.notes = text(entry, "text");
  } else if (event == "end") {
    run.outcome = text(entry, "outcome");
    // A piece fails in the water, not at a loose cable.
    if (run.outcome == "failed" && !run.soak_s) run.outcome = "cancelled";
  }
}

}  // namespace

std::optional<DipRun> read_run_log(const std::filesystem::path& run_folder) {
  std::ifstream log(run_folder / "log.jsonl");
  DipRun run;
  run.id = run_folder.filename().string();
  run.outcome = "unfinished";
  bool guided = false;
  for (std::string line; std::getline(log, line);) {
    const Json entry = parsed_json<Json>(line);
    if (!entry.is_object()) continue;
    // Only `rig guide` begins with what is dipped.
    guided = guided || (text(entry, "event") == "start" && entry.contains("depth_mm"));
    take_in(entry, run);
  }
  if (!guided) return {};
  return run;
}

bool is_begun_log(const std::filesystem::path& run_folder) {
  std::ifstream log(run_folder / "log.jsonl");
  for (std::string line; std::getline(log, line);) {
    const Json entry = parsed_json<Json>(line);
    if (entry.is_object() && text(entry, "event") == "start") return true;
  }
  return false;
}

}  // namespace hydrodip
