#include "camera/seen_photo.h"

#include "camera/board.h"

namespace hydrodip {

std::vector<SeenMark> single_marks(const SeenPhoto& photo) {
  std::map<int, int> times;
  for (const SeenMark& mark : photo.marks) ++times[mark.id];
  std::vector<SeenMark> single;
  for (const SeenMark& mark : photo.marks)
    if (times[mark.id] == 1) single.push_back(mark);
  return single;
}

std::map<int, std::vector<SeenMark>> by_strip(const SeenPhoto& photo) {
  std::map<int, std::vector<SeenMark>> strips;
  for (const SeenMark& mark : single_marks(photo))
    if (const int strip = strip_place(mark.id).strip; strip >= 0) strips[strip].push_back(mark);
  return strips;
}

int strip_seen_twice(const SeenPhoto& photo) {
  std::map<int, int> seen, twice;
  for (const SeenMark& mark : photo.marks)
    if (++seen[mark.id] == 2) ++twice[strip_place(mark.id).strip];
  // A single one may be a tag that was misread.
  for (const auto& [strip, tags] : twice)
    if (strip >= 0 && tags > 1) return strip;
  return -1;
}

}  // namespace hydrodip
