// Pages to read: titles, paragraphs, boxes to tick, blanks to fill in.
#pragma once

#include <string>
#include <vector>

#include "sheet/pdf_document.h"

namespace hydrodip {

// The paper that lies on the bench.
struct PaperSize {
  double width_mm, height_mm;
};

// Draws from the top of the page down; y is where the next thing goes. Words are UTF-8.
class PageWriter {
 public:
  static constexpr double kMargin_mm = 16, kGap_mm = 4;
  static constexpr double kBody_pt = 10, kSmall_pt = 8, kHead_pt = 12, kTitle_pt = 20;

  // Keeps a reference to the document, and begins a page.
  PageWriter(PdfDocument& pdf, const PaperSize& paper);

  double left() const { return kMargin_mm; }
  double right() const { return paper_.width_mm - kMargin_mm; }
  double width() const { return right() - left(); }
  double y = 0;  // mm from the page's bottom

  void new_page();
  void text(double x, double base, const std::string& words, double size_pt,
            PdfFont font = PdfFont::kRegular, double gray = 0);
  double width_of(const std::string& words, double size_pt, PdfFont font) const;

  // Words in lines of at most that width, from y down; moves y.
  void paragraph(double x, double width_mm, const std::string& words, double size_pt,
                 PdfFont font = PdfFont::kRegular, double gray = 0);
  void heading(const std::string& words);
  void rule(double from, double to, double base, double width_mm, double gray);
  // A box to tick, what to do, and blanks to fill in below it.
  void task(const std::string& words, const std::vector<std::string>& blanks = {});
  // "label ______" side by side.
  void fill_in(double x, const std::vector<std::string>& labels);

  PdfDocument& pdf() { return pdf_; }
  const PaperSize& paper() const { return paper_; }

 private:
  std::vector<std::string> wrapped(const std::string& words, double width_mm, double size_pt,
                                   PdfFont font) const;

  PdfDocument& pdf_;
  PaperSize paper_;
};

}  // namespace hydrodip
