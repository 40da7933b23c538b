// Whether film and bath have the room that an object takes.
#pragma once

#include <string>
#include <vector>

#include "base/context.h"
#include "film/film.h"
#include "object/object.h"

namespace hydrodip {

// The tank of the paper's appendix A.
struct BathOptions {
  double width_mm = 370;
  double height_mm = 270;
  double depth_mm = 150;
};

// Room that the dipped part of a posed object takes and has, per direction.
struct RoomFit {
  std::string what;  // "wide (x)"
  std::string room;  // "free film between the taped rims"
  double needed_mm = 0;
  double available_mm = 0;
  std::string remedy;  // "shrink it with --size 71, ..."
  double excess_mm() const { return needed_mm - available_mm; }
};

// Every direction in which it has to fit the film. Only the part that gets wet counts.
std::vector<RoomFit> film_fits(const TriangleMesh& posed, double depth_mm, const FilmOptions& film);

// Film first, then the bath.
std::vector<RoomFit> fits(const TriangleMesh& posed, double depth_mm, const FilmOptions& film,
                          const BathOptions& bath);

// Whether the whole sheet, margin included, lies flat in the bath.
bool sheet_fits_bath(const FilmOptions& film, const BathOptions& bath);

// Throws InputError for the first that does not fit, saying by how much and how to mend it. Warns
// about a sheet larger than the bath and about little film around the object.
void require_fit(const TriangleMesh& posed, double depth_mm, const FilmOptions& film,
                 const BathOptions& bath, const RunContext& context);

}  // namespace hydrodip
