// The sheet that several parts share, as it is printed: every piece in its place, with lines to cut
// along, ticks for the object's middle, and the part's name.
#pragma once

#include "ink/discoloration.h"
#include "job/nest.h"
#include "settings/config.h"
#include "sheet/sheet.h"
#include "transfer/raster.h"

namespace hydrodip {

// All pieces' ink on one film image. The parts are made.
Inking whole_sheet(const Nest& nest, const SheetRaster& sheet);

// Its page; the margin names the pieces that are not to be dipped.
SheetOptions sheet_of(const JobConfig& config, const Nest& nest);

}  // namespace hydrodip
