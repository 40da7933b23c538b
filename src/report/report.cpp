#include "report/report.h"

#include <fmt/format.h>

#include "base/file.h"

namespace hydrodip {
namespace {

// Of the surface that faces down; film ends a cell or so short of every border.
constexpr double kNearlyAll = 0.9;

std::string percent(double share) {
  const double value = 100 * share;
  if (value > 0 && value < 0.1) return "under 0.1 %";
  return value < 10 ? fmt::format("{:.1f} %", value) : fmt::format("{:.0f} %", value);
}

}  // namespace

ReportInput describe_input(const std::string& role, const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = read_file(path);
  return {role, path.string(), sha256_hex(bytes), bytes.size()};
}

std::string plain_verdict(const Coverage& coverage) {
  if (!(coverage.film_on_object_mm2 > 0)) {
    return coverage.torn_mm2 > 0
               ? "No film stays on the object: all that meets it tears; turn a flatter side down "
                 "with --rotate or --down."
               : "No film lies on the object: check --down and --depth.";
  }
  if (coverage.torn_mm2 > 0)
    return fmt::format(
        "Where it holds, the film covers {} of the object; it tears: {} of what meets the object "
        "is "
        "lost. To keep it, turn steep sides down (--rotate, --down) or dip less (--depth) and the "
        "rest in another turn.",
        percent(coverage.covered_share()), percent(coverage.torn_share()));
  const std::string start = fmt::format(
      "The film covers {} of the surface that faces down ({} of all) and stretches up to "
      "{:.2f} times",
      percent(coverage.covered_downward_share()), percent(coverage.covered_share()),
      coverage.stretch_max);
  if (coverage.stretch_max > kMostStretch)
    return start +
           fmt::format("; no film bears more than {:g}: do not dip it like this.", kMostStretch);
  if (coverage.covered_downward_share() < kNearlyAll)
    return start + "; it does not tear. What stays bare needs another dip, turned.";
  return start + "; it does not tear: dip it like this.";
}

std::string plain_verdict(const Coverage& coverage, const ReportWanted& wanted) {
  if (!(wanted.covered_mm2 > 0)) return plain_verdict(coverage);
  std::string text =
      fmt::format("The film covers {} of what shall be printed", percent(wanted.covered_share()));
  if (coverage.torn_mm2 > 0)
    return text + fmt::format(
                      "; {} of the film that meets the object tears, and nothing is "
                      "printed on it.",
                      percent(coverage.torn_share()));
  return text +
         fmt::format(", stretches up to {:.2f} times and does not tear.", coverage.stretch_max);
}

std::string short_verdict(const Report& report) {
  const Coverage& coverage = *report.coverage;
  if (report.wanted && report.wanted->covered_mm2 > 0)
    return fmt::format(
        "{:.0f} % of what shall be printed covered, {:.1f} % of the film that meets "
        "the object torn",
        100 * report.wanted->covered_share(), 100 * coverage.torn_share());
  if (!(coverage.film_on_object_mm2 > 0))
    return coverage.torn_mm2 > 0 ? "all film that meets the object tears"
                                 : "no film lies on the object";
  if (coverage.torn_mm2 > 0)
    return fmt::format("{:.0f} % of the object covered, {:.1f} % of the film that meets it torn",
                       100 * coverage.covered_share(), 100 * coverage.torn_share());
  return fmt::format(
      "{:.0f} % of the downward side covered, stretched up to {:.2f} times, no tears",
      100 * coverage.covered_downward_share(), coverage.stretch_max);
}

std::string several_dips_verdict(const Coverage& coverage, std::size_t dips) {
  return fmt::format(
      "{} {} of the object; {}", dips == 1 ? "1 dip covers" : fmt::format("{} dips cover", dips),
      percent(coverage.covered_share()),
      coverage.torn_mm2 > 0
          ? fmt::format("{} of the film that meets it tears.", percent(coverage.torn_share()))
          : "nothing tears.");
}

std::string unknown_verdict(const ReportEquilibrium& equilibrium) {
  return fmt::format(
      "In {} of {} steps no equilibrium of the film was found, so where it comes to lie is not "
      "known: turn steep sides and deep recesses away, or dip less deep.",
      equilibrium.unconverged_steps, equilibrium.steps);
}

std::string verdict_of(const Report& report) {
  if (!report.verdict.empty() || !report.coverage) return report.verdict;
  if (!report.dips.empty()) return several_dips_verdict(*report.coverage, report.dips.size());
  if (report.equilibrium.unconverged_steps > 0 && report.coverage->film_on_object_mm2 > 0)
    return unknown_verdict(report.equilibrium);
  return plain_verdict(*report.coverage);
}

void write_report_json(const std::filesystem::path& path, const Report& report) {
  write_file(path, report_json(report));
}

void write_report_html(const std::filesystem::path& path, const Report& report,
                       const ReportPictures& pictures) {
  write_file(path, report_html(report, pictures));
}

}  // namespace hydrodip
