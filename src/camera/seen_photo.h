// What a photo of the tank shows of the strips on its rim.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tags/seen_marks.h"

namespace hydrodip {

// One photo's marks.
struct SeenPhoto {
  std::string name;
  std::vector<SeenMark> marks;
};

// Those whose tag is seen once: of two nobody knows which is meant.
std::vector<SeenMark> single_marks(const SeenPhoto& photo);

// These marks by the number of their strip; what is on none is left out.
std::map<int, std::vector<SeenMark>> by_strip(const SeenPhoto& photo);

// Of a strip of which there is a second print in the photo, its number; -1: there is none.
int strip_seen_twice(const SeenPhoto& photo);

}  // namespace hydrodip
