// Where a repeated pattern does least harm: which part of it comes to lie where the film is
// stretched, and where nothing should be disturbed.
#pragma once

#include <vector>

#include "base/math.h"
#include "image/image.h"

namespace hydrodip {

// A piece of film that will lie on the object.
struct FilmPiece {
  Vec2 film_mm;   // where it is in the flat film
  double weight;  // how much detail and seams would disturb there
};

struct TilePlace {
  Vec2 shift_mm = Vec2::Zero();  // of a tile's centre from the film's
  double turn_deg = 0;           // counter-clockwise as seen from above
  double trouble = 0;            // weighted detail and seams, over what lies anywhere on average: 1
};

// Whether the picture goes on across its edges when it is repeated.
bool is_seamless(const Image& tile);

// The shift, and one of the turns, that keeps a tile's detail, and its seams if it is not seamless,
// away from where they would disturb. Of equally good places the first: no shift, no turn.
TilePlace best_tile_place(const Image& tile, const Vec2& size_mm,
                          const std::vector<FilmPiece>& pieces,
                          const std::vector<double>& turns_deg);

}  // namespace hydrodip
