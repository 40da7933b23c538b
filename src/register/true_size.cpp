#include "register/true_size.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "settings/settings.h"
#include "sheet/film_marks.h"

namespace hydrodip {
namespace {

constexpr int kFirstPrinterTag = 500;
constexpr double kCell_mm = 1;
constexpr double kLeastSide_mm = 180;
// Printers are off by less than a percent.
constexpr double kWorstScale = 0.03, kWorstLean = 0.03;
// A steel rule is read to about 0.1 mm.
constexpr double kWorstClosure_mm = 0.6;
constexpr std::size_t kLeastMarks = 5;
constexpr double kWorstFit_mm = 0.3;

bool is_likely(double x, double y) {
  return std::abs(x - 1) < kWorstScale && std::abs(y - 1) < kWorstScale;
}

// How far apart the outermost marks of a sheet stand from its middle.
Vec2 far_marks(const TestSheet& sheet) {
  return {0.5 * sheet.across_mm - 30, 0.5 * sheet.along_mm - 30};
}

// Why no printer is so far off. `of(sheet)`: the lengths that were measured, drawn on that sheet.
template <class LengthsOf>
std::string likely_cause(const PrinterScale& scale, const TestSheet& sheet, bool scanned,
                         const LengthsOf& of) {
  const Vec2 measured(scale.x * of(sheet).x(), scale.y * of(sheet).y());
  for (const FilmFormat& format : film_formats())
    for (const bool landscape : {false, true}) {
      const double width_mm = landscape ? format.height_mm : format.width_mm,
                   height_mm = landscape ? format.width_mm : format.height_mm;
      if (std::min(width_mm, height_mm) < kLeastSide_mm) continue;
      const Vec2 other = of(test_sheet(width_mm, height_mm));
      if (is_likely(measured.x() / other.x(), measured.y() / other.y()))
        return fmt::format("they are those of another page's test sheet: give --film {}{}",
                           format.name, landscape ? "-landscape" : "");
    }
  for (const auto& [name, mm] : {std::pair{"inches", 25.4}, std::pair{"centimetres", 10.0}})
    if (!scanned && is_likely(scale.x * mm, scale.y * mm))
      return fmt::format("the readings seem to be in {}: give millimetres", name);
  if (std::abs(scale.x / scale.y - 1) < kWorstScale)
    return scanned ? "was the sheet printed to fit the page? Print it at 100 %, without any "
                     "scaling; else check --scan-dpi"
                   : "was the sheet printed to fit the page? Print it at 100 %, without any "
                     "scaling, and measure again";
  return "check the page's size (--film), that it was printed at 100 %, and what was measured";
}

// Of marks or crosses: lengths that were drawn, and no printer makes so much else of.
template <class LengthsOf>
PrinterScale checked(const PrinterScale& scale, const TestSheet& sheet, const std::string& what,
                     bool scanned, const LengthsOf& of) {
  if (is_likely(scale.x, scale.y) && std::abs(scale.skew) < kWorstLean) return scale;
  throw InputError(fmt::format(
      "{}: that would be a printer that makes {:.3f} mm across and {:.3f} mm along of a "
      "millimetre, and none is so far off; {}",
      what, scale.x, scale.y, likely_cause(scale, sheet, scanned, of)));
}

// What is wrong with a picture that shows few of the sheet's marks.
std::string other_marks(const std::vector<SeenMark>& seen) {
  const auto any = [&](int from, int to) {
    return std::any_of(seen.begin(), seen.end(),
                       [&](const SeenMark& mark) { return mark.id >= from && mark.id < to; });
  };
  if (any(0, kFirstBoardTag)) return "; it shows the marks of a job's film";
  if (any(kFirstBoardTag, kFirstPrinterTag)) return "; it shows the strips for the tank's rim";
  return "";
}

}  // namespace

// The row and the column through the middle have a mark at both ends and none between.
Box2 TestSheet::words() const {
  constexpr double kGap_mm = 3;
  const Vec2 far = far_marks(*this);
  const Box2 mark = mark_outline({0, Vec2::Zero(), Vec2::UnitX(), kCell_mm});
  const Vec2 gap = Vec2::Constant(kGap_mm);
  return {-far + mark.max + gap, far + mark.min - gap};
}

TestSheet test_sheet(double width_mm, double height_mm) {
  if (std::min(width_mm, height_mm) < kLeastSide_mm)
    throw InputError(fmt::format(
        "the test sheet needs a page of {0:g} x {0:g} mm at least; a printer errs alike "
        "on all: print it on larger paper, as with --film a4",
        kLeastSide_mm));
  TestSheet sheet;
  sheet.across_mm = 10 * std::floor((width_mm - 30) / 10);
  sheet.along_mm = 10 * std::floor((height_mm - 40) / 10);
  const Vec2 far = far_marks(sheet);
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i)
      if (i != 0 || j != 0)
        sheet.marks.push_back({kFirstPrinterTag + int(sheet.marks.size()),
                               {i * far.x(), j * far.y()},
                               Vec2::UnitX(),
                               kCell_mm});
  return sheet;
}

PrinterScale scale_by(const PrinterReadings& r, const TestSheet& sheet) {
  const double w = sheet.across_mm, h = sheet.along_mm;
  const double sides = r.across_mm * r.across_mm + r.along_mm * r.along_mm;
  const double diagonals = 0.5 * (r.rising_mm * r.rising_mm + r.falling_mm * r.falling_mm);
  const double closure_mm = std::abs(std::sqrt(sides) - std::sqrt(diagonals));
  if (!(closure_mm < kWorstClosure_mm))
    throw InputError(fmt::format(
        "--readings: the two sides and the two diagonals of a sheet cannot be so long: they miss "
        "each other by {:.2f} mm; measure A-B, A-C, A-D and C-B again",
        closure_mm));
  const double x = r.across_mm / w;
  const double skew = (r.rising_mm * r.rising_mm - r.falling_mm * r.falling_mm) / (4 * x * w * h);
  const double along = r.along_mm / h;
  return checked({x, std::sqrt(std::max(0.0, along * along - skew * skew)), skew}, sheet,
                 "--readings", false, [](const TestSheet& any) -> Vec2 {
                   return {any.across_mm, any.along_mm};
                 });
}

PrinterScale scale_by(const std::vector<SeenMark>& seen, double dpi, const TestSheet& sheet,
                      const std::string& name) {
  std::vector<Vec2> printed, found;
  for (const SeenMark& mark : seen)
    for (const MarkPlace& place : sheet.marks)
      if (place.id == mark.id) {
        printed.push_back(place.corner);
        found.push_back(kMmPerInch / dpi * Vec2(mark.corner_px.x(), -mark.corner_px.y()));
      }
  if (found.size() < kLeastMarks)
    throw InputError(fmt::format(
        "{}: {} of the test sheet's {} marks are to be seen, and {} are needed{}; scan the sheet "
        "that 'hydrodip calibrate printer' draws for this page whole, sharp and not mirrored",
        name, found.size(), sheet.marks.size(), kLeastMarks, other_marks(seen)));
  const double share = 1 / double(found.size());
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
  for (std::size_t i = 0; i < found.size(); ++i) {
    from += share * printed[i];
    to += share * found[i];
  }
  Mat2 spread = Mat2::Zero(), moved = Mat2::Zero();
  for (std::size_t i = 0; i < found.size(); ++i) {
    spread += (printed[i] - from) * (printed[i] - from).transpose();
    moved += (found[i] - to) * (printed[i] - from).transpose();
  }
  const Mat2 prints = moved * spread.inverse();
  double off_mm = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    off_mm = std::max(off_mm, (found[i] - to - prints * (printed[i] - from)).norm());
  // How the sheet lay on the scanner is left out.
  const double x = prints.col(0).norm();
  const Vec2 ahead = prints.col(0) / x;
  const PrinterScale scale{x, cross2(ahead, prints.col(1)), ahead.dot(prints.col(1))};
  if (!(off_mm < kWorstFit_mm) || !prints.allFinite())
    throw InputError(fmt::format(
        "{}: the marks are {:.2f} mm off any even stretch; lay the sheet flat and scan it again",
        name, off_mm));
  return checked(scale, sheet, name, true, far_marks);
}

}  // namespace hydrodip
