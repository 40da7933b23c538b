// The page that goes to the printer: image at true size, marks in the taped margin, files.
#pragma once

#include <filesystem>
#include <string>

#include "base/context.h"
#include "image/image.h"

namespace hydrodip {

struct SheetOptions {
  double width_mm = 210;
  double height_mm = 297;
  double margin_mm = 10;  // marks stay inside it
  double dpi = 300;
  bool disc = false;        // draw the disc's rim as well
  bool ink_side_up = true;  // false: mirrored, for film laid ink side down
  std::string job_name;     // printed in the margin; any UTF-8, shortened to fit
  std::string date;         // ISO date recorded in the PDF, empty: none (reproducible)
};

// One page of the film's size with the image over the whole page (image covers the full sheet,
// margin included; its margin is transparent), centre ticks on all four sides, orientation text
// ("this side up", "this edge left" ...), and a 100 mm ruler (shorter, and saying so, on sheets
// under 125 mm). All marks in the margin, pure black. Throws InputError if it cannot be written.
void write_print_pdf(const std::filesystem::path& path, const Image& image,
                     const SheetOptions& options, RunContext& context);

// sRGB with dpi recorded, marks not included: the film image as seen from above, mirrored only if
// ink_side_up is false.
void write_print_png(const std::filesystem::path& path, const Image& image,
                     const SheetOptions& options);

// CMYK, 8 bit, dpi recorded, by ink/device.h; transparent means no ink.
void write_print_tiff(const std::filesystem::path& path, const Image& image,
                      const SheetOptions& options);

}  // namespace hydrodip
