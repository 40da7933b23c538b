// Where the image lies on the page, and the checks that all three writers share.
#pragma once

#include "base/math.h"
#include "sheet/picture.h"
#include "sheet/sheet.h"

namespace hydrodip {

// Throws InputError unless sizes and dpi are usable numbers and the image has the sheet's pixels
// (to within one in each direction).
void check_sheet(const Picture& picture, const SheetOptions& options);

// A block of pixels: columns [x_begin, x_end), rows [y_begin, y_end).
struct PixelBox {
  int x_begin = 0, y_begin = 0, x_end = 0, y_end = 0;
  int width() const { return x_end - x_begin; }
  int height() const { return y_end - y_begin; }
  bool empty() const { return x_end <= x_begin || y_end <= y_begin; }
};

// The smallest block that holds every pixel that is printed; empty if there is none.
PixelBox printed_box(const Picture& picture);

// The image flipped left-right.
PixelBox mirrored(const PixelBox& box, int width_px);

// The block on the page, in mm from the page's lower left corner. The image's centre is the page's
// centre and a pixel measures exactly 1 / dpi inches, so that rounding the sheet to whole pixels
// never scales the print.
Box2 place_on_page(const PixelBox& box, const Picture& picture, const SheetOptions& options);

}  // namespace hydrodip
