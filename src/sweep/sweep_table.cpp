#include "sweep/sweep_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "base/parallel.h"
#include "sweep/sweep_run.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

// Parts of the report that are results; the rest is what was asked for, or text.
constexpr const char* kParts[] = {"coverage", "stretch", "wrinkled_mm2", "lifted_mm2",       "air",
                                  "figures",  "ink",     "seconds",      "peak_memory_bytes"};

struct RunFigures {
  std::map<std::string, double> value;
  std::vector<std::string> order;  // as the report has them
};

void flatten(const Json& value, const std::string& name, RunFigures& figures) {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items())
      flatten(inner, fmt::format("{}.{}", name, key), figures);
  } else if (value.is_number() || value.is_boolean()) {
    figures.value[name] = value.is_boolean() ? double(value.get<bool>()) : value.get<double>();
    figures.order.push_back(name);
  }
}

std::string state_name(RunState state) {
  switch (state) {
    case RunState::kDone:
      return "done";
    case RunState::kFailed:
      return "failed";
    case RunState::kMissing:
      return "missing";
  }
  return "";
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

// All but its figures, which come behind the names that all runs together have.
SweepRow row_of(const std::filesystem::path& folder, const SweepRun& run, RunFigures& figures) {
  SweepRow row;
  row.run = &run;
  const auto outcome = read_outcome(folder, run.id);
  if (!outcome) return row;
  row.state = outcome->error.empty() ? RunState::kDone : RunState::kFailed;
  row.error = outcome->error;
  row.version = outcome->version;
  if (row.state == RunState::kFailed) return row;
  const Json report = Json::parse(outcome->report);
  if (report.contains("concern") && report["concern"].is_string())
    row.verdict = report["concern"].get<std::string>();
  for (const char* part : kParts)
    if (report.contains(part)) flatten(report[part], part, figures);
  if (report.contains("poses") && !report["poses"].empty())
    flatten(report["poses"].front(), "best", figures);
  return row;
}

}  // namespace

SweepTable make_table(const std::filesystem::path& folder, const SweepPlan& plan) {
  SweepTable table;
  table.rows.resize(plan.runs.size());
  std::vector<RunFigures> figures(plan.runs.size());
  parallel_for(plan.runs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      table.rows[i] = row_of(folder, plan.runs[i], figures[i]);
  });
  for (const RunFigures& run : figures)
    for (const std::string& name : run.order)
      if (std::ranges::find(table.figure_names, name) == table.figure_names.end())
        table.figure_names.push_back(name);
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    for (const std::string& name : table.figure_names) {
      const auto found = figures[i].value.find(name);
      table.rows[i].figures.push_back(
          found == figures[i].value.end() ? std::nullopt : std::optional(found->second));
    }
  return table;
}

std::string table_csv(const SweepTable& table, const SweepPlan& plan) {
  std::string csv = "id,state";
  for (const std::string& name : plan.varied) csv += "," + csv_cell(name);
  csv += ",verdict";
  for (const std::string& name : table.figure_names) csv += "," + name;
  csv += ",version,error\n";
  for (const SweepRow& row : table.rows) {
    csv += row.run->id + "," + state_name(row.state);
    for (const std::string& name : plan.varied) csv += "," + csv_cell(value_of(*row.run, name));
    csv += "," + row.verdict;
    for (const auto& figure : row.figures) csv += figure ? fmt::format(",{}", *figure) : ",";
    csv += "," + csv_cell(row.version) + "," + csv_cell(row.error) + "\n";
  }
  return csv;
}

std::string table_json(const SweepTable& table, const SweepPlan& plan) {
  Json rows = Json::array();
  for (const SweepRow& row : table.rows) {
    Json values = Json::object(), figures = Json::object();
    for (const std::string& name : plan.varied) values[name] = value_of(*row.run, name);
    for (std::size_t i = 0; i < table.figure_names.size(); ++i)
      if (row.figures[i]) figures[table.figure_names[i]] = *row.figures[i];
    Json entry = {{"id", row.run->id}, {"state", state_name(row.state)}, {"values", values}};
    if (!row.version.empty()) entry["version"] = row.version;
    if (row.state == RunState::kDone) {
      entry["verdict"] = row.verdict;
      entry["figures"] = figures;
    }
    if (row.state == RunState::kFailed) entry["error"] = row.error;
    rows.push_back(entry);
  }
  const Json json = {{"hydrodip_sweep_table", 1}, {"varied", plan.varied}, {"runs", rows}};
  return json_text(json);
}

}  // namespace hydrodip
