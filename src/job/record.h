// What a finished print or simulate job has to say about itself.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/output_folder.h"
#include "job/config.h"
#include "job/dip_stage.h"
#include "job/jobs.h"
#include "job/stage_times.h"

namespace hydrodip {

// References stay valid as long as the job runs.
struct JobRecord {
  std::string command;  // "print"
  const JobConfig& config;
  const DippedObject& dipped;
  const StageTimes& times;
  RunContext& context;
};

// One sentence: how much is covered, how far the film stretches, whether it tears.
std::string verdict(const DipFigures& figures);

// report.json and report.html into the folder's staging area; the preview is shown in the page.
void write_reports(OutputFolder& folder, const JobRecord& record, const Image& preview);

// After commit(): what the command prints.
JobResult describe_result(const JobRecord& record, const OutputFolder& folder);

}  // namespace hydrodip
