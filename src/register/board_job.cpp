#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "camera/board.h"
#include "job/sheet_of.h"
#include "register/register.h"
#include "settings/settings.h"
#include "sheet/page_writer.h"

namespace hydrodip {
namespace {

constexpr double kStripGap_mm = 5, kLine_mm = 0.1;

PaperSize paper_named(const std::string& name) {
  const std::string wanted = name.empty() ? "a4" : name;
  for (const FilmFormat& format : film_formats())
    if (format.name == wanted && (wanted == "a4" || wanted == "letter"))
      return {format.width_mm, format.height_mm};
  throw InputError(fmt::format("--paper: '{}' is neither a4 nor letter", name));
}

void draw_strip(PdfDocument& pdf, int strip, const Vec2& middle) {
  const Vec2 half(0.5 * kStripLength_mm, 0.5 * kStripHeight_mm);
  pdf.set_stroke(kLine_mm, 0.6);
  pdf.draw_rectangle({middle - half, middle + half});
  for (MarkPlace mark : strip_marks(strip)) {
    mark.corner += middle;
    for (const Box2& box : mark_boxes(mark)) pdf.fill_rectangle(box, 0);
  }
}

void write_board(const std::filesystem::path& path, const PaperSize& paper,
                 const PrinterScale& printer) {
  PdfDocument pdf;
  pdf.forbid_scaling();
  pdf.set_title("hydrodip: marks for the tank's rim");
  PageWriter page(pdf, paper);
  // What the printer errs by would be taken for the film's swelling.
  if (!printer.is_true())
    pdf.transform_about(0.5 * Vec2(paper.width_mm, paper.height_mm), printer.undone());
  page.y -= 5;
  page.text(page.left(), page.y, "Marks for the tank's rim", PageWriter::kHead_pt, PdfFont::kBold);
  page.y -= 1;
  page.paragraph(
      page.left(), page.width(),
      fmt::format("Print at 100 %. A strip measures {:g} x {:g} mm. Glue each strip flat onto a "
                  "stiff, even piece, and four of them onto the rim, one on every side, strip 1 "
                  "along the film's top edge. Keep them dry, level and unmoved; then photograph "
                  "them: hydrodip register --calibrate-camera PHOTOS",
                  kStripLength_mm, kStripHeight_mm),
      PageWriter::kSmall_pt);
  page.y -= 2;
  for (int strip = 0; strip < kBoardStrips; ++strip) {
    const Vec2 middle(0.5 * paper.width_mm, page.y - 0.5 * kStripHeight_mm);
    draw_strip(pdf, strip, middle);
    page.text(middle.x() - 0.5 * kStripLength_mm, page.y - kStripHeight_mm - 3,
              fmt::format("strip {}{}", strip + 1, strip == 4 ? ", a spare one" : ""), 6);
    page.y -= kStripHeight_mm + kStripGap_mm;
  }
  pdf.save(path);
}

}  // namespace

JobResult board_job(const JobConfig& config, const std::string& paper, const RunContext& context) {
  const PaperSize size = paper_named(paper);
  const std::filesystem::path& folder = config.output;
  OutputFolder output(folder, config.earlier_result);
  output.announce({"board.pdf"}, config.settings_files);
  write_board(output.path("board.pdf"), size, printer_of(config.print));
  context.check_cancelled();
  output.commit();
  JobResult result;
  result.folder = folder;
  result.files = {"board.pdf"};
  result.text = output.told_replaced() + fmt::format("wrote {}\n", (folder / "board.pdf").string());
  result.json =
      json_answer("register board", {{"folder", folder.string()}, {"files", result.files}});
  return result;
}

}  // namespace hydrodip
