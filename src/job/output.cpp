#include "job/output.h"

#include "base/file.h"
#include "image/files.h"
#include "job/prepare.h"
#include "job/resize.h"
#include "report/maps.h"
#include "report/preview.h"
#include "report/report.h"

namespace hydrodip {
namespace {

// Large enough to look at closely, small enough for viewers on a phone.
constexpr int kTextureSide_px = 4096;

std::vector<std::uint8_t> write_picture(const std::filesystem::path& path, const Image& image) {
  std::vector<std::uint8_t> png = encode_png(image);
  write_file(path, png.data(), png.size());
  return png;
}

Image draw_preview(const JobRecord& record, const Appearance& shown, const std::string& caption) {
  const DippedObject& dipped = record.dipped;
  PreviewOptions options;
  options.width_px = record.config.preview_width_px;
  options.caption = caption;
  options.base = base_color(record.config);
  return render_preview(dipped.object(), *dipped.surface, dipped.film(), shown, options,
                        record.context);
}

Image draw_maps(const JobRecord& record) {
  const DippedObject& dipped = record.dipped;
  MapOptions options;
  options.width_px = record.config.preview_width_px;
  options.tear_stretch = record.config.dip.material.tear_stretch;
  options.caption = map_caption(dipped.angles, &dipped.coverage);
  return render_maps(dipped.object(), *dipped.surface, dipped.film(), *dipped.map, options,
                     record.context);
}

}  // namespace

ReportPictures write_previews(OutputFolder& folder, const JobRecord& record,
                              const Image& film_image, const SheetRaster& raster,
                              const std::string& caption_start) {
  const DippedObject& dipped = record.dipped;
  const LinearColor base = base_color(record.config);
  write_film_ply(folder.path("film.ply"), dipped.film());

  ReportPictures pictures;
  pictures.preview_png = write_picture(
      folder.path("preview.png"), draw_preview(record, appearance(dipped, film_image, raster, base),
                                               caption_start + short_verdict(dipped.coverage)));
  pictures.maps_png = write_picture(folder.path("maps.png"), draw_maps(record));

  write_preview_glb(folder.path("preview.glb"), dipped.object(), dipped.film(),
                    shrink_to(film_image, kTextureSide_px), raster.width_mm, raster.height_mm,
                    base);
  return pictures;
}

JobResult finish(OutputFolder& folder, const JobRecord& record, const ReportPictures& pictures) {
  const Report report = make_report(record);
  write_report_json(folder.path("report.json"), report);
  write_report_html(folder.path("report.html"), report, pictures);
  record.context.check_cancelled();
  folder.commit();
  return describe_result(report, folder.folder());
}

}  // namespace hydrodip
