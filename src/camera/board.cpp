#include "camera/board.h"

#include "sheet/film_marks.h"

namespace hydrodip {
namespace {

constexpr double kBlock_mm = kStripHeight_mm / 2;
// White around them.
constexpr double kCell_mm = 1.7;

}  // namespace

std::vector<MarkPlace> strip_marks(int strip) {
  std::vector<MarkPlace> marks;
  for (int n = 0; n < kStripMarks; ++n) {
    // The lower row's corners stand below the upper row's tags.
    const bool lower = n >= kStripMarks / 2;
    const int block = 2 * (n % (kStripMarks / 2)) + (lower ? 0 : 1);
    const Vec2 corner((block + 0.5) * kBlock_mm - 0.5 * kStripLength_mm,
                      (lower ? -0.5 : 0.5) * kBlock_mm);
    marks.push_back(
        {kFirstBoardTag + kStripMarks * strip + n, corner, Vec2(lower ? -1 : 1, 0), kCell_mm});
  }
  return marks;
}

StripPlace strip_place(int tag) {
  const int number = tag - kFirstBoardTag;
  if (number < 0 || number >= kBoardStrips * kStripMarks) return {};
  const int strip = number / kStripMarks;
  return {strip, strip_marks(strip)[std::size_t(number % kStripMarks)].corner};
}

}  // namespace hydrodip
