// The sheet's page as a job has it.
#pragma once

#include "object/posed_object.h"
#include "report/report.h"
#include "settings/config.h"
#include "sheet/sheet.h"

namespace hydrodip {

PrinterScale printer_of(const PrintOptions& print);

// Whether the command's result is a sheet to print: "print", "pattern".
bool makes_sheet(const std::string& command);

// What the margin says of a draft; empty of a design that is none.
std::string draft_alarm(const DesignOptions& options);

SheetOptions sheet_of(const JobConfig& config);
// With the outlines of a dip, if they are asked for.
SheetOptions sheet_of(const JobConfig& config, const PosedObject& posed);
// With an alarm in the margin too, if it is not to be dipped like this.
SheetOptions sheet_of(const JobConfig& config, const PosedObject& posed, const Report& report);

}  // namespace hydrodip
