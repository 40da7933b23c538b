#include <cstring>

#include "base/run_scope.h"
#include "image/blank_image.h"
#include "image/files.h"
#include "sheet/page.h"
#include "sheet/sheet.h"

namespace hydrodip {

namespace {

Image mirrored_image(const Image& image) {
  Image result = blank_image(image.width_px, image.height_px);
  for (int y = 0; y < image.height_px; ++y) {
    check_cancelled();
    for (int x = 0; x < image.width_px; ++x) {
      const std::uint8_t* pixel = image.pixel(x, y);
      if ((pixel[0] | pixel[1] | pixel[2] | pixel[3]) != 0)
        std::memcpy(result.pixel(image.width_px - 1 - x, y), pixel, 4);
    }
  }
  return result;
}

}  // namespace

void write_print_png(const std::filesystem::path& path, const Image& image,
                     const SheetOptions& options) {
  check_sheet(image, options);
  if (options.ink_side_up) {
    save_png(path, image, options.dpi);
  } else {
    save_png(path, mirrored_image(image), options.dpi);
  }
}

}  // namespace hydrodip
