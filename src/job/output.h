// The end of print and simulate: film and previews, report, and everything under its final name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/output_folder.h"
#include "job/jobs.h"
#include "job/record.h"
#include "report/report.h"

namespace hydrodip {

// film.ply, preview.png, maps.png and preview.glb for a film that carries `film_image` (as seen
// from above, over the whole sheet). The picture's caption is a short verdict after
// `caption_start`. Returns the bytes of both pictures.
ReportPictures write_previews(OutputFolder& folder, const JobRecord& record,
                              const Image& film_image, const SheetRaster& raster,
                              const std::string& caption_start = "");

// What the report page's 3D view shows, and what is learnt on the way. Time it apart.
struct PageParts {
  std::string scene;
  std::optional<ReportColors> colors;
  std::optional<ReportInk> ink;
};
PageParts page_parts(const JobRecord& record, const Image& film_image, const SheetRaster& raster);

// Writes report.json and report.html, then moves all files to their final names, unless the job was
// cancelled.
JobResult finish(OutputFolder& folder, const JobRecord& record, ReportPictures pictures,
                 PageParts page);

}  // namespace hydrodip
