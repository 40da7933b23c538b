// The rounds in which ink and film come to agree: dip, print, stiffen, and again.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "coat/design.h"
#include "coat/fixed_point.h"
#include "coat/printed_outline.h"

namespace hydrodip {

// What a round has led to.
enum class Outcome { kGoesOn, kSettled, kUnsettled, kFailed };

// What is wanted on film that lies like that, and how it is stretched; no ink yet.
FilmInk wanted_on(const DesignTask& task, const DesignOptions& options, const FilmMap& map,
                  double dpi, const RunContext& context);

// As options.inking, over the paint's base.
InkingOptions inking_of(const DesignTask& task, const DesignOptions& options);

// Of a film image.
double printed_area_mm2(const Image& wanted, double dpi);

class InkRounds {
 public:
  // Refers to all of them. `film` is that of options.film, `air` what this way into the water
  // traps.
  InkRounds(const DesignTask& task, const DesignOptions& options, const SharedFilmMesh& film,
            std::shared_ptr<const TrappedAir> air, Timings& timings, const RunContext& context);

  Outcome next();
  // One more dip, of film with the ink that was printed last, on which nothing is printed: no round
  // comes after it. False if it cannot be computed: then the last dip stays.
  bool lay();
  // One more round, in the dip's own steps. False if it cannot be computed: then the last round
  // stays.
  bool last();
  // Whether the last round's steps were longer than the dip's own.
  bool went_in_longer_steps() const { return dip_options_.step_mm > options_.dip.step_mm; }

  const std::vector<InkRound>& rounds() const { return rounds_; }
  // As dipped last.
  const DippedObject& dipped() const { return *dipped_; }
  // Of the film that was dipped last; empty: no ink.
  const std::vector<double>& dipped_modulus() const { return dip_options_.modulus; }

  // What is wanted at `dpi` on the film as it was dipped last, wherever it lies on the object, and
  // how it is stretched. Ends the rounds: their own ink gives its memory back first.
  FilmInk wanted_last(double dpi);

 private:
  int number() const { return int(rounds_.size()); }
  double change(int rounds_ago) const;
  double least_change(int from_ago, int to_ago) const;
  std::vector<double> modulus() const;
  bool dip();
  // As wanted_last; without `all` only within the outline that is kept.
  FilmInk wanted(double dpi, bool all) const;
  void print_round();
  void judge();
  Outcome outcome() const;
  void stiffen();
  std::vector<double> mixed(const std::vector<double>& modulus);

  const DesignTask task_;
  const DesignOptions& options_;
  const SharedFilmMesh film_;
  const std::shared_ptr<const TrappedAir> air_;
  Timings& timings_;
  const RunContext& context_;
  const Trajectory trajectory_;
  double rounds_dpi_;
  DipOptions dip_options_;  // of the next dip
  std::optional<DippedObject> before_, dipped_;
  PrintedOutline outline_;
  FixedPoint mixer_;
  FilmInk ink_;  // of the last round
  std::vector<InkRound> rounds_;
};

}  // namespace hydrodip
