#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/shell_word.h"
#include "report/findings.h"
#include "report/html.h"
#include "report/report.h"
#include "report/shares.h"

namespace hydrodip {
namespace {

// "12 345.7" with narrow spaces that do not break; four significant digits or all of an integer.
std::string shown(double value) {
  if (!std::isfinite(value)) return "unknown";
  const double size = std::abs(value);
  if (size != 0 && (size >= 1e12 || size < 1e-3)) return fmt::format("{:.3g}", value);
  const int decimals = size >= 1000 || value == std::floor(value) ? 0
                       : size >= 100                              ? 1
                       : size >= 10                               ? 2
                                                                  : 3;
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  if (size < 10000) return text;
  for (std::size_t end = text.size(); end > (value < 0 ? 4u : 3u);) {
    end -= 3;
    text.insert(end, "\u202f");
  }
  return text;
}

// A parameter exactly as it was set.
std::string exact(double value) { return fmt::format("{}", value); }

std::string value_text(const ReportValue& value, std::string (*number)(double)) {
  struct Visitor {
    std::string (*number)(double);
    std::string operator()(double v) const { return number(v); }
    std::string operator()(std::int64_t v) const { return number(double(v)); }
    std::string operator()(bool v) const { return v ? "yes" : "no"; }
    std::string operator()(const std::string& v) const { return v; }
    std::string operator()(const std::array<double, 3>& v) const {
      return number(v[0]) + ", " + number(v[1]) + ", " + number(v[2]);
    }
  };
  return std::visit(Visitor{number}, value);
}

std::string unit_text(const std::string& unit) {
  if (unit == "mm2") return "mm\u00b2";
  if (unit == "mm3") return "mm\u00b3";
  if (unit == "deg") return "\u00b0";
  return unit;
}

std::string with_unit(const std::string& value, const std::string& unit) {
  return unit.empty() ? value : value + "\u00a0" + unit_text(unit);
}

std::string page_title(const Report& report) {
  const std::string title = title_of(report);
  return title.empty() ? "hydrodip" : title;
}

std::string heading(const Report& report, const ReportPictures& pictures) {
  return fmt::format("<header>\n<p>hydrodip {}</p>\n<h1>{}</h1>\n{}</header>\n",
                     html_escaped(report.command), html_escaped(page_title(report)),
                     html_logo(pictures));
}

std::string verdict(const Report& report, const std::vector<Finding>& list) {
  const std::string sentence = verdict_of(report);
  if (sentence.empty() && list.empty()) return "";
  const Concern concern = concern_of(list);
  return html_verdict(concern, headline(concern), sentence);
}

// The overlays of the 3D view that show where a finding holds, by their labels there.
struct ShownBy {
  const char* finding;
  const char* overlay;
  bool of_several;  // also where several dips' finish is shown
};
constexpr std::array<ShownBy, 4> kShownBy = {{{"tears", "tears", false},
                                              {"wrinkles", "wrinkles", false},
                                              {"steepness", "dip angle", false},
                                              {"colors", "colour error", true}}};
constexpr const char* kMapsTitle = "Where it is difficult";

// Where on the page it is seen; empty: nowhere.
std::string shown_where(const Finding& finding, const Report& report,
                        const ReportPictures& pictures) {
  if (finding.concern == Concern::kNone) return "";
  const bool several = !report.dips.empty();
  // Against the vertical the view shows it; along other ways only the maps know it.
  const bool needs_map =
      finding.key == "doubtful" || (finding.key == "steepness" && !report.way_in.empty());
  if (needs_map)
    return pictures.maps_png.empty() ? ""
                                     : fmt::format("The map under \"{}\" shows where.", kMapsTitle);
  if (!has_view(pictures)) return "";
  for (const ShownBy& shown : kShownBy)
    if (finding.key == shown.finding && (shown.of_several || !several))
      return fmt::format("The overlay \"{}\" shows where.", shown.overlay);
  return "";
}

std::vector<Finding> saying_where(std::vector<Finding> list, const Report& report,
                                  const ReportPictures& pictures) {
  for (Finding& finding : list) {
    const std::string where = shown_where(finding, report, pictures);
    if (!where.empty()) finding.advice += (finding.advice.empty() ? "" : " ") + where;
  }
  return list;
}

std::string maps(const ReportPictures& pictures) {
  if (pictures.maps_png.empty()) return "";
  return fmt::format("<section>\n<h2>{}</h2>\n", kMapsTitle) +
         "<p>Left: how steeply the surface meets the film. Blue is easy; from orange to dark red "
         "the surface is steeper than the limit, and the film stretches much or tears: turn the "
         "object so that little of what matters lies there.</p>\n"
         "<p>Right: how far the film is stretched, from violet (hardly) to yellow (nearly torn). "
         "Red and white stripes: there the film may tear, the plainer the likelier; where it is "
         "not "
         "promised to hold, nothing is printed. Grey stays bare.</p>\n" +
         html_picture(pictures.maps_png,
                      "Dipping angle and film stretch on the object, from two sides") +
         "</section>\n";
}

std::string key_figure(const std::string& label, const std::string& value,
                       const std::string& unit) {
  return fmt::format("<div><dt>{}</dt><dd>{}{}</dd></div>\n", html_escaped(label),
                     html_escaped(value),
                     unit.empty() ? "" : " <small>" + html_escaped(unit_text(unit)) + "</small>");
}

std::string key_figures(const Report& report) {
  std::string cells;
  for (const ReportFigure& figure : report.figures) {
    cells += key_figure(figure.label, value_text(figure.value, shown), figure.unit);
  }
  return cells.empty() ? "" : "<dl class=\"key\">\n" + cells + "</dl>\n";
}

std::string section(const std::string& title, const std::string& rows) {
  if (rows.empty()) return "";
  return fmt::format(
      "<section>\n<h2>{}</h2>\n<div class=\"card\"><table>\n{}</table></div>\n</section>\n", title,
      rows);
}

std::string dips(const Report& report, const ReportPictures& pictures) {
  if (report.dips.empty()) return "";
  std::string rows = fmt::format(
      "<tr><th scope=\"row\">Dip</th><td>held</td><td class=\"number\">depth</td><td "
      "class=\"number\">prints{}</td><td class=\"number\">covered after it{}</td></tr>\n",
      report.wanted ? ", of the surface" : "", report.wanted ? ", of what shall be printed" : "");
  double covered_share = 0;
  for (std::size_t k = 0; k < report.dips.size(); ++k) {
    const ReportDip& dip = report.dips[k];
    covered_share += dip.gained_wanted_share.value_or(dip.gained_share);
    rows += fmt::format(
        "<tr><th scope=\"row\">{} <code>{}/print.pdf</code></th><td>{}<br><code "
        "class=\"soft\">--down "
        "{} --rotate {:g},{:g},{:g}</code></td><td class=\"number\">{:.4g}\u00a0mm</td><td "
        "class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
        k + 1, html_escaped(dip.folder), html_escaped(dip.hold), html_escaped(dip.down),
        dip.rotate_deg[0], dip.rotate_deg[1], dip.rotate_deg[2], dip.depth_mm,
        percent(dip.part_share), percent(covered_share));
  }
  return section("The dips, in order; let each dry before the next", rows) +
         (pictures.dips_png.empty()
              ? ""
              : "<section>\n<h2>Which dip does what</h2>\n" +
                    html_picture(pictures.dips_png,
                                 "The part of each dip, and the colour error, from two sides") +
                    "</section>\n");
}

std::string outputs(const Report& report) {
  std::string rows;
  for (const ReportOutput& output : report.outputs) {
    rows += fmt::format("<tr><th scope=\"row\"><code>{}</code></th><td>{}</td></tr>\n",
                        html_escaped(output.name), html_escaped(output.description));
  }
  return section("Files beside this page", rows);
}

std::string coverage(const Report& report) {
  if (!report.coverage) return "";
  const Coverage& c = *report.coverage;
  const auto area = [](double mm2) { return with_unit(shown(mm2), "mm2"); };
  return section(
      "Coverage and stretch",
      html_row("Surface of the object", area(c.object_mm2)) +
          html_row("of it facing down, within the dip", area(c.downward_mm2)) +
          html_row("Covered by film", area(c.covered_mm2)) +
          html_row("of it facing down", area(c.covered_downward_mm2)) +
          html_row("May tear, or lie elsewhere", area(c.doubtful_mm2)) +
          html_row("Flat film that lies on the object", area(c.film_on_object_mm2)) +
          html_row("Flat film that tears", area(c.torn_mm2)) +
          html_row("Stretch, mean", with_unit(fmt::format("{:.3f}", c.stretch_mean), "times")) +
          html_row("Stretch, largest", with_unit(fmt::format("{:.3f}", c.stretch_max), "times")) +
          html_row("Area, mean", with_unit(fmt::format("{:.3f}", c.area_ratio_mean), "times")) +
          html_row("Area, largest", with_unit(fmt::format("{:.3f}", c.area_ratio_max), "times")));
}

std::string angles(const Report& report) {
  if (!report.angles) return "";
  const DipAngles& a = *report.angles;
  std::string rows;
  for (int bin = 0; bin < DipAngles::kBins; ++bin) {
    const double area = a.area_mm2[std::size_t(bin)];
    rows += html_row(fmt::format("{} to {}\u00b0", 10 * bin, 10 * (bin + 1)),
                     with_unit(shown(area), "mm2"));
  }
  return section("Dipping angle of what faces down",
                 rows + html_row(fmt::format("Steeper than {:.0f}\u00b0", kDipAngleLimit_deg),
                                 fmt::format("{} ({})", with_unit(shown(a.over_limit_mm2), "mm2"),
                                             percent(a.over_limit_share()))));
}

std::string mesh(const Report& report) {
  if (!report.mesh) return "";
  const MeshHealth& m = *report.mesh;
  const auto count = [](const std::string& label, long number) {
    return number == 0 ? "" : html_row(label, shown(double(number)));
  };
  std::string rows = html_row("Triangles", shown(double(m.triangles))) +
                     html_row("Vertices", shown(double(m.vertices))) +
                     html_row("Shells", shown(double(m.shells))) +
                     html_row("Closed surface", m.closed() ? "yes" : "no") +
                     html_row("Surface", with_unit(shown(m.area_mm2), "mm2")) +
                     html_row("Volume", with_unit(shown(m.volume_mm3), "mm3")) +
                     count("Degenerate triangles removed", m.degenerate_removed) +
                     count("Duplicate triangles removed", m.duplicates_removed) +
                     count("Triangles turned over", m.flipped) + count("Holes", m.holes) +
                     count("Edges along holes", m.boundary_edges) +
                     count("Edges with more than two triangles", m.nonmanifold_edges);
  for (const std::string& finding : m.findings()) {
    rows += fmt::format("<tr><td colspan=\"2\">{}</td></tr>\n", html_escaped(finding));
  }
  return section("The model's mesh", rows);
}

std::string rounds(const Report& report) {
  std::string rows;
  for (const ReportRound& round : report.rounds) {
    std::string figures;
    for (const ReportFigure& figure : round.figures) {
      if (!figures.empty()) figures += "; ";
      figures += figure.label + " " + with_unit(value_text(figure.value, shown), figure.unit);
    }
    rows +=
        fmt::format("<tr><th scope=\"row\">{}</th><td class=\"number\">{}</td><td>{}</td></tr>\n",
                    html_escaped(round.process), round.round, html_escaped(figures));
  }
  return section("Convergence, round by round", rows);
}

std::string parameter_rows(const Report& report, bool changed) {
  std::string rows;
  for (const ReportParameter& parameter : report.parameters) {
    if (parameter.changed != changed) continue;
    rows += fmt::format(
        "<tr{}><th scope=\"row\"><code>{}</code></th><td class=\"number\">{}</td>"
        "<td class=\"unit\">{}</td></tr>\n",
        changed ? " class=\"changed\"" : "", html_escaped(parameter.name),
        html_escaped(value_text(parameter.value, exact)), html_escaped(unit_text(parameter.unit)));
  }
  return rows;
}

std::string parameters(const Report& report) {
  return section("Parameters changed from their defaults", parameter_rows(report, true)) +
         section("Parameters at their defaults", parameter_rows(report, false));
}

std::string times(const Report& report) {
  double sum = 0;
  double longest = 1e-9;
  for (const ReportStage& stage : report.stages) {
    sum += stage.seconds;
    longest = std::max(longest, stage.seconds);
  }
  std::string rows;
  for (const ReportStage& stage : report.stages) {
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td style=\"width:55%\"><span class=\"bar\" "
        "style=\"width:{:.1f}%\"></span></td><td class=\"number\">{:.2f}\u00a0s</td></tr>\n",
        html_escaped(stage.name), std::clamp(100 * stage.seconds / longest, 0.0, 100.0),
        stage.seconds);
  }
  if (report.stages.empty() && !(report.total_seconds > 0)) return "";
  rows += fmt::format(
      "<tr><th scope=\"row\">all</th><td></td><td class=\"number\">{:.2f}\u00a0s</td></tr>\n",
      report.total_seconds > 0 ? report.total_seconds : sum);
  if (report.peak_memory_bytes > 0) {
    rows += fmt::format(
        "<tr><th scope=\"row\">memory at its highest</th><td></td>"
        "<td class=\"number\">{}\u00a0MB</td></tr>\n",
        shown(std::round(double(report.peak_memory_bytes) / 1e6)));
  }
  // Marked, because everything else on the page depends on the input alone.
  std::string text = section("How long it took", rows);
  text.insert(text.find('>'), " id=\"times\"");
  return text;
}

std::string inputs(const Report& report) {
  std::string rows;
  for (const ReportInput& input : report.inputs) {
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}<br><code class=\"soft\">sha256 {}</code></td>"
        "<td class=\"number\">{}\u00a0bytes</td></tr>\n",
        html_escaped(input.role), html_escaped(input.path), html_escaped(input.sha256),
        shown(double(input.bytes)));
  }
  return section("Files read", rows);
}

// For those who ask: out of the way of everybody else.
std::string folded(const std::string& title, const std::string& sections) {
  if (sections.empty()) return "";
  return "<details class=\"folded\">\n<summary>" + title + "</summary>\n" + sections +
         "</details>\n";
}

std::string foot(const Report& report) {
  std::string line;
  for (const std::string& word : report.command_line)
    line += (line.empty() ? "" : " ") + shell_word(word);
  std::string html =
      fmt::format("<footer>\n<p>hydrodip {}</p>\n", html_escaped(report.tool_version));
  if (!line.empty()) html += "<p><code>" + html_escaped(line) + "</code></p>\n";
  return html + "</footer>\n";
}

}  // namespace

std::string report_html(const Report& report, const ReportPictures& pictures) {
  if (report.for_customer) return customer_html(report, pictures);
  const std::vector<Finding> list = findings(report);
  std::string html = html_begin(page_title(report) + " - hydrodip", "workshop");
  html += heading(report, pictures);
  html += verdict(report, list);
  html += html_preview(pictures);
  html += html_cards(saying_where(list, report, pictures));
  html += dips(report, pictures);
  html += maps(pictures);
  html += outputs(report);
  html += folded("Figures, parameters, files",
                 key_figures(report) + coverage(report) + angles(report) + mesh(report) +
                     rounds(report) + parameters(report) + times(report) + inputs(report));
  html += foot(report);
  return html + html_end(pictures);
}

}  // namespace hydrodip
