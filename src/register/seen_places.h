// Places of a printed sheet, and where a dip laid them on the object: from a scan of a board's
// corners, or from a table.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "film/film.h"
#include "register/printed_film.h"
#include "register/register.h"

namespace hydrodip {

// One place of the sheet that was seen on the object.
struct SeenPlace {
  Vec2 printed = Vec2::Zero();   // where it was on the sheet
  Vec3 position = Vec3::Zero();  // where it lies: posed-object frame
};

// What a dip came to.
struct SeenPlaces {
  std::vector<SeenPlace> places;
  std::string board;  // whose corners these are; empty: places from a table
  double square_mm = 0;
};

// Throws InputError for a file that is neither, one that is of no board or could be of two, and a
// scan that is mirrored or whose faces look into the object.
SeenPlaces read_seen_places(const std::filesystem::path& file, const PrintedFilm& film,
                            const FilmOptions& sheet, const CorrectRequest& request,
                            const RunContext& context);

}  // namespace hydrodip
