// The end of print and simulate: film and previews, report, and everything under its final name.
#pragma once

#include "job/record.h"

namespace hydrodip {

// film.ply, preview.png and preview.glb for a film that carries `film_image` (as seen from above,
// over the whole sheet). Returns the picture of preview.png.
Image write_previews(OutputFolder& folder, const JobRecord& record, const Image& film_image,
                     const SheetRaster& raster);

// Moves the files to their final names, unless the job was cancelled.
JobResult finish(OutputFolder& folder, const JobRecord& record);

}  // namespace hydrodip
