#include "sheet/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace hydrodip {

namespace {

bool row_is_printed(const Picture& picture, int y) {
  for (int x = 0; x < picture.width_px; ++x) {
    if (picture.is_printed(x, y)) return true;
  }
  return false;
}

}  // namespace

void check_sheet(const Picture& picture, const SheetOptions& options) {
  const auto usable = [](double value) { return std::isfinite(value) && value > 0; };
  if (!usable(options.width_mm) || !usable(options.height_mm) || !usable(options.dpi)) {
    throw InputError(
        fmt::format("A sheet of {:g} x {:g} mm at {:g} dpi cannot be printed; give "
                    "sizes and dpi above 0.",
                    options.width_mm, options.height_mm, options.dpi));
  }
  if (!(options.margin_mm >= 0) ||
      2 * options.margin_mm >= std::min(options.width_mm, options.height_mm)) {
    throw InputError(
        fmt::format("A margin of {:g} mm does not fit a sheet of {:g} x {:g} mm; make it narrower.",
                    options.margin_mm, options.width_mm, options.height_mm));
  }
  const double expected_width = options.width_mm * options.dpi / kMmPerInch;
  const double expected_height = options.height_mm * options.dpi / kMmPerInch;
  if (std::abs(picture.width_px - expected_width) > 1 ||
      std::abs(picture.height_px - expected_height) > 1) {
    throw InputError(fmt::format(
        "An image of {} x {} pixels does not cover a sheet of {:g} x {:g} mm at {:g} dpi; it needs "
        "{:.0f} x {:.0f} pixels.",
        picture.width_px, picture.height_px, options.width_mm, options.height_mm, options.dpi,
        expected_width, expected_height));
  }
}

PixelBox printed_box(const Picture& picture) {
  PixelBox box{0, 0, picture.width_px, picture.height_px};
  while (box.y_begin < box.y_end && !row_is_printed(picture, box.y_begin)) {
    ++box.y_begin;
  }
  while (box.y_end > box.y_begin && !row_is_printed(picture, box.y_end - 1)) {
    --box.y_end;
  }
  if (box.empty()) return {};
  box.x_begin = picture.width_px;
  box.x_end = 0;
  for (int y = box.y_begin; y < box.y_end; ++y) {
    // Only columns outside what is known already can widen the box.
    for (int x = 0; x < box.x_begin; ++x) {
      if (picture.is_printed(x, y)) box.x_begin = x;
    }
    for (int x = picture.width_px - 1; x >= box.x_end; --x) {
      if (picture.is_printed(x, y)) box.x_end = x + 1;
    }
  }
  return box;
}

PixelBox mirrored(const PixelBox& box, int width_px) {
  return {width_px - box.x_end, box.y_begin, width_px - box.x_begin, box.y_end};
}

Box2 place_on_page(const PixelBox& box, const Picture& picture, const SheetOptions& options) {
  const double pixel_mm = kMmPerInch / options.dpi;
  const auto to_page = [&](int x, int y) {
    return Vec2(0.5 * options.width_mm + (x - 0.5 * picture.width_px) * pixel_mm,
                0.5 * options.height_mm + (0.5 * picture.height_px - y) * pixel_mm);
  };
  Box2 page;
  page.add(to_page(box.x_begin, box.y_end));
  page.add(to_page(box.x_end, box.y_begin));
  return page;
}

}  // namespace hydrodip
