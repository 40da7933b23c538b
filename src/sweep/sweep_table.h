// What a sweep's runs came to, in one table.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sweep/sweep_plan.h"

namespace hydrodip {

enum class RunState { kDone, kFailed, kMissing };

struct SweepRow {
  const SweepRun* run = nullptr;
  RunState state = RunState::kMissing;
  std::string error;
  std::string version;                         // of the program that did it; empty: not known
  std::string verdict;                         // report.json's concern: "none", "care", "stop"
  std::vector<std::optional<double>> figures;  // as the table's names have them
};

struct SweepTable {
  std::vector<std::string> figure_names;  // "coverage.covered_mm2": report.json's, in its order
  std::vector<SweepRow> rows;             // as the plan has its runs
};

// Of the numbers in each run's report.json, read on the job's threads. The plan has to outlive the
// table. Throws Cancelled.
SweepTable make_table(const std::filesystem::path& folder, const SweepPlan& plan);

// One line a run: id, state, model, the varied values, verdict, figures, version, error.
std::string table_csv(const SweepTable& table, const SweepPlan& plan);
std::string table_json(const SweepTable& table, const SweepPlan& plan);

// How the figures that people ask for first depend on each varied number: a row of plots for each
// figure, a dot for each run, a line through the means. Empty if no number was varied.
std::string response_svg(const SweepTable& table, const SweepPlan& plan);

}  // namespace hydrodip
