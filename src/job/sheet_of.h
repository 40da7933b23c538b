// The sheet's page as a job has it.
#pragma once

#include "settings/config.h"
#include "sheet/sheet.h"
#include "transfer/coverage.h"

namespace hydrodip {

SheetOptions sheet_of(const JobConfig& config);
// With an alarm in the margin if it is not to be dipped like this.
SheetOptions sheet_of(const JobConfig& config, const Coverage& coverage);

}  // namespace hydrodip
