#include "image/files.h"
#include "sheet/page.h"
#include "sheet/sheet.h"

namespace hydrodip {

void write_print_png(const std::filesystem::path& path, const Image& image,
                     const SheetOptions& options) {
  check_sheet(image, options);
  save_png(path, image, options.dpi, !options.ink_side_up);
}

}  // namespace hydrodip
