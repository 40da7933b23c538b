#include "coat/ink_rounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"

namespace hydrodip {
namespace {

// Whether film tears, and whether the last triangle at the rim touches, is yes or no: where that is
// undecided, two rounds can disagree forever. After so many rounds, of which the last knew the ink
// all but in its place, film tears where and when it did, and what is printed keeps its outline.
// Then a dip changes smoothly with its ink.
constexpr int kFreeRounds = 2;
// And then the next ink can be guessed from so many rounds and the last one.
constexpr int kMixed = 4;
// All four inks at once make film so many times as stiff as one alone.
constexpr double kMostInks = 4;
// From there on so many rounds have to bring the change below this share of the least so far: an
// acceleration that has just begun may take two that do not, and film that comes up at an edge of
// the object may lie to one side of it in one round, and to the other in the next.
constexpr int kPatience = 3;
constexpr double kLeastProgress = 0.5;
// While ink and film settle, the film image need only be as fine as stiffness can tell: several
// pixels to a millimetre.
constexpr double kRoundsDpi = 150;

// Of the whole film that lies on the object in both. What floats on or has torn leaves no trace.
double mean_way(const DippedFilm& from, const DippedFilm& to) {
  std::vector<std::uint8_t> counts(from.position.size(), 0);
  for (std::size_t t = 0; t < from.mesh().triangles.size(); ++t)
    if (from.lies_on_object(t) && to.lies_on_object(t))
      for (const std::int32_t v : from.mesh().triangles[t])
        counts[std::size_t(v)] = !(from.excess_of(v) > 0) && !(to.excess_of(v) > 0);
  double sum = 0, count = 0;
  for (std::size_t v = 0; v < counts.size(); ++v) {
    if (!counts[v]) continue;
    sum += (to.position[v] - from.position[v]).norm();
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

double mean_of(const std::vector<double>& values) {
  if (values.empty()) return 1;
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

}  // namespace

double printed_area_mm2(const Image& wanted, double dpi) {
  double pixels = 0;
  for (std::size_t i = 3; i < wanted.rgba.size(); i += 4) pixels += wanted.rgba[i] / 255.0;
  return pixels * (kMmPerInch / dpi) * (kMmPerInch / dpi);
}

InkingOptions inking_of(const DesignTask& task, const DesignOptions& options) {
  InkingOptions inking = options.inking;
  inking.base = task.paint.base();
  return inking;
}

FilmInk wanted_on(const DesignTask& task, const DesignOptions& options, const FilmMap& map,
                  double dpi, const RunContext& context) {
  const SheetRaster raster = raster_of(options.film, dpi);
  FilmInk ink;
  ink.wanted = film_image(task.paint, map, raster, options.inverse, task.allotment, context);
  ink.stretch = film_stretch(map, raster, options.inverse.bleed_mm, context);
  return ink;
}

InkRounds::InkRounds(const DesignTask& task, const DesignOptions& options,
                     const SharedFilmMesh& film, std::shared_ptr<const TrappedAir> air,
                     Timings& timings, const RunContext& context)
    : task_(task),
      options_(options),
      film_(film),
      air_(std::move(air)),
      timings_(timings),
      context_(context),
      trajectory_(make_trajectory(options.trajectory, task.posed.mesh().positions)),
      rounds_dpi_(std::min(options.dpi, kRoundsDpi)),
      dip_options_(options.dip),
      mixer_(kMixed) {}

bool InkRounds::lay() {
  if (number() > 0) stiffen();
  return dip();
}

Outcome InkRounds::next() {
  // From the first dip on whose steps all others go in, rounds differ by little.
  if (number() + 1 == kFreeRounds && options_.rounds_max > kFreeRounds)
    dip_options_.relaxed_steps = std::make_shared<RelaxedSteps>();
  Outcome outcome = Outcome::kFailed;
  if (lay()) {
    print_round();
    outcome = this->outcome();
  }
  // No round begins from them, and printing takes memory.
  if (outcome != Outcome::kGoesOn) dip_options_.relaxed_steps.reset();
  return outcome;
}

bool InkRounds::last() {
  stiffen();
  dip_options_.step_mm = options_.dip.step_mm;
  if (!dip()) return false;
  print_round();
  return true;
}

// That the ink of the last round gives to the film.
std::vector<double> InkRounds::modulus() const {
  return film_modulus(*film_, ink_.inking.inks, raster_of(options_.film, rounds_dpi_),
                      options_.stiffness);
}

FilmInk InkRounds::wanted(double dpi, bool all) const {
  if (!outline_.is_kept()) return wanted_on(task_, options_, *dipped_->map, dpi, context_);
  const Surface& surface = dipped_->posed.surface();
  const DippedFilm kept = outline_.applied(*dipped_->film, surface, all);
  return wanted_on(task_, options_, FilmMap(dipped_->posed.mesh(), surface, kept), dpi, context_);
}

// False if the film cannot be dipped with its ink: then the last dip stays.
bool InkRounds::dip() {
  if (number() > 0) before_ = dipped_;
  if (number() == 0 && task_.first) {
    dipped_ = task_.first->dipped;
    dip_options_.modulus = task_.first->modulus;
    return true;
  }
  dip_options_.failed_share_max = dip_options_.modulus.empty() ? 1 : kMostFailedShare;
  try {
    dipped_ = dip_object(task_.posed, film_, trajectory_, dip_options_, timings_, context_, {},
                         {.options = {}, .found = air_});
  } catch (const DipError&) {
    if (dip_options_.modulus.empty()) throw;
    return false;
  }
  return true;
}

void InkRounds::print_round() {
  ink_ = {};
  timings_.measure("ink", [&] {
    ink_ = wanted(rounds_dpi_, false);
    ink_.inking = ink_film(ink_.wanted, ink_.stretch.area_ratio, task_.model,
                           inking_of(task_, options_), context_);
  });
  judge();
}

FilmInk InkRounds::wanted_last(double dpi) {
  ink_ = {};
  return wanted(dpi, true);
}

void InkRounds::judge() {
  InkRound round;
  round.tears_kept = !dip_options_.tears_at_mm.empty();
  if (before_) round.change_mm = mean_way(*before_->film, *dipped_->film);
  round.printed_mm2 = printed_area_mm2(ink_.wanted, rounds_dpi_);
  round.step_mm = dip_options_.step_mm;
  round.mean_modulus = mean_of(dip_options_.modulus);
  round.dip = dipped_->statistics;
  rounds_.push_back(round);
  if (before_)
    context_.log(fmt::format("ink, round {}: the film moved by {:.2g} mm on average", number(),
                             round.change_mm));
}

double InkRounds::change(int rounds_ago) const {
  return number() > rounds_ago ? rounds_.rbegin()[rounds_ago].change_mm : 0;
}

// Of the rounds from so many ago to before so many.
double InkRounds::least_change(int from_ago, int to_ago) const {
  double least = change(from_ago);
  for (int ago = from_ago; ago < to_ago; ++ago) least = std::min(least, change(ago));
  return least;
}

Outcome InkRounds::outcome() const {
  if (before_ && change(0) < options_.settled_mm) return Outcome::kSettled;
  if (number() >= options_.rounds_max) return Outcome::kUnsettled;
  // What does not settle costs a dip each round.
  const bool stands =
      number() > kFreeRounds + kPatience &&
      least_change(0, kPatience) > kLeastProgress * least_change(kPatience, number() - 1);
  return stands ? Outcome::kUnsettled : Outcome::kGoesOn;
}

// The film to dip next.
void InkRounds::stiffen() {
  // Long steps stretch film over hollows further than it is, and tear it: what decides on tears
  // goes in the job's own.
  dip_options_.step_mm = number() < kFreeRounds
                             ? options_.dip.step_mm
                             : std::max(options_.dip.step_mm, options_.rounds_step_mm);
  if (number() == kFreeRounds) {
    dip_options_.tears_at_mm = dipped_->film->torn_at_mm;
    dip_options_.moved_mm = dipped_->film->moved_mm;
    // So that rounds differ by their ink alone.
    if (!went_in_longer_steps()) dip_options_.steps_at_mm = dipped_->statistics.steps_at_mm;
    outline_.keep(*dipped_->film);
  } else if (number() > kFreeRounds) {
    // What lets go besides, in any round, does in all that follow: no film comes and goes.
    std::vector<double>& told = dip_options_.tears_at_mm;
    const std::vector<double> before = told;
    for (std::size_t t = 0; t < told.size(); ++t)
      told[t] = std::min(told[t], dipped_->film->torn_at_mm[t]);
    // Film that tears otherwise answers its ink otherwise: earlier rounds tell nothing of it.
    if (told != before) mixer_ = FixedPoint(kMixed);
  }
  std::vector<double> modulus = timings_.measure("stiffness", [&] { return this->modulus(); });
  dip_options_.modulus = dip_options_.modulus.empty() ? modulus : mixed(modulus);
}

// In the measure in which stiffness matters: next to soft film, hard ink and harder ink act alike.
std::vector<double> InkRounds::mixed(const std::vector<double>& modulus) {
  const auto compliance = [](const std::vector<double>& values) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()))
            .array()
            .rsqrt());
  };
  const double least = 1 / std::sqrt(kMostInks * options_.stiffness.ratio);
  const Eigen::VectorXd next = mixer_.next(compliance(dip_options_.modulus), compliance(modulus))
                                   .cwiseMax(least)
                                   .cwiseMin(1.0)
                                   .array()
                                   .square()
                                   .inverse();
  return {next.begin(), next.end()};
}

}  // namespace hydrodip
