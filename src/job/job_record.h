// What a finished print or simulate job has to say about itself.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/output_folder.h"
#include "base/timings.h"
#include "coat/design.h"
#include "coat/finish.h"
#include "job/jobs.h"
#include "job/prepare.h"
#include "report/report.h"
#include "settings/config.h"

namespace hydrodip {

// Refers to what the pipeline holds.
struct JobRecord {
  std::string command;  // "print"
  const JobConfig& config;
  const PreparedObject& prepared;
  const std::vector<ReportInput>& inputs;
  const Finish& finish;
  const Timings& times;
  const RunContext& context;
  const InkResult* ink = nullptr;           // of print
  std::string ink_model = {};               // how colours became inks
  std::string better_way = {};              // how else to dip it; empty: none is known
  std::optional<ReportWanted> wanted = {};  // where something shall be printed
  std::optional<ReportInk> laid = {};       // how much of each ink, once that is known

  const DippedObject& dipped() const { return finish.coats().front().dipped; }
  const Paint& paint() const { return finish.paint(); }
};

// Every file that the job reads, with its hash as it was read. Call it next to reading them.
std::vector<ReportInput> describe_inputs(const JobConfig& config, const PreparedObject& prepared,
                                         const Printer& printer);

// Tells the folder what the command will write and read; throws as OutputFolder::announce.
void announce_outputs(OutputFolder& folder, const std::string& command, const JobConfig& config,
                      const std::vector<ReportInput>& inputs);

// How well the dip is known; null: no ink had to settle.
ReportEquilibrium equilibrium_of(const DipStatistics& dip, const InkResult* ink);

// However it is held: as its own program shows it, scaled.
ReportFigure model_size(const PosedObject& posed);

Report make_report(const JobRecord& record);

// What the command prints: in words, and the report with its folder as JSON. `places`: as
// told_places() has it.
JobResult describe_result(const Report& report, const std::filesystem::path& folder,
                          const std::string& places);

}  // namespace hydrodip
