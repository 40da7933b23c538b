// Where a row of a picture shows anything: of a sheet, few of its columns.
#pragma once

#include "image/image.h"

namespace hydrodip {

struct Columns {
  int begin = 0, end = 0;  // [begin, end)
  bool empty() const { return begin == end; }
};

// Outside of them the row is transparent.
inline Columns shown_columns(const Image& image, int y) {
  Columns shown{0, image.width_px};
  while (shown.begin < shown.end && image.pixel(shown.begin, y)[3] == 0) ++shown.begin;
  while (shown.end > shown.begin && image.pixel(shown.end - 1, y)[3] == 0) --shown.end;
  return shown;
}

}  // namespace hydrodip
