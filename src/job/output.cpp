#include "job/output.h"

#include "base/file.h"
#include "image/files.h"
#include "job/prepare.h"
#include "job/resize.h"
#include "report/preview.h"
#include "report/report.h"

namespace hydrodip {
namespace {

// Large enough to look at closely, small enough for viewers on a phone.
constexpr int kTextureSide_px = 4096;

}  // namespace

std::vector<std::uint8_t> write_previews(OutputFolder& folder, const JobRecord& record,
                                         const Image& film_image, const SheetRaster& raster,
                                         const std::string& caption_start) {
  const DippedObject& dipped = record.dipped;
  const LinearColor base = base_color(record.config);
  write_film_ply(folder.path("film.ply"), dipped.film());

  PreviewOptions options;
  options.width_px = record.config.preview_width_px;
  options.caption = caption_start + short_verdict(dipped.coverage);
  options.base = base;
  const std::vector<std::uint8_t> preview = encode_png(
      render_preview(dipped.object(), *dipped.surface, dipped.film(),
                     appearance(dipped, film_image, raster, base), options, record.context));
  write_file(folder.path("preview.png"), preview.data(), preview.size());

  write_preview_glb(folder.path("preview.glb"), dipped.object(), dipped.film(),
                    shrink_to(film_image, kTextureSide_px), raster.width_mm, raster.height_mm,
                    base);
  return preview;
}

JobResult finish(OutputFolder& folder, const JobRecord& record,
                 const std::vector<std::uint8_t>& preview_png) {
  const Report report = make_report(record);
  write_report_json(folder.path("report.json"), report);
  write_report_html(folder.path("report.html"), report, preview_png);
  record.context.check_cancelled();
  folder.commit();
  return describe_result(report, folder.folder());
}

}  // namespace hydrodip
