// The sheet as files.
#pragma once

#include <string>

#include "base/output_folder.h"
#include "image/pixel_set.h"
#include "ink/printer.h"
#include "sheet/sheet.h"

namespace hydrodip {

// print.png, print.tif and print.pdf, in a folder inside that one if `inside` names it ("dip-1/").
// `printed`: as Inking's. The inks turn into what they look like: move them here where nobody needs
// them any more, as a copy takes 4 bytes of memory an inked pixel.
void write_sheet_files(OutputFolder& folder, InkImage inks, const PixelSet& printed,
                       const Printer& printer, const SheetOptions& options,
                       const RunContext& context, const std::string& inside = "");

}  // namespace hydrodip
