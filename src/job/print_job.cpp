#include "base/file.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "ink/rgb_profile.h"
#include "job/dip_stage.h"
#include "job/ink_stage.h"
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

// For the printer's own RGB where its profile is given, else in sRGB.
void write_rgb_pdf(const std::filesystem::path& path, const Image& look, const JobConfig& config,
                   RunContext& context) {
  const std::filesystem::path& file = config.ink.profile;
  const std::vector<std::uint8_t> profile =
      file.empty() ? std::vector<std::uint8_t>() : read_file(file);
  if (!is_rgb_profile(profile))
    return write_print_pdf(path, look, srgb_profile(), sheet_options(config), context);
  write_print_pdf(path, in_printer_rgb(look, profile, file.string(), config.ink.intent), profile,
                  sheet_options(config), context);
}

void compose(OutputFolder& folder, const FilmInk& ink, const ColorModel& model,
             const JobConfig& config, RunContext& context) {
  const SheetOptions sheet = sheet_options(config);
  const InkImage& inks = ink.inking.inks;
  const Image look = look_on_film(inks, ink.wanted, model);
  const auto png = folder.path("print.png"), tiff = folder.path("print.tif"),
             pdf = folder.path("print.pdf");
  context.side_by_side("writing the sheet",
                       {[&] { write_print_tiff(tiff, inks, model.profile(), sheet); },
                        [&] {
                          if (config.print.color == PrintColor::kCmyk)
                            write_print_pdf(pdf, inks, model.profile(), sheet, context);
                          else
                            write_rgb_pdf(pdf, look, config, context);
                        },
                        [&] { write_print_png(png, look, sheet); }});
}

}  // namespace

JobResult print_job(const JobConfig& config, RunContext& context) {
  const RunScope scope(context.with_threads(config.threads));
  OutputFolder folder(config.output);
  StageTimes times;

  const FilmMesh film = make_film_mesh(config.film);
  LoadedObject posed = times.measure("load", [&] { return load_posed(config, context); });
  const std::vector<ReportInput> inputs = describe_inputs(config, posed);
  require_appearance(posed.object, config.model);
  require_fit(posed.object, config, context);

  const auto model = color_model(config);

  const auto dipped = undipped(std::move(posed));
  const InkResult result = settle_ink(*dipped, film, *model, config, times, context);
  times.measure("sheet", [&] { compose(folder, result.ink, *model, config, context); });

  const JobRecord record{"print", config, inputs, *dipped, times, context, &result, model->name()};
  const SheetRaster raster = sheet_raster(config, config.print.dpi);
  const Image& image = result.ink.on_object;
  const Previews previews =
      times.measure("preview", [&] { return write_previews(folder, record, image, raster); });
  return finish(folder, record, previews);
}

}  // namespace hydrodip
