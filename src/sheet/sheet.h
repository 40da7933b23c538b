// The page that goes to the printer: image at true size, marks in the taped margin, files.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/math.h"
#include "image/image.h"
#include "ink/inks.h"
#include "sheet/picture.h"

namespace hydrodip {

// How far from true a printer draws about the page's middle: (x, y) mm of the page become
// (x scale_x + y skew, y scale_y) mm on paper.
struct PrinterScale {
  double x = 1, y = 1;
  double skew = 0;
  bool is_true() const { return x == 1 && y == 1 && skew == 0; }
  // What a page is drawn by about its middle, so that it comes out true.
  Mat2 undone() const { return (Mat2() << 1 / x, -skew / (x * y), 0, 1 / y).finished(); }
};

struct SheetOptions {
  double width_mm = 210;
  double height_mm = 297;
  double margin_mm = 10;  // marks stay inside it
  double dpi = 300;
  bool disc = false;          // draw the disc's rim as well
  bool ink_side_up = true;    // false: mirrored, for film laid ink side down
  std::string job_name;       // printed in the margin; any UTF-8, shortened to fit
  std::string alarm;          // "DO NOT DIP: ..." in a red band of the margin; empty: none
  std::string date;           // ISO date recorded in the PDF, empty: none (reproducible)
  bool camera_marks = false;  // those of sheet/film_marks.h, where there is room
  // Thin lines of the PDF where nothing else is printed; mm from the middle of the image, right and
  // up, as the film is seen from above.
  std::vector<std::array<Vec2, 2>> outlines;
  PrinterScale printer;  // PDF only: the page is drawn so that it comes out true
};

// What the sheet will look like, sRGB with dpi recorded, marks not included: the film as seen from
// above, mirrored only if ink_side_up is false.
void write_print_png(const std::filesystem::path& path, const Image& image,
                     const SheetOptions& options);

// CMYK, 8 bit, dpi recorded, with the ICC profile that the inks were made for.
void write_print_tiff(const std::filesystem::path& path, const InkImage& inks,
                      const std::vector<std::uint8_t>& profile, const SheetOptions& options);

// A CMYK TIFF with 8 bits, in rows, of any compression, as its orientation wants it seen; its dpi
// (0: not recorded) and ICC profile (empty: none). Throws InputError if it cannot be read or is of
// another kind.
struct CmykFile {
  InkImage inks;
  double dpi = 0;
  std::vector<std::uint8_t> profile = {};
};
// Whether it is a TIFF of inks at all, whatever else.
bool is_ink_tiff(const std::filesystem::path& path);
CmykFile read_cmyk_tiff(const std::filesystem::path& path);

// One page of the film's size with the picture over the whole page (it covers the full sheet,
// margin included; its margin is blank), centre ticks on all four sides, orientation text
// ("this side up", "this edge left" ...), and a 100 mm ruler (shorter, and saying so, on sheets
// under 125 mm). All marks in the margin, pure black but for the alarm. An sRGB picture carries
// `profile` itself; inks go to the printer as they are, and the profile says what they were made
// for (the output intent). Throws InputError if it cannot be written.
void write_print_pdf(const std::filesystem::path& path, const Picture& picture,
                     const std::vector<std::uint8_t>& profile, const SheetOptions& options,
                     const RunContext& context);

}  // namespace hydrodip
