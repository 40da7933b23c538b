#include <Eigen/LU>

#include "sheet/marks.h"
#include "sheet/page.h"
#include "sheet/pdf_document.h"
#include "sheet/sheet.h"

namespace hydrodip {

namespace {

void draw_marks(PdfDocument& document, const SheetOptions& options, const RunContext& context) {
  const Marks marks =
      make_marks(options, [&](const std::string& text) { return document.text_width(text); });
  document.set_stroke(marks.line_mm, 0, true);
  std::vector<PdfLine> lines;
  for (const MarkLine& line : marks.lines) lines.push_back({line.from, line.to});
  document.draw_lines(lines);
  document.set_stroke(marks.line_mm);
  for (const MarkCircle& circle : marks.dashed)
    document.draw_dashed_circle(circle.center, circle.radius_mm);
  for (const Box2& box : marks.boxes) document.fill_rectangle(box, 0);
  for (const auto& corners : marks.filled) document.fill_triangle(corners, 0);
  for (const MarkText& text : marks.texts)
    document.draw_text(
        {text.text, text.start, text.size_pt, PdfFont::kRegular, text.quarter_turns, 0});
  for (const MarkBand& band : marks.bands) {
    document.fill_red(band.box);
    document.draw_text({band.text.text, band.text.start, band.text.size_pt, PdfFont::kRegular,
                        band.text.quarter_turns, 1});
  }
  for (const std::string& warning : marks.warnings) context.warn(warning);
}

// What the printer will stretch and lean over is drawn the other way before.
void draw_true(PdfDocument& document, const SheetOptions& options) {
  const PrinterScale& printer = options.printer;
  if (printer.is_true()) return;
  Mat2 prints;
  prints << printer.x, printer.skew, 0, printer.y;
  document.transform_about(0.5 * Vec2(options.width_mm, options.height_mm), prints.inverse());
}

}  // namespace

void write_print_pdf(const std::filesystem::path& path, const Picture& picture,
                     const std::vector<std::uint8_t>& profile, const SheetOptions& options,
                     const RunContext& context) {
  check_sheet(picture, options);
  PdfDocument document;
  document.forbid_scaling();
  document.set_title(options.job_name);
  if (!options.date.empty()) document.set_date(options.date);
  document.add_page(options.width_mm, options.height_mm);

  draw_true(document, options);

  const bool mirror = !options.ink_side_up;
  const PixelBox box = printed_box(picture);
  if (!box.empty()) {
    const PixelBox printed = mirror ? mirrored(box, picture.width_px) : box;
    document.draw_image(picture, profile, box, mirror, place_on_page(printed, picture, options),
                        context);
  }
  draw_marks(document, options, context);
  document.save(path);
  context.progress("writing the PDF", 1);
}

}  // namespace hydrodip
