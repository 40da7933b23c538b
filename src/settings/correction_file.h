// The field of displacements that 'hydrodip correct' wrote.
#pragma once

#include <filesystem>
#include <vector>

#include "film/correction.h"

namespace hydrodip {

// What one corner of a dip said: what the film model takes for `model_mm` on the sheet was printed
// `move_mm` from there.
struct CorrectionSample {
  Vec2 model_mm = Vec2::Zero(), move_mm = Vec2::Zero();
};

struct CorrectionFile {
  FilmCorrection field;
  std::vector<CorrectionSample> samples;  // that it was fitted to
};

// Throws InputError, naming the file, for what is none.
CorrectionFile read_correction(const std::filesystem::path& file);

}  // namespace hydrodip
