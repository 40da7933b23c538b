// What is printed, and how its ink changes the dip: simulate, invert, stiffen, and again until the
// film stays where it is (paper section 3.4).
#pragma once

#include <memory>
#include <vector>

#include "ink/discoloration.h"
#include "job/dip_stage.h"

namespace hydrodip {

// By the printer's profile, or by the device formula; that too if the profile is an RGB printer's.
// Throws InputError if the profile is unusable or none is installed.
std::unique_ptr<ColorModel> color_model(const JobConfig& config);

// What lies on the film, and what comes of it on the object.
struct FilmInk {
  Image wanted;  // per pixel of the film, what shall appear on the object; transparent: no ink
  FilmStretch stretch;
  Inking inking;
  Image on_object;  // what will appear
};

// One round of the iteration.
struct InkRound {
  bool tears_kept = false;  // torn as in an earlier round
  double change_mm = 0;     // mean way of the film on the object since the round before
  double printed_mm2 = 0;   // area of the film image that carries colour
  double mean_modulus = 1;  // of the film that was dipped, over blank film
  DipStatistics dip;
};

// A loop is settled when the film on the object moved less than this on average.
inline constexpr double kSettled_mm = 1e-4;

struct InkResult {
  FilmInk ink;  // of the last round
  Reach reach;
  std::vector<InkRound> coarse_rounds;  // on coarser film, before the others
  std::vector<InkRound> rounds;
  bool settled = false;

  // The mean way that the last round moved the film; if the film itself was dipped only once, the
  // coarse film.
  double last_change_mm() const;
};

// Dips until ink and film agree, at most ink.rounds_max times; the last dip is left in `dipped`.
// Where film tears, the first two rounds are made on coarser film before: if they tell that ink and
// film never agree, the film itself is dipped once. Warns where they do not agree. `film` is
// config.film's.
InkResult settle_ink(DippedObject& dipped, const SharedFilmMesh& film, const ColorModel& model,
                     const JobConfig& config, StageTimes& times, RunContext& context);

}  // namespace hydrodip
