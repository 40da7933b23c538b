// The sheet as files.
#pragma once

#include "base/output_folder.h"
#include "coat/design.h"
#include "ink/printer.h"
#include "sheet/sheet.h"

namespace hydrodip {

// print.png, print.tif and print.pdf.
void write_sheet_files(OutputFolder& folder, const FilmInk& ink, const Printer& printer,
                       const SheetOptions& options, const RunContext& context);

}  // namespace hydrodip
