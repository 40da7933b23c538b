// A PDF as pages of pictures, lines and text; what is behind it stays in the .cpp. Everything is
// drawn on the page added last. Page coordinates: mm from the page's lower left corner, y up. Grey:
// 0 black, 1 white.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/math.h"
#include "sheet/page.h"
#include "sheet/picture.h"

namespace hydrodip {

enum class PdfFont { kRegular, kBold };

struct PdfText {
  std::string text;  // UTF-8
  Vec2 start;        // left end of the base line
  double size_pt = 10;
  PdfFont font = PdfFont::kRegular;
  int quarter_turns = 0;  // 0: upright; 1: reads upward; -1: reads downward
  double gray = 0;
};

using PdfLine = std::array<Vec2, 2>;

class PdfDocument {
 public:
  PdfDocument();
  ~PdfDocument();
  PdfDocument(const PdfDocument&) = delete;
  PdfDocument& operator=(const PdfDocument&) = delete;

  void forbid_scaling();  // asks viewers to print at 100 %
  void set_title(const std::string& utf8);
  void set_date(const std::string& iso);  // throws InputError for what is no date

  // Throws InputError if the PDF format has no such page.
  void add_page(double width_mm, double height_mm);

  // Everything drawn on this page from here on is multiplied by `matrix` about `center`.
  void transform_about(const Vec2& center, const Mat2& matrix);

  // The block of the picture, over white, filling `place`. Its pixels must live until save(). An
  // sRGB picture carries the profile itself; for inks it becomes the output intent. Empty: none.
  void draw_image(const Picture& picture, const std::vector<std::uint8_t>& profile,
                  const PixelBox& box, bool mirror, const Box2& place, const RunContext& context);
  // For lines, circles and outlines from here on, on this page.
  void set_stroke(double width_mm, double gray = 0, bool square_ends = false);
  void draw_lines(const std::vector<PdfLine>& lines);
  void draw_dashed_circle(const Vec2& center, double radius_mm);
  void draw_rectangle(const Box2& box);
  void fill_rectangle(const Box2& box, double gray);
  void fill_red(const Box2& box);  // of an alarm
  void fill_triangle(const std::array<Vec2, 3>& corners, double gray);
  // Letters that the PDF's own fonts lack are drawn as this machine's fonts have them
  // (page_text.h); readers find them as text all the same.
  void draw_text(const PdfText& text);

  // Width of an UTF-8 text at font size 1.
  double text_width(const std::string& text, PdfFont font = PdfFont::kRegular) const;

  // Throws InputError if the file cannot be written, Cancelled if the job was cancelled.
  void save(const std::filesystem::path& path);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydrodip
