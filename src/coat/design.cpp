#include "coat/design.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/blank_array.h"
#include "base/plain_number.h"
#include "base/run_scope.h"
#include "coat/ink_rounds.h"

namespace hydrodip {
namespace {

bool ink_matters(const DesignOptions& options) {
  return options.stiffness.ratio > 1 && options.dip.method != DipMethod::kProjection;
}

// Rows that are printed together: enough for many threads, a small part of a large sheet.
constexpr int kBandRows = 256;

// Gives the memory of rows back that nobody asks any more.
template <class T>
void forget(BlankArray<T>& image, const RowBand& rows, int values_per_row) {
  const auto per_row = std::size_t(values_per_row);
  give_back(image.data() + std::size_t(rows.begin) * per_row,
            std::size_t(rows.end - rows.begin) * per_row * sizeof(T));
}

// The inks for what is wanted, and what comes of them on the object: band by band, so that they
// take the place in memory of what they are made from and nobody keeps.
void print(InkResult& result, const DesignTask& task, const Box2& covered) {
  FilmInk& ink = result.ink;
  const InkingOptions options = inking_of(task, task.options);
  const BlankArray<float>& area_ratio = ink.stretch.area_ratio;
  const int width_px = ink.wanted.width_px, height_px = ink.wanted.height_px;
  ink.inking = prepared_inking(ink.wanted, area_ratio, task.model, options);
  ink.on_object = Image(width_px, height_px);
  ReachMeter reach(raster_of(task.options.film, task.options.dpi), covered);
  for (int row = 0; row < height_px; row += kBandRows) {
    const RowBand band{row, std::min(row + kBandRows, height_px)};
    ink_rows(band, ink.wanted, area_ratio, task.model, options, ink.inking);
    look_at_rows(band, ink.inking.inks, area_ratio, task.model, options.base, ink.on_object);
    reach.add(band, ink.wanted, ink.on_object, ink.stretch);
    if (!task.kept.wanted) forget(ink.wanted.rgba, band, 4 * width_px);
    if (!task.kept.stretch) {
      forget(ink.stretch.area_ratio, band, width_px);
      forget(ink.stretch.on_object, band, width_px);
    }
  }
  if (!task.kept.wanted) ink.wanted = {};
  if (!task.kept.stretch) ink.stretch = {};
  result.reach = reach.result();
}

std::shared_ptr<const TrappedAir> air_of(const DesignTask& task, const RunContext& context) {
  const TriangleMesh& mesh = task.posed.mesh();
  return std::make_shared<const TrappedAir>(
      find_air(mesh, task.posed.surface(), make_trajectory(task.options.trajectory, mesh.positions),
               task.options.air, context));
}

// The rounds and the print that they lead to.
class Settling {
 public:
  Settling(const DesignTask& task, Timings& timings, const RunContext& context)
      : task_(task),
        timings_(timings),
        context_(context),
        film_(std::make_shared<const FilmMesh>(make_film_mesh(task.options.film))) {}

  Designed run() {
    air_ = task_.first ? task_.first->dipped.air
                       : timings_.measure("air", [&] { return air_of(task_, context_); });
    InkRounds rounds(task_, options(), film_, air_, timings_, context_);
    const Outcome outcome = settle(rounds);
    result_.rounds = rounds.rounds();
    result_.settled = outcome == Outcome::kSettled;
    warn(outcome);
    if (rounds.went_in_longer_steps() && outcome != Outcome::kFailed) {
      if (!rounds.last()) warn(Outcome::kFailed);
      result_.rounds = rounds.rounds();
    }
    finish(rounds);
    return {rounds.dipped(), std::move(result_), raster_of(options().film, options().dpi)};
  }

 private:
  const DesignOptions& options() const { return task_.options; }

  Outcome settle(InkRounds& rounds) {
    if (!ink_matters(options()) || options().rounds_max == 1) {
      rounds.next();
      return Outcome::kSettled;
    }
    Outcome outcome = Outcome::kGoesOn;
    while (outcome == Outcome::kGoesOn) outcome = rounds.next();
    return outcome;
  }

  void warn(Outcome outcome) {
    if (outcome == Outcome::kFailed)
      context_.warn(
          "the dip could not be computed again with its ink: film torn or stretched this far finds "
          "no equilibrium; turn steep sides down or dip less, then print anew");
    else if (outcome != Outcome::kSettled && result_.last_change_mm() > kUnseen_mm)
      context_.warn(fmt::format(
          "after {} rounds the ink still moves the film by {} mm on average; {}",
          result_.rounds.size(), plain_number(result_.last_change_mm()),
          int(result_.rounds.size()) >= options().rounds_max
              ? "raise ink.rounds_max, or film.elements if it does not help"
              : "more rounds would not bring it down: turn steep sides down, dip less deep, or "
                "raise film.elements"));
  }

  void finish(InkRounds& rounds) {
    timings_.measure("invert", [&] {
      result_.ink = rounds.wanted_last(options().dpi);
      print(result_, task_, rounds.dipped().map->covered());
    });
  }

  const DesignTask task_;
  Timings& timings_;
  const RunContext& context_;
  const SharedFilmMesh film_;
  std::shared_ptr<const TrappedAir> air_;
  InkResult result_;
};

}  // namespace

DesignOptions draft_of(DesignOptions options) {
  options.film.elements = std::min(options.film.elements, kDraftElements);
  options.dip.step_mm = std::max(options.dip.step_mm, kDraftStep_mm);
  options.air.cells = std::min(options.air.cells, kDraftAirCells);
  options.rounds_max = 1;
  return options;
}

bool is_draft(const DesignOptions& options) {
  return options.film.elements <= kDraftElements && options.dip.step_mm >= kDraftStep_mm &&
         options.rounds_max == 1;
}

double InkResult::last_change_mm() const {
  for (std::size_t n = rounds.size(); n-- > 1;)
    if (rounds[n].step_mm == rounds[n - 1].step_mm) return rounds[n].change_mm;
  return 0;
}

Designed design_on(const DesignTask& task, const DippedObject& dipped, const RunContext& context) {
  const RunScope scope(context);
  InkResult result;
  result.ink = wanted_on(task, task.options, *dipped.map, task.options.dpi, context);
  InkRound round;
  round.printed_mm2 = printed_area_mm2(result.ink.wanted, task.options.dpi);
  print(result, task, dipped.map->covered());
  round.dip = dipped.statistics;
  result.rounds.push_back(round);
  result.settled = true;
  return {dipped, std::move(result), raster_of(task.options.film, task.options.dpi)};
}

FirstDip dip_with_first_ink(const DesignTask& task, const RunContext& context) {
  const RunScope scope(context);
  Timings unheard;
  InkRounds rounds(task, task.options,
                   std::make_shared<const FilmMesh>(make_film_mesh(task.options.film)),
                   task.first ? task.first->dipped.air : air_of(task, context), unheard, context);
  rounds.next();
  FirstDip without{rounds.dipped(), {}};
  if (!ink_matters(task.options) || task.options.rounds_max == 1 || !rounds.lay()) return without;
  return {rounds.dipped(), rounds.dipped_modulus()};
}

Designed design(const DesignTask& task, Timings& timings, const RunContext& context) {
  const RunScope scope(context);
  return Settling(task, timings, context).run();
}

}  // namespace hydrodip
