// A sheet of film that several parts share: which piece of it each gets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/context.h"
#include "film/film.h"
#include "job/nest_parts.h"
#include "plan/sheet_packing.h"

namespace hydrodip {

// What is cut out for one part.
struct NestPiece {
  std::size_t part;
  int number;  // from 1, over all
  PackedPiece place;
};

struct Nest {
  std::vector<NestPart> parts;
  std::vector<NestPiece> pieces;
  std::vector<MadePart> made;  // per part
};

// Sizes the pieces and places them: `clearance_mm` of free film around each part, or as much as the
// sheet has room for. Throws InputError if not all find room, saying how many do, or if a part fits
// neither its piece nor the bath.
void share_out_film(Nest& nest, const FilmOptions& sheet, std::optional<double> clearance_mm,
                    const RunContext& context);

// The pieces of parts that are not to be dipped like this, "2, 3"; "": all may be.
std::string not_to_be_dipped(const Nest& nest);

}  // namespace hydrodip
