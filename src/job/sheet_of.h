// The sheet's page as a job has it.
#pragma once

#include "settings/config.h"
#include "sheet/sheet.h"

namespace hydrodip {

SheetOptions sheet_of(const JobConfig& config);

}  // namespace hydrodip
