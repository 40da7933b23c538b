#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/parallel.h"
#include "image/files.h"
#include "job/dip_stage.h"
#include "job/jobs.h"
#include "job/output.h"
#include "job/prepare.h"
#include "job/record.h"
#include "job/resize.h"

namespace hydrodip {
namespace {

// Image and sheet may differ this much in shape: rounding to whole pixels, a cut edge.
constexpr double kAspectTolerance = 0.01;
constexpr double kCheckerboardDpi = 100;

struct PrintedFilm {
  Image image;  // as seen from above, exactly raster's size
  SheetRaster raster;
};

void require_aspect(const Image& image, const JobConfig& config) {
  const double image_aspect = double(image.width_px) / image.height_px;
  const double sheet_aspect = config.film.width_mm / config.film.height_mm;
  if (std::abs(image_aspect / sheet_aspect - 1) <= kAspectTolerance) return;
  throw InputError(fmt::format(
      "{}: the image's {} x {} px do not have the shape of the {} x {} mm film; --film-image must "
      "show the whole sheet: choose the sheet with --film",
      config.film_image.string(), image.width_px, image.height_px, config.film.width_mm,
      config.film.height_mm));
}

// The resolution that gives the sheet the image's width; the recorded one if that does.
double image_dpi(const Image& image, double recorded, const JobConfig& config) {
  const double rounded = std::round(recorded);
  if (rounded > 0 && sheet_raster(config, rounded).width_px() == image.width_px) return rounded;
  return image.width_px * kMmPerInch / config.film.width_mm;
}

PrintedFilm read_film_image(const JobConfig& config) {
  const std::vector<std::uint8_t> bytes = read_file(config.film_image);
  PrintedFilm film;
  film.image = decode_image(bytes, config.film_image.string());
  require_aspect(film.image, config);
  film.raster = sheet_raster(config, image_dpi(film.image, recorded_dpi(bytes), config));
  if (film.image.width_px != film.raster.width_px() ||
      film.image.height_px != film.raster.height_px())
    film.image = resize(film.image, film.raster.width_px(), film.raster.height_px());
  if (config.print.ink_side == InkSide::kDown) film.image = mirrored(film.image);
  return film;
}

PrintedFilm printed_film(const JobConfig& config) {
  if (!config.film_image.empty()) return read_film_image(config);
  const SheetRaster raster = sheet_raster(config, kCheckerboardDpi);
  return {checkerboard(raster), raster};
}

}  // namespace

JobResult simulate_job(const JobConfig& config, RunContext& context) {
  const ThreadLimit threads(config.threads);
  OutputFolder folder(config.output);
  StageTimes times;

  const FilmMesh film = make_film_mesh(config.film);
  LoadedObject posed = times.measure("load", [&] { return load_posed(config, context); });
  const std::vector<ReportInput> inputs = describe_inputs(config, posed);
  require_fit(posed.object, config, context);
  const PrintedFilm printed = times.measure("film image", [&] { return printed_film(config); });

  const auto dipped = dip_object(std::move(posed), film, config, times, context);

  const JobRecord record{"simulate", config, inputs, *dipped, times, context};
  const ReportPictures pictures = times.measure("preview", [&] {
    return write_previews(folder, record, printed.image, printed.raster,
                          config.film_image.empty() ? "10 mm checkerboard on the film: " : "");
  });
  return finish(folder, record, pictures);
}

}  // namespace hydrodip
