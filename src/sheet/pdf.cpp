#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "sheet/marks.h"
#include "sheet/page.h"
#include "sheet/page_text.h"
#include "sheet/pdf_document.h"
#include "sheet/sheet.h"
#include "transfer/raster.h"

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
  // Where there is room for it.
  if (!marks.texts.empty())
    warn_of_lost_letters("the job's name", options.job_name, "the PDF's margin", context);
}

// Whether nothing is printed there, nor a line's width beside it. From the image's middle.
bool is_blank(const Picture& picture, const SheetOptions& options, const Vec2& at_mm) {
  constexpr double kGap_mm = 0.3;
  const SheetRaster raster{options.width_mm, options.height_mm, options.dpi};
  const double x = raster.to_pixel(at_mm).x(), y = raster.to_pixel(at_mm).y();
  const double gap = options.dpi / kMmPerInch * kGap_mm;
  const auto pixel = [](double at, int count) { return std::clamp(int(std::floor(at)), 0, count); };
  for (int row = pixel(y - gap, picture.height_px); row < pixel(y + gap + 1, picture.height_px);
       ++row)
    for (int column = pixel(x - gap, picture.width_px);
         column < pixel(x + gap + 1, picture.width_px); ++column)
      if (picture.is_printed(column, row)) return false;
  return true;
}

// In pieces that are drawn or not. Seen from above, as the image; on the page perhaps mirrored.
void draw_outlines(PdfDocument& document, const Picture& picture, const SheetOptions& options) {
  constexpr double kPiece_mm = 0.5, kLine_mm = 0.1, kGray = 0.4;
  const Vec2 middle = 0.5 * Vec2(options.width_mm, options.height_mm);
  const Vec2 free = middle - Vec2::Constant(options.margin_mm);
  const auto on_page = [&](const Vec2& at) {
    return Vec2(middle + (options.ink_side_up ? at : Vec2(-at.x(), at.y())));
  };
  const auto is_free = [&](const Vec2& at) {
    return (at.cwiseAbs().array() < free.array()).all() && is_blank(picture, options, at);
  };
  std::vector<PdfLine> lines;
  for (const auto& [from, to] : options.outlines) {
    const int pieces = std::max(1, int(std::ceil((to - from).norm() / kPiece_mm)));
    for (int i = 0; i < pieces; ++i) {
      const Vec2 a = from + (to - from) * i / pieces;
      const Vec2 b = from + (to - from) * (i + 1) / pieces;
      if (is_free(a) && is_free(b)) lines.push_back({on_page(a), on_page(b)});
    }
  }
  if (lines.empty()) return;
  document.set_stroke(kLine_mm, kGray);
  document.draw_lines(lines);
}

// What the printer will stretch and lean over is drawn the other way before.
void draw_true(PdfDocument& document, const SheetOptions& options) {
  if (options.printer.is_true()) return;
  document.transform_about(0.5 * Vec2(options.width_mm, options.height_mm),
                           options.printer.undone());
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
  draw_outlines(document, picture, options);
  draw_marks(document, options, context);
  document.save(path);
  context.progress("writing the PDF", 1);
}

}  // namespace hydrodip
