// What somebody who ordered the piece is told. Words of the workshop stay there.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <variant>

#include "report/findings.h"
#include "report/html.h"
#include "report/shares.h"

namespace hydrodip {
namespace {

constexpr double kSomePercent = 0.005;  // of the object: less is shown as none

std::string whole_percent(double share) { return fmt::format("{:.0f} %", 100 * share); }

double picture_share(const Report& report) {
  return report.wanted && report.wanted->covered_mm2 > 0 ? report.wanted->covered_share()
                                                         : report.coverage->covered_share();
}

bool is_of_a_part(const Report& report) { return report.wanted && report.wanted->covered_mm2 > 0; }

Finding coverage_point(const Report& report) {
  const double share = picture_share(report);
  Finding point{"coverage", share >= kWholePicture ? Concern::kNone : Concern::kCare,
                "Coverage", whole_percent(share),
                "",         ""};
  if (is_of_a_part(report))
    point.text = "of your picture comes out.";
  else if (share >= kWholePicture)
    point.text = "of the object gets colour.";
  else
    point.text = "of the object gets colour. The rest, sides and back, stays as the bare object.";
  return point;
}

double figure_or(const Report& report, const std::string& key, double otherwise) {
  for (const ReportFigure& f : report.figures)
    if (f.key == key && std::holds_alternative<double>(f.value)) return std::get<double>(f.value);
  return otherwise;
}

// Whether places stay bare for torn film where something is wanted, as far as shares tell.
bool has_gaps(const Report& report) {
  if (!(report.coverage->torn_mm2 > 0)) return false;
  return report.wanted ? report.wanted->missed_share() >= 1 - kWholePicture
                       : report.coverage->covered_share() < kWholePicture;
}

Finding colors_point(const Report& report, bool has_picture) {
  const ReportColors& colors = *report.colors;
  const bool plain = colors.error_most_of > kPlainDifference;
  Finding point{"colors", plain ? Concern::kCare : Concern::kNone, "Colours", "", "", ""};
  point.text = plain ? "In places they differ visibly from what you asked for" +
                           std::string(has_picture ? "; compare the two pictures." : ".")
                     : "Close to what you asked for.";
  const double beyond = figure_or(report, "out_of_gamut_share", 0);
  if (beyond > kMuchOutOfGamut)
    point.text += fmt::format(
        " {} of the picture has colours that these inks cannot give; the nearest ones are printed.",
        whole_percent(beyond));
  return point;
}

std::string facts(const Report& report) {
  std::string rows;
  for (const ReportFigure& f : report.figures)
    if (const auto* size = std::get_if<std::array<double, 3>>(&f.value);
        size && f.key == "model_size_mm")
      rows += html_row(
          "Size", fmt::format("{:.0f} x {:.0f} x {:.0f} mm", (*size)[0], (*size)[1], (*size)[2]));
  if (!report.dips.empty()) rows += html_row("Coats of colour", std::to_string(report.dips.size()));
  if (rows.empty()) return "";
  return "<section>\n<h2>The piece</h2>\n<div class=\"card\"><table>\n" + rows +
         "</table></div>\n</section>\n";
}

// The file's name is better than nothing, but its ending says nothing to them.
std::string customer_title(const Report& report) {
  if (!report.title.empty()) return report.title;
  return report.inputs.empty() ? "Your piece"
                               : std::filesystem::path(report.inputs.front().path).stem().string();
}

}  // namespace

std::string customer_headline(const Report& report, Concern concern, bool has_picture) {
  const std::string differs = concern == Concern::kCare ? "; a few things differ" : "";
  const bool cannot = concern == Concern::kStop;
  if (report.draft)
    return std::string("Draft, not final: ") +
           (cannot ? "it could not be made well like this" : "a first estimate") + differs;
  if (cannot) return "It cannot be made well like this";
  return (has_picture ? "This is how it will look" : "It can be made") + differs;
}

std::string customer_verdict(const Report& report) {
  const std::string share = whole_percent(picture_share(report));
  if (is_of_a_part(report)) return fmt::format("{} of your picture comes out.", share);
  if (!(report.coverage->covered_mm2 > 0)) return "No colour would stay on the object.";
  if (report.dips.size() > 1)
    return fmt::format("{} coats bring colour to {} of the object.", report.dips.size(), share);
  return fmt::format("{} of the object gets colour.", share);
}

std::vector<Finding> customer_points(const Report& report, bool has_picture) {
  std::vector<Finding> list;
  if (report.draft)
    list.push_back({"draft", Concern::kCare, "Draft", "",
                    "All of this is roughly calculated. The final page may say otherwise; please "
                    "wait for it before you agree.",
                    ""});
  if (!report.coverage) return list;
  const Coverage& c = *report.coverage;
  list.push_back(coverage_point(report));
  if (!(c.covered_mm2 > 0)) return list;
  if (has_gaps(report))
    list.push_back({"gaps", Concern::kCare, "Gaps", "",
                    "Where the film cannot follow the shape, places stay bare" +
                        std::string(has_picture ? ", as the picture shows." : "."),
                    ""});
  if (c.doubtful_mm2 > kLittleDoubt * c.covered_mm2 && c.doubtful_share() >= kSomePercent)
    list.push_back({"doubtful", Concern::kCare, "Doubtful", whole_percent(c.doubtful_share()),
                    "of the object may come out bare or a little displaced.", ""});
  if (report.air && report.air->area_mm2() > 0)
    list.push_back({"air", Concern::kCare, "Hollows", "",
                    "Air stays in hollows of the shape; there it stays bare.", ""});
  if (c.area_ratio_max > kPale)
    list.push_back({"pale", Concern::kCare, "Paler places", "",
                    "Where the film stretches most, colours come out a little paler.", ""});
  if (report.colors) list.push_back(colors_point(report, has_picture));
  if (report.seams && report.seams->length_mm > 0)
    list.push_back({"seams",
                    report.seams->error_mean > kPlainDifference ? Concern::kCare : Concern::kNone,
                    "Seams", "", "Where coats meet, a line may show from near by.", ""});
  const double off = kUsualMiss_mm * std::max(1.0, c.stretch_max) + report.equilibrium.unknown_mm();
  list.push_back({"placement", Concern::kNone, "Placement", fmt::format("{:.1f} mm", off),
                  "is how far the picture may be off its place at worst: each piece is dipped "
                  "singly.",
                  ""});
  return list;
}

std::string customer_html(const Report& report, const ReportPictures& pictures) {
  const bool has_picture = !pictures.preview_png.empty() || has_view(pictures);
  const std::vector<Finding> points = customer_points(report, has_picture);
  // What the workshop would not dip is nothing to be promised.
  const Concern concern =
      concern_of(findings(report)) == Concern::kStop ? Concern::kStop : concern_of(points);
  std::string html = html_begin(customer_title(report), "customer");
  html += "<header>\n" + html_logo(pictures) + "<h1>" + html_escaped(customer_title(report)) +
          "</h1>\n</header>\n";
  if (report.coverage)
    html += html_verdict(concern, customer_headline(report, concern, has_picture),
                         customer_verdict(report));
  html += html_preview(pictures);
  html += html_cards(points);
  html += facts(report);
  return html + html_end(pictures);
}

}  // namespace hydrodip
