// The sheet as files.
#pragma once

#include "base/output_folder.h"
#include "coat/design.h"
#include "ink/printer.h"
#include "sheet/sheet.h"

namespace hydrodip {

// print.png, print.tif and print.pdf, in a folder inside that one if `inside` names it ("dip-1/").
void write_sheet_files(OutputFolder& folder, const FilmInk& ink, const Printer& printer,
                       const SheetOptions& options, const RunContext& context,
                       const std::string& inside = "");

}  // namespace hydrodip
