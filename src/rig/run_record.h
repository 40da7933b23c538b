// What one run at the bench leaves behind: a folder of its own in the job's folder, with a log that
// is written line by line as things happen, and at the end the stage's trace.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "rig/link.h"
#include "rig/rig_job.h"
#include "rig/trace.h"

namespace hydrodip {

using LogValue = std::variant<double, bool, std::string>;
using LogFields = std::vector<std::pair<std::string, LogValue>>;

class RunRecord {
 public:
  // Makes JOB/rig-N, N the next free number, and log.jsonl in it. Throws InputError.
  RunRecord(const RigJob& job, Clock& clock);

  const std::filesystem::path& folder() const { return folder_; }
  // One line of JSON, on disk when this returns: time, elapsed_s, event, fields. Throws InputError
  // if it cannot be written: what is not logged is lost. If it is the first, the folder goes again.
  void note(const std::string& event, const LogFields& fields = {});
  // trace.csv, trace.svg and report.html (figures, plot, log); nothing of the trace if it is empty.
  // Returns the names of the files in the folder, the log first.
  std::vector<std::string> finish(const Trace& trace);

 private:
  const RigJob& job_;
  Clock& clock_;
  double start_s_;
  std::filesystem::path folder_;
  std::ofstream log_;
  std::vector<std::string> lines_;
};

// Of the last run, if it was broken off: the steps that it had done, or kept of one before. Empty
// otherwise. Runs that ended before they had asked whether to keep them, and those of 'rig stage'
// that dipped nothing, are passed over.
struct BrokenRun {
  std::string name;  // "rig-3"
  std::vector<std::string> steps;
};
BrokenRun last_broken_run(const RigJob& job);

}  // namespace hydrodip
