#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "image/files.h"
#include "image/picture_file.h"
#include "job/profile_jobs.h"
#include "register/register.h"
#include "register/true_size.h"
#include "settings/profiles.h"
#include "settings/settings.h"
#include "sheet/page_writer.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSheetFile = "printer-test.pdf";
constexpr const char* kProfileFile = "printer.toml";
constexpr double kLine_mm = 0.1;
constexpr double kVernier_mm = 0.95;
constexpr int kVernierLines = 20;

// Draws along one side of the rectangle: `along` to its other end, `inward` into the sheet.
class Rule {
 public:
  Rule(PdfDocument& pdf, const Vec2& from, const Vec2& along, const Vec2& inward, double length_mm)
      : pdf_(pdf), from_(from), along_(along), inward_(inward), length_mm_(length_mm) {}

  void draw() {
    line(0, length_mm_, 0, 0);
    for (int mm = 0; mm <= int(length_mm_); ++mm) {
      line(mm, mm, 0, mm % 10 == 0 ? 4 : mm % 5 == 0 ? 3 : 2);
      if (mm > 0 && mm % 10 == 0) label(mm, 4.6, std::to_string(mm), 5);
    }
    vernier();
  }

 private:
  // On the far side of the line, from its end back.
  void vernier() {
    for (int k = 0; k <= kVernierLines; ++k) {
      const double at = length_mm_ - k * kVernier_mm;
      line(at, at, 0, k % 5 == 0 ? -3.2 : -2.2);
      if (k % 5 == 0)
        label(at, -5.4, fmt::format("{:g}", 0.05 * ((kVernierLines - k) % kVernierLines)), 4.5);
    }
  }

  Vec2 at(double along_mm, double inward_mm) const {
    return from_ + along_mm * along_ + inward_mm * inward_;
  }
  void line(double from_mm, double to_mm, double begin_mm, double end_mm) {
    pdf_.draw_lines({{at(from_mm, begin_mm), at(to_mm, end_mm)}});
  }
  void label(double along_mm, double inward_mm, const std::string& words, double size_pt) {
    const double width = pdf_.text_width(words) * size_pt * kMmPerPt;
    const double height = 0.72 * size_pt * kMmPerPt;
    const Vec2 middle =
        at(along_mm, inward_mm) +
        (inward_mm > 0 ? 0.5 : -0.5) * (inward_.cwiseAbs().dot(Vec2(width, height))) * inward_;
    pdf_.draw_text({words, middle - 0.5 * Vec2(width, height), size_pt, PdfFont::kRegular, 0, 0});
  }

  PdfDocument& pdf_;
  Vec2 from_, along_, inward_;
  double length_mm_;
};

// "--film letter " where that is not the usual one.
std::string film_option(double width_mm, double height_mm) {
  for (const FilmFormat& format : film_formats()) {
    if (format.width_mm == width_mm && format.height_mm == height_mm)
      return format.name == "a4" ? "" : fmt::format("--film {} ", format.name);
    if (format.width_mm == height_mm && format.height_mm == width_mm)
      return fmt::format("--film {}-landscape ", format.name);
  }
  return fmt::format("--film {:g}x{:g} ", width_mm, height_mm);
}

void draw_test_sheet(const std::filesystem::path& path, double width_mm, double height_mm) {
  const TestSheet sheet = test_sheet(width_mm, height_mm);
  PdfDocument pdf;
  pdf.forbid_scaling();
  pdf.set_title("hydrodip: printer test");
  PageWriter page(pdf, {width_mm, height_mm});
  const Vec2 middle = 0.5 * Vec2(width_mm, height_mm);
  const Vec2 half = 0.5 * Vec2(sheet.across_mm, sheet.along_mm);
  pdf.set_stroke(kLine_mm);
  const auto corner = [&](const char* name, double x, double y) {
    const Vec2 at = middle + Vec2(x * half.x(), y * half.y());
    pdf.draw_lines({{at - Vec2(4, 0), at + Vec2(4, 0)}, {at - Vec2(0, 4), at + Vec2(0, 4)}});
    page.text(at.x() + (x < 0 ? -5 : 3), at.y() + (y < 0 ? -6.5 : 3), name, 11, PdfFont::kBold);
  };
  corner("A", -1, -1);
  corner("B", 1, -1);
  corner("C", -1, 1);
  corner("D", 1, 1);
  Rule(pdf, middle - half, Vec2::UnitX(), Vec2::UnitY(), sheet.across_mm).draw();
  Rule(pdf, middle - half, Vec2::UnitY(), Vec2::UnitX(), sheet.along_mm).draw();
  for (MarkPlace mark : sheet.marks) {
    mark.corner += middle;
    for (const Box2& box : mark_boxes(mark)) pdf.fill_rectangle(box, 0);
  }
  constexpr double kWidest_mm = 110, kTitle_mm = 4;
  const Box2 room = sheet.words();
  const double width = std::min(kWidest_mm, room.max.x() - room.min.x());
  const double left = middle.x() + 0.5 * (room.min.x() + room.max.x() - width);
  page.y = middle.y() + room.max.y() - kTitle_mm;
  const auto say = [&](const std::string& words) {
    page.paragraph(left, width, words, PageWriter::kSmall_pt);
    page.y -= 1.5;
  };
  page.text(left, page.y, "Printer test", PageWriter::kHead_pt, PdfFont::kBold);
  page.y -= 1;
  say("Print at 100 %, no scaling, with the driver's settings and the way into the printer that "
      "your film will have.");
  const std::string film = film_option(width_mm, height_mm);
  say(
      fmt::format("With a scanner: scan it at 300 dpi and more, then hydrodip calibrate printer "
                  "{}--scan IMAGE.",
                  film));
  say(fmt::format(
      "With a steel rule: lay its zero on A and read the lengths A-B (drawn {:g} mm), A-C ({:g} "
      "mm), A-D and C-B ({:.2f} mm). At B and C read whole millimetres at the cross; the part of a "
      "millimetre is told by the outer line that meets one of the rule's. Then hydrodip calibrate "
      "printer {}--readings AB,AC,AD,CB.",
      sheet.across_mm, sheet.along_mm, std::hypot(sheet.across_mm, sheet.along_mm), film));
  pdf.save(path);
}

PrinterScale found_scale(const JobConfig& config, const PrinterRequest& request,
                         const RunContext& context) {
  const TestSheet sheet = test_sheet(config.design.film.width_mm, config.design.film.height_mm);
  if (request.readings) return scale_by(*request.readings, sheet);
  const std::vector<std::uint8_t> bytes = read_picture(request.scan);
  const Image scan = decode_image(bytes, request.scan.string());
  const Resolution recorded = recorded_resolution(bytes);
  if (!(request.scan_dpi > 0) && !recorded.is_one())
    throw InputError(fmt::format(
        "{}: the picture has {:g} dpi across and {:g} along; scan it with one resolution for both "
        "directions",
        request.scan.string(), recorded.across_dpi, recorded.along_dpi));
  const double dpi = request.scan_dpi > 0 ? request.scan_dpi : recorded.across_dpi;
  if (!(dpi > 0))
    throw InputError(fmt::format("{}: the picture does not say its resolution; give --scan-dpi",
                                 request.scan.string()));
  return scale_by(find_marks(gray_of(scan), context), dpi, sheet, request.scan.string());
}

Setting setting(const char* name, double value) {
  const std::string text = fmt::format("{:.6g}", value);
  return {name, text, false, "'" + text + "'", "calibrate printer"};
}

JobResult test_sheet_written(const JobConfig& config, const RunContext& context) {
  OutputFolder output(config.output, config.earlier_result);
  output.announce({kSheetFile}, {});
  draw_test_sheet(output.path(kSheetFile), config.design.film.width_mm,
                  config.design.film.height_mm);
  context.check_cancelled();
  output.commit();
  JobResult result;
  result.folder = config.output;
  result.files = {kSheetFile};
  result.text = output.told_replaced();
  result.text += fmt::format("wrote {}\n", (config.output / kSheetFile).string());
  result.json = json_answer("calibrate printer",
                            {{"folder", config.output.string()}, {"files", result.files}});
  return result;
}

}  // namespace

JobResult printer_job(const JobConfig& config, const PrinterRequest& request,
                      const RunContext& context) {
  const RunScope scope(context.with_threads(config.threads));
  if (!request.readings && request.scan.empty()) return test_sheet_written(config, context);
  const PrinterScale scale = found_scale(config, request, context);
  const double skew_deg = std::atan(scale.skew / scale.y) * 180 / std::numbers::pi;
  ProfileEdit edit;
  edit.add.sets = {setting("print.scale_x", scale.x), setting("print.scale_y", scale.y),
                   setting("print.skew_deg", skew_deg)};
  JobResult result;
  std::string where;
  if (!request.profile.empty()) {
    result = save_profile(request.profile_folder, request.profile, edit);
    where = result.text;
  } else {
    OutputFolder output(config.output, config.earlier_result);
    output.announce({kProfileFile}, config.settings_files);
    write_file(output.path(kProfileFile), edited_profile({}, edit));
    context.check_cancelled();
    output.commit();
    result.folder = config.output;
    result.files = {kProfileFile};
    where = output.told_replaced() + fmt::format("wrote {0}; print with --profile {0}\n",
                                                 (config.output / kProfileFile).string());
  }
  result.text = fmt::format(
      "the printer makes {:.4f} mm across and {:.4f} mm along of a millimetre, and leans by "
      "{:+.3f} degrees; print.pdf is drawn the other way from now on\n{}",
      scale.x, scale.y, skew_deg, where);
  result.json = json_answer("calibrate printer", {{"folder", result.folder.string()},
                                                  {"scale_x", scale.x},
                                                  {"scale_y", scale.y},
                                                  {"skew_deg", skew_deg}});
  return result;
}

}  // namespace hydrodip
