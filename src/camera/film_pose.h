// How a printed sheet lies on the water.
#pragma once

#include <string>
#include <vector>

#include "camera/tank.h"
#include "camera/view.h"
#include "tags/mark.h"

namespace hydrodip {

// Off its place: a point u of the printed sheet lies at place(shift + R(turn) (swelling . u)). Each
// value with its standard deviation: of what scatters between the marks, and of what is not known
// of camera and water level.
struct FilmPose {
  Vec2 shift_mm = Vec2::Zero(), shift_sigma_mm = Vec2::Zero();
  double turn_deg = 0, turn_sigma_deg = 0;  // counter-clockwise from above
  Vec2 swelling = Vec2::Ones(), swelling_sigma = Vec2::Zero();
  // What that leaves unexplained, mark by mark, in the sheet's directions.
  struct Mark {
    int id = 0;
    Vec2 on_sheet_mm = Vec2::Zero(), unexplained_mm = Vec2::Zero();
  };
  std::vector<Mark> marks;
  double unexplained_rms_mm = 0;
  int foreign = 0;  // marks of a sheet's kind that belong to no sheet that lies like that
  double board_rms_px = 0;
  int board_marks = 0;
  View view{};  // of the photo

  // Where it lies from its place on: mm.
  Vec2 at(const Vec2& u) const;
};

struct FilmSearch {
  std::vector<MarkPlace> marks;  // of the sheet
  double water_sigma_mm = 0.3;   // how well the water's level is known
  double tolerance_mm = 1;       // unexplained rms beyond which it is refused
  bool any_turn = false;         // a quarter turn and more is no fault
};

// Finds film and rim in a photo of that tank. Throws InputError, a sentence with the photo's name:
// of another size than the tank's photos, mirrored, too few marks of film or rim, a rim that is not
// as it was calibrated, film that lies upside down or turned by a quarter and more, marks that do
// not fit the sheet, or a pose that is known to no better than half a millimetre or degree.
FilmPose find_film(const GrayImage& photo, const std::string& name, const Tank& tank,
                   const FilmSearch& search, const RunContext& context);

}  // namespace hydrodip
