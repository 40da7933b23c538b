// Whether film on the water shows the picture that was printed for it: marks tell the size of a
// sheet and no more.
#pragma once

#include <optional>

#include "camera/film_pose.h"

namespace hydrodip {

// All of a sheet, as it is seen from above.
struct FilmPicture {
  GrayImage gray;
  double width_mm = 0, height_mm = 0, margin_mm = 0;
};

// How alike a photo and a picture are on the free film: how what differs from what is around it
// goes together, where the picture has anything that does. 1: as printed; about 0: another picture.
// Nothing where the picture is too even to tell by, or hardly any of it is to be seen.
std::optional<double> film_likeness(const GrayImage& photo, const FilmPose& pose, const Tank& tank,
                                    const FilmPicture& picture);

}  // namespace hydrodip
