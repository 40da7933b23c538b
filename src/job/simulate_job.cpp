#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/parallel.h"
#include "image/files.h"
#include "image/resize.h"
#include "ink/stiffness.h"
#include "job/dip_stage.h"
#include "job/ink_stage.h"
#include "job/jobs.h"
#include "job/output.h"
#include "job/prepare.h"
#include "job/record.h"
#include "sheet/sheet.h"

namespace hydrodip {
namespace {

// Image and sheet may differ this much in shape: rounding to whole pixels, a cut edge.
constexpr double kAspectTolerance = 0.01;
constexpr double kCheckerboardDpi = 100, kDraftDpi = 50;

struct PrintedFilm {
  InkImage inks;  // as seen from above, exactly raster's size
  SheetRaster raster;
};

void require_aspect(int width_px, int height_px, const JobConfig& config) {
  const double image_aspect = double(width_px) / height_px;
  const double sheet_aspect = config.film.width_mm / config.film.height_mm;
  if (std::abs(image_aspect / sheet_aspect - 1) <= kAspectTolerance) return;
  throw InputError(fmt::format(
      "{}: the image's {} x {} px do not have the shape of the {} x {} mm film; --film-image must "
      "show the whole sheet: choose the sheet with --film",
      config.film_image.string(), width_px, height_px, config.film.width_mm,
      config.film.height_mm));
}

// The resolution that gives the sheet the image's width; the recorded one if that does.
double image_dpi(int width_px, double recorded, const JobConfig& config) {
  const double rounded = std::round(recorded);
  if (rounded > 0 && sheet_raster(config, rounded).width_px() == width_px) return rounded;
  return width_px * kMmPerInch / config.film.width_mm;
}

bool is_tiff(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() > 4 &&
         ((bytes[0] == 'I' && bytes[1] == 'I') || (bytes[0] == 'M' && bytes[1] == 'M'));
}

// Cut or filled up with blank rows: rounding may cost or give one.
void fit_height(InkImage& inks, int height_px) {
  inks.cmyk.resize(std::size_t(4) * std::size_t(inks.width_px) * std::size_t(height_px), 0);
  inks.height_px = height_px;
}

// Inks as they are.
PrintedFilm read_ink_image(const JobConfig& config) {
  CmykFile file = read_cmyk_tiff(config.film_image);
  require_aspect(file.inks.width_px, file.inks.height_px, config);
  PrintedFilm film;
  film.raster = sheet_raster(config, image_dpi(file.inks.width_px, file.dpi, config));
  film.inks = std::move(file.inks);
  fit_height(film.inks, film.raster.height_px());
  if (config.print.ink_side == InkSide::kDown) film.inks = mirrored(film.inks);
  return film;
}

PrintedFilm read_film_image(const JobConfig& config, const ColorModel& model) {
  const std::vector<std::uint8_t> bytes = read_file(config.film_image);
  if (is_tiff(bytes)) return read_ink_image(config);
  PrintedFilm film;
  Image image = decode_image(bytes, config.film_image.string());
  require_aspect(image.width_px, image.height_px, config);
  film.raster = sheet_raster(config, image_dpi(image.width_px, recorded_dpi(bytes), config));
  if (image.width_px != film.raster.width_px() || image.height_px != film.raster.height_px())
    image = resize(image, film.raster.width_px(), film.raster.height_px());
  if (config.print.ink_side == InkSide::kDown) image = mirrored(image);
  film.inks = inks_of_film(image, model);
  return film;
}

PrintedFilm printed_film(const JobConfig& config, const ColorModel& model) {
  if (!config.film_image.empty()) return read_film_image(config, model);
  const SheetRaster raster = sheet_raster(config, config.pictures ? kCheckerboardDpi : kDraftDpi);
  return {inks_of_film(checkerboard(raster), model), raster};
}

// The checkerboard is there to show the stretch: it stiffens nothing, and does not pale.
void dip_with_ink(DippedObject& dipped, const SharedFilmMesh& film, const PrintedFilm& printed,
                  const JobConfig& config, StageTimes& times, RunContext& context) {
  DipOptions options = config.dip;
  if (!config.film_image.empty() && config.ink.rounds_max > 1)
    options.modulus = film_modulus(*film, printed.inks, printed.raster,
                                   {config.ink.stiffness_ratio, config.ink.filter_mm});
  dip_again(dipped, film, trajectory(dipped.object(), config), options, times, context);
}

Image seen_on_object(const DippedObject& dipped, const PrintedFilm& printed,
                     const ColorModel& model, const JobConfig& config, RunContext& context) {
  FilmStretch stretch = film_stretch(*dipped.map, printed.raster, 0, context);
  if (config.film_image.empty())
    std::fill(stretch.area_ratio.begin(), stretch.area_ratio.end(), 1.0F);
  return look_on_object(printed.inks, stretch.area_ratio, model, base_color(config));
}

}  // namespace

JobResult simulate_job(const JobConfig& config, RunContext& context) {
  const ThreadLimit threads(config.threads);
  OutputFolder folder(config.output);
  StageTimes times;

  const auto film = std::make_shared<const FilmMesh>(make_film_mesh(config.film));
  LoadedObject posed = times.measure("load", [&] { return load_posed(config, context); });
  const std::vector<ReportInput> inputs = describe_inputs(config, posed);
  require_fit(posed.object, config, context);
  const auto model = color_model(config);
  const PrintedFilm printed =
      times.measure("film image", [&] { return printed_film(config, *model); });

  const auto dipped = undipped(std::move(posed));
  dip_with_ink(*dipped, film, printed, config, times, context);

  const JobRecord record{"simulate", config,  inputs,  *dipped,
                         times,      context, nullptr, model->name()};
  const Image seen = times.measure(
      "look", [&] { return seen_on_object(*dipped, printed, *model, config, context); });
  const Previews previews = times.measure("preview", [&] {
    return write_previews(folder, record, seen, printed.raster,
                          config.film_image.empty() ? "10 mm checkerboard on the film: " : "");
  });
  return finish(folder, record, previews);
}

}  // namespace hydrodip
