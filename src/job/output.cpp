#include "job/output.h"

#include "image/files.h"
#include "job/prepare.h"
#include "job/resize.h"
#include "report/preview.h"

namespace hydrodip {
namespace {

// Large enough to look at closely, small enough for viewers on a phone.
constexpr int kTextureSide_px = 4096;

}  // namespace

Image write_previews(OutputFolder& folder, const JobRecord& record, const Image& film_image,
                     const SheetRaster& raster) {
  const DippedObject& dipped = record.dipped;
  const LinearColor base = base_color(record.config);
  write_film_ply(folder.path("film.ply"), dipped.film());

  PreviewOptions options;
  options.width_px = record.config.preview_width_px;
  options.caption = verdict(dipped.figures);
  options.base = base;
  const Image preview =
      render_preview(dipped.object(), *dipped.surface, dipped.film(),
                     appearance(dipped, film_image, raster, base), options, record.context);
  save_png(folder.path("preview.png"), preview);

  write_preview_glb(folder.path("preview.glb"), dipped.object(), dipped.film(),
                    shrink_to(film_image, kTextureSide_px), raster.width_mm, raster.height_mm,
                    base);
  return preview;
}

JobResult finish(OutputFolder& folder, const JobRecord& record) {
  record.context.check_cancelled();
  folder.commit();
  return describe_result(record, folder);
}

}  // namespace hydrodip
