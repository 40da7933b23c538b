// The sheet's page as a job has it.
#pragma once

#include "report/report.h"
#include "settings/config.h"
#include "sheet/sheet.h"

namespace hydrodip {

PrinterScale printer_of(const PrintOptions& print);

SheetOptions sheet_of(const JobConfig& config);
// With an alarm in the margin if it is not to be dipped like this.
SheetOptions sheet_of(const JobConfig& config, const Report& report);

}  // namespace hydrodip
