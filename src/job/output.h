// The end of print and simulate: film and previews, report, and everything under its final name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/output_folder.h"
#include "job/job_record.h"
#include "job/jobs.h"
#include "report/report.h"

namespace hydrodip {

// What the report's page shows.
struct Previews {
  ReportPictures pictures;  // preview.png and maps.png, and the 3D view's scene
  std::optional<ReportColors> colors;
};

// Writes film.ply, preview.glb, preview.png, maps.png, and gamut.png if there is ink, for a film
// that carries `film_image` (as seen from above, over the whole sheet). Without config.pictures
// only the first two. The picture's caption is a short verdict after `caption_start`.
Previews write_previews(OutputFolder& folder, const JobRecord& record,
                        const std::string& caption_start = "");

// Writes report.json and report.html, then moves all files to their final names, unless the job was
// cancelled.
JobResult finish_job(OutputFolder& folder, const JobRecord& record, const Previews& previews);

// What a sheet lays of each ink, of a limit to their sum.
ReportInk ink_amounts(const InkImage& inks, double limit);

// What 'hydrodip rig jig' writes, into the folder jig of a print; its frame in one piece or in
// four.
std::vector<std::string> files_of_jig();

// What a job of several dips writes into the folder of each.
std::vector<std::string> files_of_dip();

// What prints of another number of dips put into the same folder, for OutputFolder::supersede():
// nobody shall print a sheet of an earlier job, hang an object up in its jig, or take its pictures
// for those of this one. 0: a single dip, in no folder of its own.
std::vector<std::string> sheets_of_other_prints(std::size_t dips);
// All that prints put into a folder: for what else is put there.
std::vector<std::string> prints();

}  // namespace hydrodip
