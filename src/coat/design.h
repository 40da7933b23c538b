// What is printed for one dip, and how its ink changes the dip: simulate, invert, stiffen, and
// again until the film stays where it is (paper section 3.4).
#pragma once

#include <vector>

#include "coat/dipped_object.h"
#include "film/film.h"
#include "ink/discoloration.h"
#include "ink/stiffness.h"
#include "object/paint.h"
#include "transfer/allotment.h"
#include "transfer/raster.h"

namespace hydrodip {

// Rounds are settled when the film on the object moved less than this on average.
inline constexpr double kSettled_mm = 1e-4;

struct DesignOptions {
  FilmOptions film;
  TrajectoryOptions trajectory;
  DipOptions dip;  // with the film's material
  AirOptions air;
  StiffnessOptions stiffness;
  int rounds_max = 10;  // simulate, invert, stiffen, repeat: at most this often
  double settled_mm = kSettled_mm;
  // Rounds after the first go in steps so long until they are settled, and one more in the dip's
  // own; 0: all go in the dip's own.
  double rounds_step_mm = 0;
  double dpi = 300;  // of what is printed
  InverseOptions inverse;
  InkingOptions inking;  // its base is the paint's
};

// No dip lands nearer to its place than some tenths of a millimetre: what ink still moves film by
// below that is not worth a word, and among several dips no further one.
inline constexpr double kUnseen_mm = 0.03;

// The same to look at while an object is still being turned: coarse film in long steps, one round.
// docs/performance.md has the errors and times.
inline constexpr int kDraftElements = 10000;
inline constexpr double kDraftStep_mm = 1;
inline constexpr int kDraftAirCells = 40000;
DesignOptions draft_of(DesignOptions options);
// Whether a design by such options is no better than a draft.
bool is_draft(const DesignOptions& options);

// What lies on the film, and what comes of it on the object.
struct FilmInk {
  // Per pixel of the film, what shall appear on the object; transparent: no ink. Empty: not kept.
  Image wanted;
  FilmStretch stretch;  // likewise
  Inking inking;
  Image on_object;  // what will appear
};

// One round of the iteration.
struct InkRound {
  bool tears_kept = false;  // torn as in an earlier round
  double change_mm = 0;     // mean way of the film on the object since the round before
  double step_mm = 0;       // of its dip
  double printed_mm2 = 0;   // area of the film image that carries colour
  double mean_modulus = 1;  // of the film that was dipped, over blank film
  DipStatistics dip;
};

struct InkResult {
  FilmInk ink;  // of the last round
  Reach reach;
  std::vector<InkRound> rounds;
  bool settled = false;

  // The mean way that the last round moved the film whose dip went in the same steps as the one
  // before: other steps move it, too.
  double last_change_mm() const;
};

struct Designed {
  DippedObject dipped;  // with its ink
  InkResult ink;
  SheetRaster raster;  // of ink's pixels
};

// A dip that a design begins from.
struct FirstDip {
  DippedObject dipped;
  std::vector<double> modulus = {};  // per triangle, as film_modulus() has it; empty: no ink
};

// What stays of the film image once its inks are known, and what comes of them: each takes 4 to 5
// bytes of memory an inked pixel.
struct KeptImages {
  bool wanted = true;   // to be looked at
  bool stretch = true;  // for coats over this one, or if this one lies over others
};

// What a design is made for. Refers to all of it.
struct DesignTask {
  const PosedObject& posed;
  const Paint& paint;
  const Allotment& allotment;  // what of the paint this film brings
  const ColorModel& model;
  const DesignOptions& options;
  // A dip of it that was made already: then the first round makes none. Null: there is none.
  const FirstDip* first = nullptr;
  KeptImages kept = {};
};

// The dip with the ink that it calls for as it lay without: how film falls that carries ink, all
// but in its place. Where ink does not matter, or such film cannot be dipped, the dip without.
FirstDip dip_with_first_ink(const DesignTask& task, const RunContext& context);

// What to print on film that was dipped without ink, and what comes of it: one round, which makes
// no dip of its own. As design() with rounds_max 1.
Designed design_on(const DesignTask& task, const DippedObject& dipped, const RunContext& context);

// Dips until ink and film agree, at most rounds_max times. Warns where they do not.
Designed design(const DesignTask& task, Timings& timings, const RunContext& context);

}  // namespace hydrodip
