// What the report says of several dips.
#pragma once

#include <string>
#include <vector>

#include "job/finish_check.h"
#include "job/job_record.h"
#include "job/made_dips.h"
#include "plan/seams.h"
#include "report/report.h"

namespace hydrodip {

// On all dips together; `record` is of the first.
Report report_on(const MadeDips& all, const SharedSurface& shared, const FinishCheck& check,
                 const JobRecord& record);

// Every file, dip by dip: "dip-1/print.pdf".
std::vector<std::string> file_names(const MadeDips& all);

}  // namespace hydrodip
