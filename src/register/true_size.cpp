#include "register/true_size.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace hydrodip {
namespace {

constexpr int kFirstPrinterTag = 500;
constexpr double kCell_mm = 1;
constexpr double kLeastSide_mm = 120;
constexpr double kWorstScale = 0.1, kWorstLean = 0.08;
// A steel rule is read to about 0.1 mm.
constexpr double kWorstClosure_mm = 0.6;
constexpr std::size_t kLeastMarks = 5;
constexpr double kWorstFit_mm = 0.3;

PrinterScale checked(const PrinterScale& scale, const std::string& what) {
  const bool likely = std::abs(scale.x - 1) < kWorstScale && std::abs(scale.y - 1) < kWorstScale &&
                      std::abs(scale.skew) < kWorstLean;
  if (!likely)
    throw InputError(fmt::format(
        "{}: that would be a printer that makes {:.3f} mm across and {:.3f} mm along of a "
        "millimetre; check the page's size (--film), that it was printed at 100 %, and what was "
        "measured",
        what, scale.x, scale.y));
  return scale;
}

}  // namespace

TestSheet test_sheet(double width_mm, double height_mm) {
  if (std::min(width_mm, height_mm) < kLeastSide_mm)
    throw InputError(
        fmt::format("the test sheet needs a page of {:g} mm at least; choose another "
                    "--film",
                    kLeastSide_mm));
  TestSheet sheet;
  sheet.across_mm = 10 * std::floor((width_mm - 30) / 10);
  sheet.along_mm = 10 * std::floor((height_mm - 40) / 10);
  const Vec2 far(0.5 * sheet.across_mm - 30, 0.5 * sheet.along_mm - 30);
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
  return checked({x, std::sqrt(std::max(0.0, along * along - skew * skew)), skew}, "--readings");
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
        "{}: {} of the test sheet's {} marks are to be seen, and {} are needed; scan the sheet "
        "that 'hydrodip calibrate printer' draws for this page whole, sharp and not mirrored",
        name, found.size(), sheet.marks.size(), kLeastMarks));
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
  return checked(scale, name);
}

}  // namespace hydrodip
