// Whether film and bath have the room that an object takes.
#pragma once

#include <string>
#include <vector>

#include "base/context.h"
#include "dip/trajectory.h"
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
  double comfort_mm = 0;  // so much should be left of it: film needs room to stretch
};

// Whether all fit, with what should be left.
bool fits_well(const std::vector<RoomFit>& list);
// How much smaller an object would have to be for that, if all of it grew smaller alike; at most 1.
double shrinking_to_fit(const std::vector<RoomFit>& list);

// What the part of an object that gets wet takes in the bath, on all of its way.
struct Room {
  double depth_mm = 0;        // of the deepest point
  double half_width_mm = 0;   // largest |x|, from the film's centre
  double half_height_mm = 0;  // largest |y|
  double radius_mm = 0;
  // What a smaller object takes: all of it smaller, so unless its way or depth is given in mm; with
  // a depth that is made less with it; or it is not known.
  enum class Shrinks { kWhole, kWithDepth, kUnknown } shrinks = Shrinks::kWhole;
};
Room room_of(const TriangleMesh& posed, const Trajectory& trajectory);
Room room_of(const TriangleMesh& posed, double depth_mm);  // straight down

// Every direction in which it has to fit the film; without remedies.
std::vector<RoomFit> film_fits(const Room& room, const FilmOptions& film);

// Film first, then the bath. `size_mm`, here and below: the object's own largest extent
// (PosedObject::size_mm), of which remedies speak.
std::vector<RoomFit> fits(double size_mm, const Room& room, const FilmOptions& film,
                          const BathOptions& bath);

// Whether the whole sheet, margin included, lies flat in the bath.
bool sheet_fits_bath(const FilmOptions& film, const BathOptions& bath);
void warn_if_sheet_exceeds_bath(const FilmOptions& film, const BathOptions& bath,
                                const RunContext& context);

// Throws InputError for the first that does not fit, saying by how much and how to mend it.
void require_room(double size_mm, const Room& room, const FilmOptions& film,
                  const BathOptions& bath);
// Warns about little film around the object.
void warn_if_tight(const Room& room, const FilmOptions& film, const RunContext& context);

// As require_room; warns about a sheet larger than the bath and as warn_if_tight.
void require_fit(double size_mm, const Room& room, const FilmOptions& film, const BathOptions& bath,
                 const RunContext& context);

}  // namespace hydrodip
