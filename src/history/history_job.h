// The command behind `hydrodip history`.
#pragma once

#include <optional>
#include <string>

#include "history/history.h"
#include "job/jobs.h"
#include "rig/link.h"
#include "rig/rig_job.h"

namespace hydrodip {

struct HistoryRequest {
  bool add = false;        // a dip that was made without `rig guide`
  std::string amend_run;   // whose fields are corrected; empty: none
  std::string remove_run;  // that was added by mistake; empty: none
  RunFields fields;
  std::string batch_only;    // shows this batch; empty: all
  std::string settings_run;  // whose report.json is wanted, and nothing else; empty: none
};

// What one dip uses, by the sheet that it was dipped with and what was weighed, and what that costs
// at the job's prices.
struct DipUse {
  double film_m2 = 0;
  std::optional<double> ink_ml = 0;  // nothing if its print does not say how much is laid
  double activator_g = 0;
  double cost = 0;  // without ink that is not known
};
DipUse use_of(const DipRun& run, const SheetUse& sheet, const CostOptions& cost);

// Every dip with its readings; what was used; what a good piece costs, with those that failed
// charged to it, without those that nobody has judged. Changes what the request says first.
JobResult history_job(const RigJob& job, const HistoryRequest& request, Clock& clock);

}  // namespace hydrodip
