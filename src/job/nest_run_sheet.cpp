#include "job/nest_run_sheet.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "base/json_text.h"
#include "coat/design.h"
#include "job/sheet_of.h"
#include "job/ways.h"
#include "plan/hold.h"
#include "render/preview.h"
#include "render/view.h"
#include "report/findings.h"
#include "report/html.h"
#include "session/appearance_of.h"
#include "settings/activator.h"

namespace hydrodip {
namespace {

using json = nlohmann::ordered_json;

json described(const Nest& nest) {
  json list = json::array();
  for (const NestPiece& piece : nest.pieces) {
    const NestPart& part = nest.parts[piece.part];
    const MadePart& made = nest.made[piece.part];
    const Coverage& coverage = made.coverage();
    list.push_back({{"number", piece.number},
                    {"model", part.job.config.model.string()},
                    {"from_left_mm", piece.place.corner_mm.x()},
                    {"from_bottom_mm", piece.place.corner_mm.y()},
                    {"width_mm", part.film().width_mm},
                    {"height_mm", part.film().height_mm},
                    {"turned", piece.place.turned},
                    {"depth_mm", part.job.trajectory.depth_mm()},
                    {"covered_downward_share", coverage.covered_downward_share()},
                    {"torn_share", coverage.torn_share()},
                    {"concern", concern_name(made.concern())},
                    {"verdict", verdict_of(made.report)}});
  }
  return list;
}

std::string covered_words(const Report& report) {
  return report.wanted
             ? fmt::format("{:.0f} % of the picture", 100 * report.wanted->covered_share())
             : fmt::format("{:.0f} % of the object", 100 * report.coverage->covered_share());
}

// "Pieces 1, 2"
std::string pieces_of(const Nest& nest, std::size_t part) {
  std::vector<int> numbers;
  for (const NestPiece& piece : nest.pieces)
    if (piece.part == part) numbers.push_back(piece.number);
  return fmt::format("{} {}", numbers.size() == 1 ? "Piece" : "Pieces", fmt::join(numbers, ", "));
}

// What is the same for all of them.
std::string bench_figures(const JobConfig& sheet) {
  const ProcessOptions& process = sheet.process;
  return fmt::format(
      "<p>Each: water {} °C; film on the water, ink side {}, {} s until it lies flat; {}dip at "
      "{:g} mm/min; hold {:g} s at least; clear the water; lift at {:g} mm/min; rinse; dry{}.</p>",
      span_in_words(process.water_min_c, process.water_max_c),
      sheet.print.ink_side == InkSide::kUp ? "up" : "down",
      span_in_words(process.soak_min_s, process.soak_max_s),
      process.activator_g > 0 ? fmt::format("activator; wait {:g} s; ", process.activator_wait_s)
                              : "",
      process.speed_mm_per_min, process.dwell_s, process.lift_mm_per_min,
      process.dry_max_h > 0 ? " " + span_in_words(process.dry_min_h, process.dry_max_h) + " h"
                            : "");
}

std::string how_to_dip(const NestPart& part, const ProcessOptions& process) {
  const Activator activator = activator_for(process, part.film());
  const PoseOptions& pose = part.job.config.object.pose;
  return fmt::format("It hangs {} ({}), {:.1f} mm deep at the end. Activator: {}.",
                     describe_hold(pose, way_up(part.job.config)), hold_options(pose),
                     part.job.trajectory.depth_mm(), in_words(activator));
}

// On the sheet as it is printed, which is mirrored if its ink goes down onto the water.
double from_left_mm(const NestPiece& piece, const NestPart& part, const JobConfig& sheet) {
  const double x_mm = piece.place.corner_mm.x();
  if (sheet.print.ink_side == InkSide::kUp) return x_mm;
  const double wide_mm = piece.place.turned ? part.film().height_mm : part.film().width_mm;
  return sheet.design.film.width_mm - x_mm - wide_mm;
}

}  // namespace

std::string nest_run_sheet(const Nest& nest, const JobConfig& sheet) {
  const bool up = sheet.print.ink_side == InkSide::kUp;
  std::string page = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>hydrodip run sheet</title>"
      "<style>body{{font:16px sans-serif;margin:2em}}td,th{{padding:.3em .8em;text-align:left;"
      "border-bottom:1px solid #ccc}}img{{max-height:24em;border:1px solid #ccc}}"
      ".stop{{color:#b00020}}.wide{{overflow-x:auto}}img{{max-width:100%}}</style>"
      "<h1>Run sheet: {} parts on one film of {:g} x {:g} mm</h1>"
      "<p>Print print.pdf at 100 %, cut along the lines, tape each piece over {:g} mm all around, "
      "and dip each part on its own piece, over the middle between its four ticks, with the "
      "piece's "
      "writing towards you.</p>"
      "{}{}<p><img src=\"print.png\" alt=\"the sheet\"></p>"
      "<div class=\"wide\"><table><tr><th>piece<th>part<th>from the left edge<th>from the lower "
      "edge<th>size<th>writing "
      "on the sheet<th>depth of the dip<th>covered<th>torn<th>verdict</tr>",
      nest.pieces.size(), sheet.design.film.width_mm, sheet.design.film.height_mm,
      sheet.design.film.margin_mm,
      is_draft(sheet.design)
          ? "<p class=\"stop\">" + html_escaped(draft_alarm(sheet.design)) + "</p>"
          : "",
      up ? ""
         : "<p>The sheet is printed mirrored: its ink goes down onto the water, and through "
           "the film the writing reads as it should. Places below are those on the print.</p>");
  for (const NestPiece& piece : nest.pieces) {
    const NestPart& part = nest.parts[piece.part];
    const MadePart& made = nest.made[piece.part];
    page += fmt::format(
        "<tr><td>{}<td>{}<td>{:.0f} mm<td>{:.0f} mm<td>{:g} x {:g} mm<td>{}<td>{:.1f} "
        "mm<td>{}<td>{:.1f} %<td class=\"{}\">{}</tr>",
        piece.number, html_escaped(part.name()), from_left_mm(piece, part, sheet),
        piece.place.corner_mm.y(), part.film().width_mm, part.film().height_mm,
        !piece.place.turned ? "below"
        : up                ? "upright, on the right"
                            : "upright, on the left",
        part.job.trajectory.depth_mm(), covered_words(made.report),
        100 * made.coverage().torn_share(), concern_name(made.concern()), headline(made.concern()));
  }
  page += "</table></div>";
  page += bench_figures(sheet);
  for (std::size_t p = 0; p < nest.parts.size(); ++p)
    page += fmt::format(
        "<h2>{}: {}</h2><p class=\"{}\">{}</p><p>{}</p><img src=\"part-{}.png\" alt=\"wanted and "
        "predicted\">",
        pieces_of(nest, p), html_escaped(nest.parts[p].name()),
        concern_name(nest.made[p].concern()), html_escaped(nest.made[p].verdict()),
        html_escaped(how_to_dip(nest.parts[p], sheet.process)), p + 1);
  return page + "</html>\n";
}

std::string nest_json(const Nest& nest, const JobConfig& sheet, const RunContext& context) {
  const json report = {{"schema_version", 1},
                       {"command", "nest"},
                       {"film_mm", {sheet.design.film.width_mm, sheet.design.film.height_mm}},
                       {"pieces", described(nest)},
                       {"warnings", context.warnings()}};
  return json_text(report);
}

Image as_it_stands(const NestPart& part, const MadePart& made, int width_px,
                   const RunContext& context) {
  const DippedObject& dipped = made.made.designed.dipped;
  PreviewOptions options;
  options.width_px = width_px;
  options.base = made.made.finish.paint().base();
  options.standing = standing_of(dipped.posed, way_up(part.job.config));
  std::vector<PreviewPair> pairs(1);
  pairs[0].shown = appearance_of(made.made.finish);
  return render_previews(dipped.posed.mesh(), dipped.posed.surface(), *dipped.film, pairs, options,
                         context)
      .front();
}

}  // namespace hydrodip
