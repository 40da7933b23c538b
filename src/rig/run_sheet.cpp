#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/unicode.h"
#include "job/ways.h"
#include "plan/hold.h"
#include "rig/pictures.h"
#include "rig/rig.h"
#include "sheet/page_text.h"
#include "sheet/page_writer.h"
#include "sheet/pdf_document.h"

namespace hydrodip {
namespace {

constexpr double kMargin_mm = PageWriter::kMargin_mm;
constexpr double kGap_mm = PageWriter::kGap_mm;
constexpr int kPictureWidth_px = 480;
constexpr double kPictureAspect = 1.15;
constexpr double kBody_pt = PageWriter::kBody_pt, kSmall_pt = PageWriter::kSmall_pt;
constexpr double kHead_pt = PageWriter::kHead_pt, kTitle_pt = PageWriter::kTitle_pt;

PaperSize choose_paper(const std::string& name, const FilmOptions& film) {
  const auto& formats = film_formats();
  const auto find = [&](const std::string& wanted) {
    return std::find_if(formats.begin(), formats.end(),
                        [&](const FilmFormat& format) { return format.name == wanted; });
  };
  const auto letter = find("letter");
  const bool letter_film = std::min(film.width_mm, film.height_mm) == letter->width_mm &&
                           std::max(film.width_mm, film.height_mm) == letter->height_mm;
  const std::string wanted = !name.empty() ? name : letter_film ? "letter" : "a4";
  if (wanted != "a4" && wanted != "letter")
    throw InputError(fmt::format("--paper: '{}' is neither a4 nor letter", name));
  return {find(wanted)->width_mm, find(wanted)->height_mm};
}

class RunSheet {
 public:
  RunSheet(PdfDocument& pdf, const PaperSize& paper, const RigJob& job,
           const std::vector<PosePicture>& pictures, const RunContext& context)
      : page_(pdf, paper),
        job_(job),
        process_(job.config.process),
        pictures_(pictures),
        context_(context) {}

  void draw() {
    draw_title();
    draw_pictures();
    draw_film_and_figures();
    draw_movements();
    page_.new_page();
    draw_way_in();
    draw_tasks();
    draw_notes();
  }

 private:
  void draw_title() {
    page_.y -= 6;
    page_.text(page_.left(), page_.y, "Run sheet", kTitle_pt, PdfFont::kBold);
    page_.text(page_.left() + 46, page_.y, fitted(job_.title, page_.width() - 46, kHead_pt),
               kHead_pt);
    draw_piece();
    draw_alarm();
    page_.y -= 1;
    page_.fill_in(page_.left(), {"Date", "Operator", "Run no."});
    page_.y -= 3;
  }

  void draw_piece() {
    std::string piece = job_.batch.empty() ? "" : "Batch " + job_.batch;
    if (!job_.label.empty()) piece += (piece.empty() ? "Piece " : ", piece ") + job_.label;
    if (piece.empty()) return;
    page_.y -= 6;
    page_.text(page_.left() + 46, page_.y, fitted(piece, page_.width() - 46, kBody_pt), kBody_pt,
               PdfFont::kBold);
  }

  // What the verdict forbids is seen first.
  void draw_alarm() {
    if (job_.alarm.empty()) return;
    constexpr double kLine_mm = 5.4, kEdge_mm = 2.6;
    const std::vector<std::string> lines = lines_of(job_.alarm, page_.width() - 8);
    const double band_mm = kEdge_mm + kLine_mm * double(lines.size());
    page_.y -= 3 + band_mm;
    page_.pdf().fill_red({Vec2(page_.left(), page_.y), Vec2(page_.right(), page_.y + band_mm)});
    double base = page_.y + band_mm - kLine_mm;
    for (const std::string& line : lines) {
      page_.pdf().draw_text({line, Vec2(page_.left() + 4, base), kHead_pt, PdfFont::kBold, 0, 1});
      base -= kLine_mm;
    }
  }

  // Of bold letters: as many words on a line as fit, on two lines at most.
  std::vector<std::string> lines_of(const std::string& text, double width_mm) const {
    std::vector<std::string> lines(1);
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find(' ', at), text.size());
      const std::string word = text.substr(at, end - at);
      const std::string more = lines.back().empty() ? word : lines.back() + " " + word;
      if (lines.size() < 2 && !lines.back().empty() &&
          page_.width_of(more, kHead_pt, PdfFont::kBold) > width_mm)
        lines.push_back(word);
      else
        lines.back() = more;
      at = end + 1;
    }
    lines.back() = fitted(lines.back(), width_mm, kHead_pt, PdfFont::kBold);
    return lines;
  }

  std::string fitted(const std::string& text, double width_mm, double size_pt,
                     PdfFont font = PdfFont::kRegular) const {
    constexpr std::size_t kLongest = 1000;  // bytes, more than any line takes
    std::string words = cut_utf8(text, kLongest);
    if (page_.width_of(words, size_pt, font) <= width_mm) return words;
    std::size_t fits = 0, too_long = words.size();
    while (too_long - fits > 1) {
      const std::size_t bytes = (fits + too_long) / 2;
      const double width_then = page_.width_of(cut_utf8(words, bytes) + "...", size_pt, font);
      (width_then <= width_mm ? fits : too_long) = bytes;
    }
    return cut_utf8(words, fits) + "...";
  }

  // Goes on where the object's size ends.
  std::string how_to_hang() const {
    const std::string otherwise = hung_otherwise(job_);
    const std::string also = otherwise.empty() ? "" : ", " + otherwise;
    if (moves_aside(job_))
      return also +
             ". Shown as it first meets the water; from there along the way in on page 2, x along "
             "the film's width.";
    if (otherwise.empty())
      return ". Hang it over the middle of the film, x along the film's width.";
    return ". Hang it over the middle of the film" + also +
           ": as the pictures show it. It stays like that all the way down.";
  }

  void draw_pictures() {
    page_.heading("How the object hangs");
    page_.y -= 1;
    const double count = double(pictures_.size());
    const double width = (page_.width() - (count - 1) * kGap_mm) / count;
    const double height = width / kPictureAspect;
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      const double x = page_.left() + double(i) * (width + kGap_mm);
      const Image& image = pictures_[i].image;
      page_.pdf().draw_image(image, {}, {0, 0, image.width_px, image.height_px}, false,
                             {Vec2(x, page_.y - height), Vec2(x + width, page_.y)}, context_);
      page_.text(x, page_.y - height - 4, pictures_[i].caption, kSmall_pt, PdfFont::kRegular, 0.25);
    }
    page_.y -= height + 6.5;
    const Vec3& size = job_.object_size_mm;
    const PoseOptions& pose = job_.config.object.pose;
    std::string words = fmt::format(
        "The object is {} ({}): {:.1f} mm wide (x), {:.1f} mm deep (y), {:.1f} mm high (z)",
        describe_hold(pose, way_up(job_.config)), hold_options(pose), size.x(), size.y(), size.z());
    page_.paragraph(page_.left(), page_.width(), words + how_to_hang(), kBody_pt);
  }

  void draw_film_and_figures() {
    page_.heading("Film and figures");
    const double top = page_.y;
    const double half = 0.42 * page_.width();
    draw_film(page_.left(), top - 3, half - 2 * kGap_mm, top - 3 - kMargin_mm - 14);
    draw_figures(page_.left() + half, page_.right(), top);
  }

  // The sheet as it floats, from above.
  void draw_film(double x, double top, double width, double height) {
    const FilmOptions& film = job_.config.design.film;
    PdfDocument& pdf = page_.pdf();
    const double scale = std::min(width / film.width_mm, std::min(height, 86.0) / film.height_mm);
    const Vec2 size(scale * film.width_mm, scale * film.height_mm);
    const Vec2 corner(x + 0.5 * (width - size.x()), top - size.y());
    const Box2 sheet{corner, corner + size};
    const Vec2 margin = Vec2::Constant(scale * film.margin_mm);
    const Vec2 tape = Vec2::Constant(scale * tape_mm(job_.config));
    pdf.fill_rectangle(sheet, 0.88);
    pdf.fill_rectangle({sheet.min + tape, sheet.max - tape}, 1);
    pdf.set_stroke(0.3);
    pdf.draw_rectangle(sheet);
    pdf.set_stroke(0.15, 0.5);
    pdf.draw_rectangle({sheet.min + margin, sheet.max - margin});

    const Vec2 center = 0.5 * (sheet.min + sheet.max);
    const Vec2 object = 0.5 * scale * job_.object_size_mm.head<2>();
    pdf.set_stroke(0.5, 0.35);
    if (film.shape == FilmShape::kDisc) pdf.draw_dashed_circle(center, 0.5 * size.minCoeff());
    pdf.draw_rectangle({center - object, center + object});
    pdf.draw_lines(
        {{center - Vec2(3, 0), center + Vec2(3, 0)}, {center - Vec2(0, 3), center + Vec2(0, 3)}});
    centered(center.x(), center.y() - 6, "object", kSmall_pt);
    centered(center.x(), sheet.min.y() + margin.y() + 2, "front", kSmall_pt);
    centered(center.x(), sheet.max.y() - margin.y() - 4, "back: TOP of the sheet", kSmall_pt);
    page_.y = corner.y() - 0.5;
    page_.paragraph(
        x, width,
        (tape_mm(job_.config) > 0
             ? fmt::format("Seen from above; grey: {:g} mm of tape.", tape_mm(job_.config))
             : std::string("Seen from above.")) +
            (film.margin_mm > 0 ? " The edge marked 'this edge left' lies to the left." : ""),
        kSmall_pt, PdfFont::kRegular, 0.25);
  }

  void centered(double x, double base, const std::string& words, double size_pt) {
    page_.text(x - 0.5 * page_.width_of(words, size_pt, PdfFont::kRegular), base, words, size_pt,
               PdfFont::kRegular, 0.3);
  }

  void draw_figures(double x, double right, double top) {
    constexpr double kRow_mm = 7.4, kValue_mm = 34;
    const double lowest = page_.y;
    page_.y = top;
    for (const auto& [name, value] : figures()) {
      page_.y -= kRow_mm;
      page_.text(x, page_.y, name, kBody_pt, PdfFont::kRegular, 0.3);
      page_.text(x + kValue_mm, page_.y, value, kBody_pt, PdfFont::kBold);
      page_.rule(x, right, page_.y - 2.1, 0.15, 0.75);
    }
    page_.y = std::min(page_.y, lowest) - 4;
  }

  std::vector<std::pair<std::string, std::string>> figures() const {
    const JobConfig& config = job_.config;
    const Activator activator = activator_for(config);
    const std::vector<PlannedMove> plan = plan_dip(job_);
    return {
        {"Film", fmt::format("{:g} x {:g} mm, ink side {}", config.design.film.width_mm,
                             config.design.film.height_mm, ink_side())},
        {"Tape", tape_mm(config) > 0 ? fmt::format("{:g} mm all around, no slits", tape_mm(config))
                                     : std::string("none: the sheet has no margin")},
        {"Water",
         fmt::format("{} °C, {:.1f} l", span_in_words(process_.water_min_c, process_.water_max_c),
                     bath_litres(config.bath))},
        {"Soak", span_in_words(process_.soak_min_s, process_.soak_max_s) + " s"},
        {"Activator", in_words(activator)},
        {"Then wait",
         activator.mass_g > 0 ? fmt::format("{:g} s", process_.activator_wait_s) : "-"},
        {"Depth", fmt::format("{:.2f} mm from the water", job_.depth_mm)},
        {"Speed", fmt::format("{:g} mm/min", process_.speed_mm_per_min)},
        {"Dip takes",
         fmt::format("{:.1f} s in the water", 60 * in_water_mm(job_) / process_.speed_mm_per_min)},
        {"Then hold", fmt::format("{:g} s at least", process_.dwell_s)},
        {"Lift",
         fmt::format("{:g} mm/min, {:.1f} s", process_.lift_mm_per_min, plan.back().seconds)},
        {"Dry", process_.dry_max_h > 0
                    ? span_in_words(process_.dry_min_h, process_.dry_max_h) + " h"
                    : "-"}};
  }

  // For whoever sets up the stage, or dips by hand.
  void draw_movements() {
    constexpr std::array<double, 5> kColumns = {0, 42, 74, 106, 138};
    const auto row = [&](const std::array<std::string, 5>& cells, PdfFont font) {
      page_.y -= 5.6;
      for (std::size_t i = 0; i < cells.size(); ++i)
        page_.text(page_.left() + kColumns[i], page_.y, cells[i], kBody_pt, font);
    };
    page_.heading("Movements (heights of the object's lowest point over the water)");
    row({"", "from, mm", "to, mm", "mm/min", "seconds"}, PdfFont::kRegular);
    for (const PlannedMove& move : plan_dip(job_))
      row({move.phase, fmt::format("{:.2f}", move.from_height_mm),
           fmt::format("{:.2f}", move.to_height_mm),
           move.mm_per_min > 0 ? fmt::format("{:g}", move.mm_per_min) : "-",
           fmt::format("{:.1f}", move.seconds)},
          move.phase == "dip" ? PdfFont::kBold : PdfFont::kRegular);
  }

  // Where the object is when, for a way that lowering alone does not go.
  void draw_way_in() {
    if (!moves_aside(job_)) return;
    constexpr std::array<double, 7> kColumns = {0, 24, 50, 76, 102, 126, 150};
    const auto row = [&](const std::array<std::string, 7>& cells) {
      page_.y -= 5.2;
      for (std::size_t i = 0; i < cells.size(); ++i)
        page_.text(page_.left() + kColumns[i], page_.y, cells[i], kBody_pt);
    };
    page_.heading("Way in (from the first touch; turns about x, then y, then z of the bath)");
    row({"second", "lowered, mm", "shift x, mm", "shift y, mm", "turn x, \u00b0", "turn y, \u00b0",
         "turn z, \u00b0"});
    for (const WayPoint& point : job_.way_in)
      row({tenths(60 * point.travelled_mm / process_.speed_mm_per_min), tenths(point.pose.lower_mm),
           tenths(point.pose.shift_x_mm), tenths(point.pose.shift_y_mm),
           tenths(point.pose.turn_x_deg), tenths(point.pose.turn_y_deg),
           tenths(point.pose.turn_z_deg)});
    page_.y -= 2;
  }

  std::string ink_side() const {
    return job_.config.print.ink_side == InkSide::kUp ? "up" : "down";
  }

  void draw_tasks() {
    const JobConfig& config = job_.config;
    const Activator activator = activator_for(config);
    page_.heading("Before");
    if (const double ruler = ruler_mm(config); ruler > 0)
      page_.task(
          fmt::format(
              "Print print.pdf at 100 %, no scaling; measure the {:g} mm ruler in its margin.",
              ruler),
          {"Ruler, mm"});
    else
      page_.task(
          "Print print.pdf at 100 %, no scaling; it has no ruler: measure its picture against "
          "print.png's size.");
    page_.task(taping(config) + (tape_mm(config) > 0 ? ", flat and without gaps; no slits." : ".") +
               " Take the protective layer off the film.");
    page_.task(
        job_.earlier_dips > 0
            ? fmt::format("Object dry from dip {}, its coat untouched; hung as on page 1, over "
                          "the film's middle.",
                          job_.earlier_dips)
            : std::string("Object clean, dry and free of grease; hung as on page 1, over the "
                          "film's middle."));
    if (!moves_aside(job_))
      page_.task("Stage homed; water level found without film on the water; object lifted clear.",
                 {"Level, mm"});
    page_.task(fmt::format("Water {} °C, {:.1f} l.",
                           span_in_words(process_.water_min_c, process_.water_max_c),
                           bath_litres(config.bath)),
               {"Measured, °C"});
    page_.heading("Film");
    page_.task(
        fmt::format("Lay it ink side {}, beginning at one side; no bubbles below, no water on "
                    "top. Start the clock.",
                    ink_side()),
        {"Time"});
    page_.task(fmt::format("Wait {} s until it lies flat again.",
                           span_in_words(process_.soak_min_s, process_.soak_max_s)),
               {"Flat after, s"});
    if (activator.mass_g > 0) {
      page_.task(
          fmt::format("Mask on. Spray {:.2f} g of activator, {:.2f} to {:.2f} g, evenly.",
                      activator.mass_g, std::max(0.0, activator.mass_g - activator.tolerance_g),
                      activator.mass_g + activator.tolerance_g),
          {"Gun before, g", "Gun after, g", "Used, g"});
      page_.task(fmt::format("Wait {:g} s.", process_.activator_wait_s));
    }
    page_.heading("Dip");
    page_.task(fmt::format("{} at {:g} mm/min, {:.2f} mm deep: {:.1f} s from the first touch.",
                           moves_aside(job_) ? "Along the way in" : "Straight down",
                           process_.speed_mm_per_min, job_.depth_mm,
                           60 * in_water_mm(job_) / process_.speed_mm_per_min));
    page_.task(fmt::format("Hold for {:g} s at least. Clear the film that is left off the water.",
                           process_.dwell_s));
    page_.task(fmt::format("Lift at {:g} mm/min.", process_.lift_mm_per_min),
               {"Time", "Water, °C"});
    page_.task("Rinse until nothing is slippery.");
    const std::string dry =
        process_.dry_max_h > 0
            ? "Dry for " + span_in_words(process_.dry_min_h, process_.dry_max_h) + " h; "
            : "Let it dry; ";
    page_.task(
        dry + (job_.next_dip > 0 ? fmt::format("then dip {}, by its own run sheet.", job_.next_dip)
                                 : std::string("clear coat if wanted.")),
        {"Dry at"});
  }

  void draw_notes() {
    page_.heading("Notes");
    constexpr double kLine_mm = 8;
    while (page_.y - kLine_mm > kMargin_mm) {
      page_.y -= kLine_mm;
      page_.rule(page_.left(), page_.right(), page_.y, 0.15, 0.7);
    }
  }

  PageWriter page_;
  const RigJob& job_;
  const ProcessOptions& process_;
  const std::vector<PosePicture>& pictures_;
  const RunContext& context_;
};

}  // namespace

JobResult rig_sheet(const RigJob& job, const std::string& paper_name,
                    const std::filesystem::path& file, const RunContext& context) {
  const PaperSize paper = choose_paper(paper_name, job.config.design.film);
  const std::filesystem::path path = file.empty() ? job.folder / "run-sheet.pdf" : file;
  const auto warn_of_letters = [&](const char* what, const std::string& name) {
    warn_of_lost_letters(what, name, path.filename().string(), context);
  };
  warn_of_letters("the title", job.title);
  warn_of_letters("the batch", job.batch);
  warn_of_letters("the piece", job.label);
  const std::vector<PosePicture> pictures = pose_pictures(
      job, kPictureWidth_px, static_cast<int>(kPictureWidth_px / kPictureAspect), context);
  OutputFolder output(path.has_parent_path() ? path.parent_path() : ".", job.config.earlier_result);
  output.announce({path.filename().string()}, {});
  PdfDocument pdf;
  pdf.set_title("Run sheet, " + job.title);
  RunSheet(pdf, paper, job, pictures, context).draw();
  pdf.save(output.path(path.filename().string()));
  context.check_cancelled();
  output.commit();
  JobResult result;
  result.folder = output.folder();
  result.files = {path.filename().string()};
  for (const std::string& warning : context.warnings()) result.text += "warning: " + warning + "\n";
  result.text += output.told_replaced() + fmt::format("wrote {}\n", path.string());
  result.json =
      json_answer("rig sheet", {{"file", path.string()}, {"warnings", context.warnings()}});
  return result;
}

}  // namespace hydrodip
