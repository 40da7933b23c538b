#include "job/ink_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "coupling/fixed_point.h"
#include "ink/rgb_profile.h"
#include "ink/stiffness.h"
#include "job/prepare.h"

namespace hydrodip {
namespace {

// Whether film tears, and whether the last triangle at the rim touches, is yes or no: where that is
// undecided, two rounds can disagree forever. After so many rounds, of which the last knew the ink
// all but in its place, film tears where and when it did, and what is printed keeps its outline.
// Then a dip changes smoothly with its ink.
constexpr int kFreeRounds = 2;
// And then the next ink can be guessed from so many rounds and the last one.
constexpr int kMixed = 2;
// All four inks at once make film so many times as stiff as one alone.
constexpr double kMostInks = 4;
// From there on two rounds have to bring the change below this share.
constexpr double kLeastProgress = 0.5;
// Film that its first ink moves so far on average hangs in flaps that fall another way every time.
constexpr double kHopeless_mm = 2;
// Film torn to flaps or stretched too far may have no equilibrium that can be found once ink
// stiffens it. A dip that fails in more than this share of its steps is to be planned anew.
constexpr double kFailedSteps = 0.02;
// While ink and film settle, the film image need only be as fine as stiffness can tell: several
// pixels to a millimetre.
constexpr double kRoundsDpi = 150;

// Flaps are foreseen on film of so many times fewer triangles, but at least so many, in steps that
// are so many times longer, up to a length; the print need not be finer than such triangles.
constexpr int kFewer = 4;
constexpr int kFewestElements = 2000;
constexpr double kLonger = 4;
constexpr double kLongestStep_mm = 1;
constexpr double kCoarseDpi = 75;

// Of the film that lies on the object in both. What floats on or has torn off leaves no trace.
double mean_way(const DippedFilm& from, const DippedFilm& to) {
  std::vector<std::uint8_t> counts(from.position.size(), 0);
  for (std::size_t t = 0; t < from.mesh().triangles.size(); ++t)
    if (from.lies_on_object(t) && to.lies_on_object(t))
      for (const std::int32_t v : from.mesh().triangles[t]) counts[std::size_t(v)] = 1;
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

// The film that is printed on: what lies on the object, and from some round on the same triangles
// every time.
class PrintedOutline {
 public:
  bool is_kept() const { return !kept_.empty(); }

  void keep(const DippedFilm& film) {
    for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t)
      kept_.push_back(film.lies_on_object(t));
  }

  // The film as if just the kept triangles lay on the object; `and_others`: besides those that do.
  // A corner that just misses the object counts as touching it.
  DippedFilm applied(const DippedFilm& film, const Surface& surface, bool and_others) const {
    DippedFilm result = film;
    for (std::size_t t = 0; t < kept_.size(); ++t) {
      if (!kept_[t] || film.torn[t]) continue;
      for (const std::int32_t v : film.mesh().triangles[t])
        if (film.state[std::size_t(v)] == VertexState::kUnattached &&
            surface.closest_point(film.position[std::size_t(v)], film.mesh().cell_mm))
          result.state[std::size_t(v)] = VertexState::kAttached;
    }
    for (std::size_t t = 0; t < kept_.size(); ++t)
      if (!kept_[t] && !(and_others && film.lies_on_object(t))) result.torn[t] = 1;
    return result;
  }

 private:
  std::vector<std::uint8_t> kept_;
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

FilmInk ink_for(const DippedObject& dipped, const FilmMap& map, const ColorModel& model,
                const JobConfig& config, RunContext& context) {
  const SheetRaster raster = sheet_raster(config, config.print.dpi);
  FilmInk ink;
  ink.wanted = film_image(dipped.object(), map, raster, inverse_options(config), context);
  ink.stretch = film_stretch(map, raster, config.print.bleed_mm, context);
  ink.inking = ink_film(ink.wanted, ink.stretch.area_ratio, model, inking_options(config), context);
  return ink;
}

// What rounds of ink are about.
struct InkSetting {
  DippedObject& dipped;
  const SharedFilmMesh& film;  // config.film's
  const ColorModel& model;
  const JobConfig& config;
  StageTimes& times;
  RunContext& context;
};

// What a round has led to.
enum class Outcome { kGoesOn, kSettled, kUnsettled, kHopeless, kFailed };

// Dip, print, stiffen, and again.
class InkRounds {
 public:
  explicit InkRounds(const InkSetting& setting)
      : set_(setting), config_(setting.config), options_(setting.config.dip) {
    config_.print.dpi = std::min(config_.print.dpi, kRoundsDpi);
  }

  // Of the first film; blank unless told.
  void begin_with(std::vector<double> modulus) { options_.modulus = std::move(modulus); }

  Outcome next() {
    if (number() > 0) stiffen();
    if (!dip()) return Outcome::kFailed;
    ink_ = set_.times.measure("ink", [&] { return print(config_, false); });
    judge();
    return outcome();
  }

  const std::vector<InkRound>& rounds() const { return rounds_; }

  // That the ink of the last round gives to a film.
  std::vector<double> modulus_of(const FilmMesh& film) const {
    return film_modulus(film, ink_.inking.inks, sheet_raster(config_, config_.print.dpi),
                        {config_.ink.stiffness_ratio, config_.ink.filter_mm});
  }

  // What to print on the film as it was dipped last; `all`: wherever it lies on the object.
  FilmInk print(const JobConfig& config, bool all) const {
    if (!outline_.is_kept())
      return ink_for(set_.dipped, *set_.dipped.map, set_.model, config, set_.context);
    const DippedFilm kept = outline_.applied(set_.dipped.film(), *set_.dipped.surface, all);
    const FilmMap map(set_.dipped.object(), *set_.dipped.surface, kept);
    return ink_for(set_.dipped, map, set_.model, config, set_.context);
  }

 private:
  int number() const { return int(rounds_.size()); }

  // False if the film cannot be dipped with its ink: then the last dip stays.
  bool dip() {
    if (number() > 0) before_ = set_.dipped.film();
    options_.failed_share_max = options_.modulus.empty() ? 1 : kFailedSteps;
    try {
      dip_again(set_.dipped, set_.film, trajectory(set_.dipped.object(), config_), options_,
                set_.times, set_.context);
    } catch (const DipError&) {
      if (options_.modulus.empty()) throw;
      return false;
    }
    return true;
  }

  // Records the round.
  void judge() {
    InkRound round;
    round.tears_kept = !options_.tears_at_mm.empty();
    if (before_) round.change_mm = mean_way(*before_, set_.dipped.film());
    round.printed_mm2 = printed_area_mm2(ink_.wanted, config_.print.dpi);
    round.mean_modulus = mean_of(options_.modulus);
    round.dip = set_.dipped.dip.statistics;
    rounds_.push_back(round);
    if (before_)
      set_.context.log(fmt::format("ink, round {}: the film moved by {:.2g} mm on average",
                                   number(), round.change_mm));
  }

  double change(int rounds_ago) const {
    return number() > rounds_ago ? rounds_.rbegin()[rounds_ago].change_mm : 0;
  }

  Outcome outcome() const {
    if (before_ && change(0) < kSettled_mm) return Outcome::kSettled;
    if (number() == kFreeRounds && change(0) > kHopeless_mm) return Outcome::kHopeless;
    if (number() >= config_.ink.rounds_max) return Outcome::kUnsettled;
    // What does not settle costs a dip each round.
    const bool stands = number() > kFreeRounds + 2 && change(0) > kLeastProgress * change(2);
    return stands ? Outcome::kUnsettled : Outcome::kGoesOn;
  }

  // The film to dip next.
  void stiffen() {
    if (number() == kFreeRounds) {
      options_.tears_at_mm = set_.dipped.film().torn_at_mm;
      outline_.keep(set_.dipped.film());
    }
    std::vector<double> modulus =
        set_.times.measure("stiffness", [&] { return modulus_of(*set_.film); });
    options_.modulus = options_.modulus.empty() ? modulus : mixed(modulus);
  }

  // In the measure in which stiffness matters: next to soft film, hard ink and harder ink act
  // alike.
  std::vector<double> mixed(const std::vector<double>& modulus) {
    const auto compliance = [](const std::vector<double>& values) {
      return Eigen::VectorXd(
          Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()))
              .array()
              .rsqrt());
    };
    const double least = 1 / std::sqrt(kMostInks * config_.ink.stiffness_ratio);
    const Eigen::VectorXd next = mixer_.next(compliance(options_.modulus), compliance(modulus))
                                     .cwiseMax(least)
                                     .cwiseMin(1.0)
                                     .array()
                                     .square()
                                     .inverse();
    return {next.begin(), next.end()};
  }

  const InkSetting set_;
  JobConfig config_;    // with the rounds' resolution
  DipOptions options_;  // of the next dip
  std::optional<DippedFilm> before_;
  PrintedOutline outline_;
  FixedPoint mixer_{kMixed};
  FilmInk ink_;  // of the last round
  std::vector<InkRound> rounds_;
};

// The rounds and the print that they lead to.
class InkSettling {
 public:
  explicit InkSettling(const InkSetting& setting) : set_(setting) {}

  InkResult run() {
    InkRounds rounds(set_);
    const Outcome outcome = settle(rounds);
    result_.rounds = rounds.rounds();
    result_.settled = outcome == Outcome::kSettled;
    warn(outcome);
    finish(rounds);
    return std::move(result_);
  }

 private:
  Outcome settle(InkRounds& rounds) {
    if (!ink_matters(set_.config) || set_.config.ink.rounds_max == 1) {
      rounds.next();
      return Outcome::kSettled;
    }
    if (const auto modulus = modulus_of_flaps()) {
      rounds.begin_with(*modulus);
      if (rounds.next() == Outcome::kFailed) {
        rounds.begin_with({});
        rounds.next();
      }
      return Outcome::kHopeless;
    }
    Outcome outcome = Outcome::kGoesOn;
    while (outcome == Outcome::kGoesOn) outcome = rounds.next();
    return outcome;
  }

  // Two rounds on coarser film cost a small part of one dip. If they tell that the film tears into
  // flaps that never settle: what their ink makes of the film itself.
  std::optional<std::vector<double>> modulus_of_flaps() {
    JobConfig config = set_.config;
    config.film.elements /= kFewer;
    if (!(config.dip.material.tear_stretch > 0) || config.film.elements < kFewestElements)
      return std::nullopt;
    const double step_mm = config.dip.step_mm;
    config.dip.step_mm = std::min(kLonger * step_mm, std::max(step_mm, kLongestStep_mm));
    config.print.dpi = std::min(config.print.dpi, kCoarseDpi);
    const auto film = std::make_shared<const FilmMesh>(make_film_mesh(config.film));
    InkRounds rounds({set_.dipped, film, set_.model, config, set_.times, set_.context});
    Outcome outcome = rounds.next();
    const std::vector<std::uint8_t>& torn = set_.dipped.film().torn;
    const bool tears = std::find(torn.begin(), torn.end(), 1) != torn.end();
    if (tears) outcome = rounds.next();
    result_.coarse_rounds = rounds.rounds();
    if (outcome != Outcome::kHopeless) return std::nullopt;
    return rounds.modulus_of(*set_.film);
  }

  void warn(Outcome outcome) {
    if (outcome == Outcome::kFailed)
      set_.context.warn(
          "the dip could not be computed again with its ink: film torn or stretched this far finds "
          "no equilibrium; turn steep sides down or dip less, then print anew");
    else if (outcome == Outcome::kHopeless)
      set_.context.warn(fmt::format(
          "this film tears into flaps that fall another way with every change of its ink (by "
          "{:.1f} mm on average): colours will not land where they should; turn steep sides down "
          "or dip less deep",
          result_.last_change_mm()));
    else if (outcome != Outcome::kSettled && result_.rounds.size() > 1)
      set_.context.warn(fmt::format(
          "after {} rounds the ink still moves the film by {:.2g} mm on average (settled: {:g} "
          "mm); raise ink.rounds_max, or film.elements if it does not help",
          result_.rounds.size(), result_.last_change_mm(), kSettled_mm));
  }

  void finish(const InkRounds& rounds) {
    result_.ink = set_.times.measure("invert", [&] { return rounds.print(set_.config, true); });
    FilmInk& ink = result_.ink;
    const SheetRaster raster = sheet_raster(set_.config, set_.config.print.dpi);
    ink.on_object = look_on_object(ink.inking.inks, ink.stretch.area_ratio, set_.model,
                                   base_color(set_.config));
    result_.reach = measure_reach(ink.wanted, ink.on_object, ink.stretch, raster);
  }

  const InkSetting set_;
  InkResult result_;
};

}  // namespace

double InkResult::last_change_mm() const {
  const std::vector<InkRound>& last = rounds.size() > 1 ? rounds : coarse_rounds;
  return last.empty() ? 0 : last.back().change_mm;
}

std::unique_ptr<ColorModel> color_model(const JobConfig& config) {
  std::filesystem::path file = config.ink.profile;
  if (file.empty() && config.ink.model == InkModel::kDevice) return make_device_model();
  if (file.empty()) file = installed_cmyk_profile();
  if (file.empty())
    throw InputError(
        "ink.model: no CMYK profile is installed on this machine; name one with --printer-profile, "
        "install Debian's libgs-common, or set ink.model=device");
  std::vector<std::uint8_t> profile = read_file(file);
  if (!is_rgb_profile(profile))
    return make_profile_model(std::move(profile), file.string(), config.ink.intent);
  // Which inks its printer makes of a colour, an RGB profile does not say.
  if (config.print.color == PrintColor::kCmyk)
    throw InputError(fmt::format(
        "{}: is the profile of an RGB printer; set print.color=rgb, or name a CMYK profile",
        file.string()));
  return make_device_model();
}

InkResult settle_ink(DippedObject& dipped, const SharedFilmMesh& film, const ColorModel& model,
                     const JobConfig& config, StageTimes& times, RunContext& context) {
  return InkSettling({dipped, film, model, config, times, context}).run();
}

}  // namespace hydrodip
