// What is drawn in the sheet's margin, as plain geometry: no PDF here.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "base/math.h"
#include "sheet/sheet.h"

namespace hydrodip {

// Page coordinates: mm from the page's lower left corner, y up.
struct MarkLine {
  Vec2 from, to;
};

struct MarkText {
  std::string text;   // UTF-8
  Vec2 start;         // left end of the base line
  int quarter_turns;  // 0: upright; 1: reads upward; -1: reads downward
  double size_pt;
  double length_mm;  // along the base line
};

struct MarkCircle {
  Vec2 center;
  double radius_mm;
};

// White text on red.
struct MarkBand {
  Box2 box;
  MarkText text;
};

struct Marks {
  double line_mm = 0.2;
  std::vector<MarkLine> lines;
  std::vector<Box2> boxes;                  // filled
  std::vector<std::array<Vec2, 3>> filled;  // triangles
  std::vector<MarkText> texts;
  std::vector<MarkCircle> dashed;
  std::vector<MarkBand> bands;
  std::vector<std::string> warnings;  // what was left out, a sentence each
};

// Width of an UTF-8 text at font size 1.
using TextWidth = std::function<double(const std::string& text)>;

// Centre ticks, ruler, orientation, the alarm along the left edge, the reminder to print unscaled,
// the sheet's size, the job's name; on a disc its rim as well; what a camera looks for. Everything
// stays inside the margin. In margins under 7 mm all shrinks; texts that would be illegible or do
// not fit are left out, with a warning if they matter.
Marks make_marks(const SheetOptions& options, const TextWidth& text_width);

// The length of the ruler that a sheet of that width has in such a margin; 0: it has none.
double ruler_mm(double width_mm, double margin_mm);

}  // namespace hydrodip
