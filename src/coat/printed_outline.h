// The film that is printed on, kept the same from some round on.
#pragma once

#include <cstdint>
#include <vector>

#include "film/film.h"
#include "object/surface.h"

namespace hydrodip {

// What lies on the object, and from some round on the same triangles
// every time.
class PrintedOutline {
 public:
  bool is_kept() const { return !kept_.empty(); }

  void keep(const DippedFilm& film);

  // The film as if just the kept triangles lay on the object; `and_others`: besides those that do.
  // A corner that just misses the object counts as touching it.
  DippedFilm applied(const DippedFilm& film, const Surface& surface, bool and_others) const;

 private:
  std::vector<std::uint8_t> kept_;
};

}  // namespace hydrodip
