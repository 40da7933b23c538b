#include "job/ink_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "ink/stiffness.h"
#include "job/prepare.h"

namespace hydrodip {
namespace {

// Whether film tears, and whether the last triangle at the rim touches, is yes or no: where that is
// undecided, two rounds can disagree forever. After so many rounds, when the ink has all but found
// its place, tears and the outline of what stiffens the film stay as they are.
constexpr int kFreeRounds = 3;
// From then on a round has to bring the change below this share of the last one's.
constexpr double kLeastProgress = 0.7;
// Where more of the film tears than this share of what meets the object, the dip is to be planned
// anew, and what the ink does to it is not worth a round of minutes.
constexpr double kHopelessShare = 0.2;
// While ink and film settle, the film image need only be as fine as stiffness can tell: several
// pixels to a millimetre.
constexpr double kRoundsDpi = 150;

// Of the film that lies on the object in both. What floats on or has torn off leaves no trace.
double mean_way(const DippedFilm& from, const DippedFilm& to) {
  std::vector<std::uint8_t> counts(from.position.size(), 0);
  for (std::size_t t = 0; t < from.mesh.triangles.size(); ++t)
    if (from.lies_on_object(t) && to.lies_on_object(t))
      for (const std::int32_t v : from.mesh.triangles[t]) counts[std::size_t(v)] = 1;
  double sum = 0, count = 0;
  for (std::size_t v = 0; v < counts.size(); ++v) {
    if (!counts[v]) continue;
    sum += (to.position[v] - from.position[v]).norm();
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

double printed_area_mm2(const Image& wanted, double dpi) {
  double pixels = 0;
  for (std::size_t i = 3; i < wanted.rgba.size(); i += 4) pixels += wanted.rgba[i] / 255.0;
  return pixels * (kMmPerInch / dpi) * (kMmPerInch / dpi);
}

double mean_of(const std::vector<double>& values) {
  if (values.empty()) return 1;
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

// Half way, in the measure in which stiffness matters.
void damp(const std::vector<double>& before, std::vector<double>& modulus) {
  for (std::size_t t = 0; t < before.size(); ++t) modulus[t] = std::sqrt(before[t] * modulus[t]);
}

// The ink that stiffens the film: what is printed, later within a fixed outline.
class StiffeningInk {
 public:
  const InkImage& now(const FilmInk& ink, bool keep_outline) {
    if (!keep_outline) {
      inks_ = ink.inking.inks;
      outline_ = ink.wanted;
      return inks_;
    }
    for (std::size_t i = 0; i < inks_.cmyk.size(); i += 4) {
      if (outline_.rgba[i + 3] == 0 || ink.wanted.rgba[i + 3] == 0) continue;
      std::copy_n(ink.inking.inks.cmyk.begin() + std::ptrdiff_t(i), 4,
                  inks_.cmyk.begin() + std::ptrdiff_t(i));
    }
    return inks_;
  }

 private:
  InkImage inks_;
  Image outline_;
};

bool ink_matters(const JobConfig& config) {
  return config.ink.stiffness_ratio > 1 && config.dip.method != DipMethod::kProjection;
}

InverseOptions inverse_options(const JobConfig& config) {
  InverseOptions options;
  options.bleed_mm = config.print.bleed_mm;
  options.samples_per_axis = config.print.samples;
  options.base = base_color(config);
  return options;
}

InkingOptions inking_options(const JobConfig& config) {
  InkingOptions options;
  options.compensate = config.ink.compensate;
  options.policy = config.gamut_policy;
  options.limit = config.ink.limit;
  options.base = base_color(config);
  return options;
}

void warn_unsettled(const InkResult& result, RunContext& context) {
  if (result.settled || result.rounds.size() < 2) return;
  context.warn(fmt::format(
      "after {} rounds the ink still moves the film by {:.2g} mm on average (settled: {:g} mm); "
      "raise ink.rounds_max, or film.elements if it does not help",
      result.rounds.size(), result.rounds.back().change_mm, kSettled_mm));
}

}  // namespace

std::unique_ptr<ColorModel> color_model(const JobConfig& config) {
  std::filesystem::path file = config.ink.profile;
  if (file.empty() && config.ink.model == InkModel::kDevice) return make_device_model();
  if (file.empty()) file = installed_cmyk_profile();
  if (file.empty())
    throw InputError(
        "ink.model: no CMYK profile is installed on this machine; name one with --printer-profile, "
        "install Debian's libgs-common, or set ink.model=device");
  return make_profile_model(read_file(file), file.string(), config.ink.intent);
}

FilmInk ink_for(const DippedObject& dipped, const ColorModel& model, const JobConfig& config,
                RunContext& context) {
  const SheetRaster raster = sheet_raster(config, config.print.dpi);
  FilmInk ink;
  ink.wanted = film_image(dipped.object(), *dipped.map, raster, inverse_options(config), context);
  ink.stretch = film_stretch(*dipped.map, raster, config.print.bleed_mm, context);
  ink.inking = ink_film(ink.wanted, ink.stretch.area_ratio, model, inking_options(config), context);
  return ink;
}

InkResult settle_ink(DippedObject& dipped, const FilmMesh& film, const ColorModel& model,
                     const JobConfig& config, StageTimes& times, RunContext& context) {
  JobConfig rounds_config = config;
  rounds_config.print.dpi = std::min(config.print.dpi, kRoundsDpi);
  const SheetRaster raster = sheet_raster(rounds_config, rounds_config.print.dpi);
  const bool iterate = ink_matters(config) && config.ink.rounds_max > 1;
  DipOptions options = config.dip;
  InkResult result;
  std::optional<DippedFilm> before;
  StiffeningInk stiffening;
  while (true) {
    InkRound round;
    round.tears_kept = !options.tear_levels.empty();
    dip_again(dipped, film, options, times, context);
    result.ink =
        times.measure("ink", [&] { return ink_for(dipped, model, rounds_config, context); });

    if (before) round.change_mm = mean_way(*before, dipped.film());
    round.printed_mm2 = printed_area_mm2(result.ink.wanted, rounds_config.print.dpi);
    round.mean_modulus = mean_of(options.modulus);
    round.dip = dipped.dip.statistics;
    const double last_change = result.rounds.empty() ? 0 : result.rounds.back().change_mm;
    result.rounds.push_back(round);
    if (before)
      context.log(fmt::format("ink, round {}: the film moved by {:.2g} mm on average",
                              result.rounds.size(), round.change_mm));

    result.settled = !iterate || (before && round.change_mm < kSettled_mm);
    if (result.settled || int(result.rounds.size()) >= config.ink.rounds_max) break;
    if (dipped.coverage.torn_share() > kHopelessShare) {
      context.warn(
          "so much film tears that the dip was not computed again with its ink; turn steep sides "
          "down or dip less, then print anew");
      break;
    }
    // Film that tears differently every time does not settle, and each round costs a dip.
    if (int(result.rounds.size()) > kFreeRounds && last_change > 0 &&
        round.change_mm > kLeastProgress * last_change)
      break;
    const bool settle = int(result.rounds.size()) >= kFreeRounds;
    if (settle && options.tear_levels.empty()) options.tear_levels = dipped.film().tear_level;
    const InkImage& inks = stiffening.now(result.ink, int(result.rounds.size()) > kFreeRounds);
    std::vector<double> modulus = times.measure("stiffness", [&] {
      return film_modulus(film, inks, raster, {config.ink.stiffness_ratio, config.ink.filter_mm});
    });
    if (last_change > 0 && round.change_mm > last_change) damp(options.modulus, modulus);
    options.modulus = std::move(modulus);
    before = dipped.film();
  }
  warn_unsettled(result, context);
  if (rounds_config.print.dpi < config.print.dpi)
    result.ink = times.measure("invert", [&] { return ink_for(dipped, model, config, context); });
  result.ink.on_object = look_on_object(result.ink.inking.inks, result.ink.stretch.area_ratio,
                                        model, base_color(config));
  result.reach = measure_reach(result.ink.wanted, result.ink.on_object, result.ink.stretch,
                               sheet_raster(config, config.print.dpi));
  return result;
}

}  // namespace hydrodip
