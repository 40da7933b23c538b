// How far a dip lay off what its print meant, place by place.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "film/film.h"
#include "register/printed_film.h"
#include "register/seen_places.h"
#include "settings/correction_file.h"

namespace hydrodip {

struct SeenDip {
  std::filesystem::path file;
  std::string board;  // as of its places
  double square_mm = 0;
  std::vector<CorrectionSample> samples;
  // From what the print meant.
  Vec2 mean_off = Vec2::Zero();  // mm, on the sheet
  double rms_off_mm = 0;         // on the sheet
  double rms_on_object_mm = 0;
};

// Places that lie elsewhere than on the job's film are left out. Throws InputError if hardly any is
// left, or they are the mirror image of what was printed; warns of what is unlikely.
SeenDip seen_dip(const std::filesystem::path& file, const SeenPlaces& seen, const PrintedFilm& film,
                 const RunContext& context);

// Throws InputError if two of them say the same: the same dip twice is no second witness.
void require_different(const std::vector<SeenDip>& dips);

// What differs from dip to dip, and cannot be corrected: the mean distance of a dip's shift from
// that of all.
double between_dips_mm(const std::vector<SeenDip>& dips);

// All dips' places together.
struct SeenMisfit {
  double places = 0;
  double on_sheet_mm = 0, on_object_mm = 0;  // rms
};
SeenMisfit misfit_of(const std::vector<SeenDip>& dips);

}  // namespace hydrodip
