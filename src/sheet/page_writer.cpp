#include "sheet/page_writer.h"

#include <algorithm>

namespace hydrodip {
PageWriter::PageWriter(PdfDocument& pdf, const PaperSize& paper) : pdf_(pdf), paper_(paper) {
  new_page();
}

void PageWriter::new_page() {
  pdf_.add_page(paper_.width_mm, paper_.height_mm);
  y = paper_.height_mm - kMargin_mm;
}

void PageWriter::text(double x, double base, const std::string& words, double size_pt, PdfFont font,
                      double gray) {
  pdf_.draw_text({words, {x, base}, size_pt, font, 0, gray});
}

double PageWriter::width_of(const std::string& words, double size_pt, PdfFont font) const {
  return pdf_.text_width(words, font) * size_pt * kMmPerPt;
}

void PageWriter::paragraph(double x, double width_mm, const std::string& words, double size_pt,
                           PdfFont font, double gray) {
  const double line_mm = 1.3 * size_pt * kMmPerPt;
  for (const std::string& line : wrapped(words, width_mm, size_pt, font)) {
    y -= line_mm;
    text(x, y + 0.3 * line_mm, line, size_pt, font, gray);
  }
}

void PageWriter::heading(const std::string& words) {
  y -= 8;
  text(left(), y, words, kHead_pt, PdfFont::kBold);
  y -= 1.6;
  rule(left(), right(), y, 0.3, 0.6);
  y -= 1;
}

void PageWriter::rule(double from, double to, double base, double width_mm, double gray) {
  pdf_.set_stroke(width_mm, gray);
  pdf_.draw_lines({{Vec2(from, base), Vec2(to, base)}});
}

void PageWriter::task(const std::string& words, const std::vector<std::string>& blanks) {
  constexpr double kBox_mm = 4, kIndent_mm = 7.5;
  const double top = y - 1.6;
  pdf_.set_stroke(0.35);
  pdf_.draw_rectangle({Vec2(left(), top - kBox_mm), Vec2(left() + kBox_mm, top)});
  y -= 0.9;
  paragraph(left() + kIndent_mm, width() - kIndent_mm, words, kBody_pt);
  if (!blanks.empty()) fill_in(left() + kIndent_mm, blanks);
  y -= blanks.empty() ? 1.7 : 2.8;
}

void PageWriter::fill_in(double x, const std::vector<std::string>& labels) {
  constexpr double kFewest = 3;
  y -= 6.4;
  const double each = (right() - x) / std::max(kFewest, double(labels.size()));
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const double at = x + double(i) * each;
    text(at, y, labels[i], kBody_pt, PdfFont::kRegular, 0.25);
    rule(at + width_of(labels[i], kBody_pt, PdfFont::kRegular) + 1.5, at + each - kGap_mm, y - 0.6,
         0.25, 0.3);
  }
}

std::vector<std::string> PageWriter::wrapped(const std::string& words, double width_mm,
                                             double size_pt, PdfFont font) const {
  std::vector<std::string> lines;
  std::string line;
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    const std::string word = words.substr(begin, end - begin);
    std::string longer = line;
    if (!longer.empty()) longer += ' ';
    longer += word;
    if (!line.empty() && width_of(longer, size_pt, font) > width_mm) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
    begin = end + 1;
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

}  // namespace hydrodip
