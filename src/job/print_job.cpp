#include "base/output_folder.h"
#include "base/parallel.h"
#include "job/dip_stage.h"
#include "job/jobs.h"
#include "job/output.h"
#include "job/prepare.h"
#include "job/record.h"
#include "sheet/sheet.h"

namespace hydrodip {
namespace {

SheetOptions sheet_options(const JobConfig& config) {
  SheetOptions sheet;
  sheet.width_mm = config.film.width_mm;
  sheet.height_mm = config.film.height_mm;
  sheet.margin_mm = config.film.margin_mm;
  sheet.dpi = config.print.dpi;
  sheet.disc = config.film.shape == FilmShape::kDisc;
  sheet.ink_side_up = config.print.ink_side == InkSide::kUp;
  sheet.job_name =
      config.print.job_name.empty() ? config.model.filename().string() : config.print.job_name;
  return sheet;
}

Image invert(const DippedObject& dipped, const JobConfig& config, RunContext& context) {
  InverseOptions options;
  options.bleed_mm = config.print.bleed_mm;
  options.samples_per_axis = config.print.samples;
  options.base = base_color(config);
  return film_image(dipped.object(), *dipped.map, sheet_raster(config, config.print.dpi), options,
                    context);
}

void compose(OutputFolder& folder, const Image& image, const JobConfig& config,
             RunContext& context) {
  const SheetOptions sheet = sheet_options(config);
  context.progress("writing print.png", 0);
  write_print_png(folder.path("print.png"), image, sheet);
  context.progress("writing print.tif", 0);
  write_print_tiff(folder.path("print.tif"), image, sheet);
  write_print_pdf(folder.path("print.pdf"), image, sheet, context);
}

}  // namespace

JobResult print_job(const JobConfig& config, RunContext& context) {
  const ThreadLimit threads(config.threads);
  OutputFolder folder(config.output);
  StageTimes times;

  const FilmMesh film = make_film_mesh(config.film);
  LoadedObject posed = times.measure("load", [&] { return load_posed(config, context); });
  const std::vector<ReportInput> inputs = describe_inputs(config, posed);
  require_appearance(posed.object, config.model);
  require_fit(posed.object, config, context);

  const auto dipped = dip_object(std::move(posed), film, config, times, context);
  const Image image = times.measure("invert", [&] { return invert(*dipped, config, context); });
  times.measure("sheet", [&] { compose(folder, image, config, context); });

  const JobRecord record{"print", config, inputs, *dipped, times, context};
  const ReportPictures pictures = times.measure("preview", [&] {
    return write_previews(folder, record, image, sheet_raster(config, config.print.dpi));
  });
  return finish(folder, record, pictures);
}

}  // namespace hydrodip
