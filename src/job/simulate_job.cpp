#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/file.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "image/files.h"
#include "image/resize.h"
#include "ink/stiffness.h"
#include "job/computed.h"
#include "job/job_record.h"
#include "job/jobs.h"
#include "job/output.h"
#include "job/print_dips.h"
#include "job/sheet_of.h"
#include "job/wanted.h"
#include "job/ways.h"
#include "report/findings.h"
#include "session/sheet_files.h"
#include "sheet/sheet.h"

namespace hydrodip {
namespace {

// Image and sheet may differ this much in shape: rounding to whole pixels, a cut edge.
constexpr double kAspectTolerance = 0.01;
constexpr double kCheckerboardDpi = 100, kDraftDpi = 50;
constexpr double kCheckerCell_mm = 10;

struct PrintedFilm {
  InkImage inks;  // as seen from above, exactly raster's size
  SheetRaster raster;
};

void require_aspect(int width_px, int height_px, const JobConfig& config) {
  const double image_aspect = double(width_px) / height_px;
  const double sheet_aspect = config.design.film.width_mm / config.design.film.height_mm;
  if (std::abs(image_aspect / sheet_aspect - 1) <= kAspectTolerance) return;
  throw InputError(fmt::format(
      "{}: the image's {} x {} px do not have the shape of the {} x {} mm film; --film-image must "
      "show the whole sheet: choose the sheet with --film",
      config.film_image.string(), width_px, height_px, config.design.film.width_mm,
      config.design.film.height_mm));
}

// The resolution that gives the sheet the image's width; the recorded one if that does.
double image_dpi(int width_px, double recorded, const JobConfig& config) {
  const double rounded = std::round(recorded);
  if (rounded > 0 && raster_of(config.design.film, rounded).width_px() == width_px) return rounded;
  return width_px * kMmPerInch / config.design.film.width_mm;
}

// Left and right changed: the film as seen from above, when the ink lies on its underside. Both
// kinds of image have 4 bytes a pixel.
template <class Pixels>
Pixels mirrored(const Pixels& image) {
  Pixels result(image.width_px, image.height_px);
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x)
      std::copy_n(image.pixel(image.width_px - 1 - x, y), 4, result.pixel(x, y));
  return result;
}

// Over the whole sheet: makes the film's stretch visible.
Image checkerboard(const SheetRaster& raster) {
  constexpr std::uint8_t kDark[4] = {38, 84, 124, 255};
  constexpr std::uint8_t kLight[4] = {255, 255, 255, 255};
  Image image(raster.width_px(), raster.height_px());
  const auto cell = [](double at_mm) { return long(std::floor(at_mm / kCheckerCell_mm)); };
  std::vector<long> column(std::size_t(image.width_px));
  for (int x = 0; x < image.width_px; ++x)
    column[std::size_t(x)] = cell(raster.to_film(x + 0.5, 0.5).x());
  for (int y = 0; y < image.height_px; ++y) {
    const long row = cell(raster.to_film(0.5, y + 0.5).y());
    for (int x = 0; x < image.width_px; ++x)
      std::copy_n((column[std::size_t(x)] + row) % 2 != 0 ? kDark : kLight, 4, image.pixel(x, y));
  }
  return image;
}

// Inks are not mixed: each row is the one that lies there.
InkImage with_height(InkImage inks, int height_px) {
  if (inks.height_px == height_px) return inks;
  InkImage result(inks.width_px, height_px);
  for (int y = 0; y < height_px; ++y) {
    const int from = int((y + 0.5) * inks.height_px / height_px);
    std::copy_n(inks.pixel(0, from), 4 * inks.width_px, result.pixel(0, y));
  }
  return result;
}

// Two profiles may have been made at other times, and are the same all the same.
bool same_profile(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  constexpr std::size_t kHeader = 128;
  return a.size() == b.size() && a.size() > kHeader &&
         std::equal(a.begin() + kHeader, a.end(), b.begin() + kHeader);
}

// What draws and photographs records one of these whatever the size.
bool means_nothing(double dpi) { return std::abs(dpi - 72) < 0.5 || std::abs(dpi - 96) < 0.5; }

// A finished sheet knows how large it is.
void warn_of_other_size(int width_px, int height_px, double recorded_dpi, const JobConfig& config,
                        const RunContext& context) {
  constexpr double kSame = 0.02;
  if (!(recorded_dpi > 0) || means_nothing(recorded_dpi)) return;
  const double width_mm = width_px * kMmPerInch / recorded_dpi;
  const FilmOptions& film = config.design.film;
  if (std::abs(width_mm / film.width_mm - 1) < kSame) return;
  context.warn(fmt::format(
      "{} says that it is {:.1f} x {:.1f} mm; it is printed {:.1f} mm wide, as the film is: check "
      "--film.",
      config.film_image.string(), width_mm, height_px * kMmPerInch / recorded_dpi, film.width_mm));
}

// Inks as they are.
PrintedFilm read_ink_image(const JobConfig& config, const ColorModel& model,
                           const RunContext& context) {
  CmykFile file = read_cmyk_tiff(config.film_image);
  if (!file.profile.empty() && !same_profile(file.profile, model.profile()))
    context.warn(fmt::format(
        "{}: its inks are for another printer's profile than this job's ({}): what they look like "
        "is reckoned by the job's. Name the profile that it was made for with --printer-profile.",
        config.film_image.string(), model.name()));
  require_aspect(file.inks.width_px, file.inks.height_px, config);
  warn_of_other_size(file.inks.width_px, file.inks.height_px, file.dpi, config, context);
  PrintedFilm film;
  film.raster = raster_of(config.design.film, image_dpi(file.inks.width_px, file.dpi, config));
  film.inks = with_height(std::move(file.inks), film.raster.height_px());
  if (config.print.ink_side == InkSide::kDown) film.inks = mirrored(film.inks);
  return film;
}

PrintedFilm read_film_image(const JobConfig& config, const ColorModel& model,
                            const RunContext& context) {
  if (is_ink_tiff(config.film_image)) return read_ink_image(config, model, context);
  const std::vector<std::uint8_t> bytes = read_file(config.film_image);
  PrintedFilm film;
  Image image = decode_image(bytes, config.film_image.string());
  require_aspect(image.width_px, image.height_px, config);
  warn_of_other_size(image.width_px, image.height_px, recorded_dpi(bytes), config, context);
  film.raster =
      raster_of(config.design.film, image_dpi(image.width_px, recorded_dpi(bytes), config));
  if (image.width_px != film.raster.width_px() || image.height_px != film.raster.height_px())
    image = resize(image, film.raster.width_px(), film.raster.height_px());
  if (config.print.ink_side == InkSide::kDown) image = mirrored(image);
  film.inks = inks_of_film(image, model);
  return film;
}

PrintedFilm printed_film(const JobConfig& config, const ColorModel& model,
                         const RunContext& context) {
  if (!config.film_image.empty()) return read_film_image(config, model, context);
  const SheetRaster raster =
      raster_of(config.design.film, config.pictures ? kCheckerboardDpi : kDraftDpi);
  return {inks_of_film(checkerboard(raster), model), raster};
}

// The checkerboard is there to show the stretch: it stiffens nothing, and does not pale.
DipOptions dip_options(const FilmMesh& film, const PrintedFilm& printed, const JobConfig& config) {
  DipOptions options = config.design.dip;
  if (!config.film_image.empty() && config.design.rounds_max > 1)
    options.modulus = film_modulus(film, printed.inks, printed.raster, config.design.stiffness);
  return options;
}

Image seen_on_object(const DippedObject& dipped, const PrintedFilm& printed,
                     const ColorModel& model, const LinearColor& base, bool pales,
                     const RunContext& context) {
  FilmStretch stretch = film_stretch(*dipped.map, printed.raster, 0, context);
  if (!pales) stretch.area_ratio = BlankArray<float>(stretch.area_ratio.size());
  return look_on_object(printed.inks, stretch.area_ratio, model, base);
}

// The rim is taped, and the sheet's marks stand there.
void clear_margin(PrintedFilm& printed, const FilmOptions& film, const RunContext& context) {
  bool cleared = false;
  for (int y = 0; y < printed.inks.height_px; ++y) {
    context.check_cancelled();
    for (int x = 0; x < printed.inks.width_px; ++x) {
      std::uint8_t* laid = printed.inks.pixel(x, y);
      if (is_free(film, printed.raster.to_film(x + 0.5, y + 0.5)) || is_blank(laid)) continue;
      std::fill_n(laid, 4, std::uint8_t{0});
      cleared = true;
    }
  }
  if (cleared)
    context.warn(fmt::format(
        "The film image reaches into the {:g} mm that are taped; what lies there is not printed.",
        film.margin_mm));
}

// The sheet as it was given, with marks.
void write_given_sheet(OutputFolder& folder, PrintedFilm printed, const Printer& printer,
                       SheetOptions sheet, const RunContext& context) {
  const InkImage& inks = printed.inks;
  PixelSet inked(inks.width_px, inks.height_px);
  for (int y = 0; y < inks.height_px; ++y) {
    context.check_cancelled();
    for (int x = 0; x < inks.width_px; ++x)
      if (!is_blank(inks.pixel(x, y))) inked.insert(x, y);
  }
  sheet.dpi = printed.raster.dpi;
  write_sheet_files(folder, std::move(printed.inks), inked, printer, sheet, context);
}

SimulatedJob dipped_with(const PrintedFilm& printed, const ReadyJob& job,
                         const SharedFilmMesh& film, Timings& times, const RunContext& context) {
  const JobConfig& config = job.config;
  DippedObject dipped =
      dip_object(job.prepared.posed, film, job.trajectory, dip_options(*film, printed, config),
                 times, context, {}, {.options = config.design.air, .found = {}});
  Image seen = times.measure("look", [&] {
    return seen_on_object(dipped, printed, *job.printer.model, job.prepared.paint->base(),
                          !config.film_image.empty(), context);
  });
  Finish finish(job.prepared.paint,
                {{dipped, printed.raster, std::make_shared<const Image>(std::move(seen))}});
  return {std::move(dipped), std::move(finish)};
}

JobResult forward_job(const std::string& command, const JobConfig& given,
                      const RunContext& context) {
  const RunScope scope(context.with_threads(given.threads));
  OutputFolder folder(given.output, given.earlier_result);
  Timings times;

  const auto film = std::make_shared<const FilmMesh>(make_film_mesh(given.design.film));
  const ReadyJob job = make_ready(given, false, times, context);
  const JobConfig& config = job.config;
  const std::vector<ReportInput> inputs = describe_inputs(config, job.prepared, job.printer);
  announce_outputs(folder, command, config, inputs);
  folder.supersede(makes_sheet(command) ? sheets_of_other_prints(0) : prints());
  PrintedFilm printed = times.measure("film image", [&] {
    PrintedFilm film_image = printed_film(config, *job.printer.model, context);
    if (makes_sheet(command)) clear_margin(film_image, config.design.film, context);
    return film_image;
  });
  const SimulatedJob made = dipped_with(printed, job, film, times, context);

  JobRecord record{command, config,      job.prepared,
                   inputs,  made.finish, times,
                   context, nullptr,     job.printer.model->name()};
  if (config.film_image.empty()) {
    warn_of(dry_layers(job.prepared.artwork, made.dipped), context);
    record.wanted = wanted_coverage(made.dipped, *job.prepared.paint,
                                    doubtful_stretch(config.design.dip.material));
  } else {
    record.laid = ink_amounts(printed.inks, config.design.inking.limit);
  }
  const Report first_look = make_report(record);
  if (config.plan.suggest && concern_of(findings(first_look)) == Concern::kStop)
    record.better_way = times.measure("find", [&] {
      return better_way(config, job.prepared, made.dipped, record.wanted, context);
    });
  if (makes_sheet(command))
    times.measure("sheet", [&] {
      write_given_sheet(folder, std::move(printed), job.printer,
                        sheet_of(config, job.prepared.posed, first_look), context);
    });
  const Previews previews = times.measure("preview", [&] {
    return write_previews(folder, record,
                          config.film_image.empty() ? "10 mm checkerboard on the film: " : "");
  });
  return finish_job(folder, record, previews);
}

}  // namespace

SimulatedJob simulated(const ReadyJob& job, const SharedFilmMesh& film, Timings& times,
                       const RunContext& context) {
  const PrintedFilm printed = times.measure(
      "film image", [&] { return printed_film(job.config, *job.printer.model, context); });
  return dipped_with(printed, job, film, times, context);
}

JobResult simulate_job(const JobConfig& config, const RunContext& context) {
  require_one_dip(config, "simulate makes one dip; 'hydrodip print' makes them all");
  return forward_job("simulate", config, context);
}

JobResult print_film_image_job(const JobConfig& config, const RunContext& context) {
  if (config.design.film.correction)
    throw InputError(
        "film.correction: --film-image is printed as it is; leave one of them out, or print the "
        "model with the correction");
  if (asks_for_several_dips(config))
    throw InputError(
        "--film-image is the finished sheet of one dip, and this job has several: leave it out, or "
        "--dips and the job's [[dip]] tables");
  return forward_job("print", config, context);
}

}  // namespace hydrodip
