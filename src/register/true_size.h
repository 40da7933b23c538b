// How true a printer prints, from its test sheet.
#pragma once

#include <string>
#include <vector>

#include "register/register.h"
#include "sheet/sheet.h"
#include "tags/mark.h"
#include "tags/seen_marks.h"

namespace hydrodip {

// The test sheet of a page: crosses A (lower left), B, C (upper left), D in a rectangle about its
// middle, and marks for a scan; page frame about the page's middle, y up.
struct TestSheet {
  double across_mm = 180, along_mm = 250;
  std::vector<MarkPlace> marks;
  Box2 words() const;  // where there is room for them, between the marks
};
// Throws InputError for pages under 180 mm, where words and marks would run into each other.
TestSheet test_sheet(double width_mm, double height_mm);

// Throws InputError if the lengths do not fit each other, or no printer is so far off.
PrinterScale scale_by(const PrinterReadings& readings, const TestSheet& sheet);

// From a scan's marks, whichever way the sheet lay on the scanner. Throws InputError naming it.
PrinterScale scale_by(const std::vector<SeenMark>& seen, double dpi, const TestSheet& sheet,
                      const std::string& name);

}  // namespace hydrodip
