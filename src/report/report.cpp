#include "report/report.h"

#include <fmt/format.h>

#include "base/file.h"
#include "dip/dip.h"
#include "report/findings.h"
#include "report/shares.h"

namespace hydrodip {
namespace {

bool has_wanted(const Report& report) { return report.wanted && report.wanted->covered_mm2 > 0; }

// How much is covered, and how much torn.
std::string short_film_part(const Report& report) {
  const Coverage& coverage = *report.coverage;
  if (!has_wanted(report) && !(coverage.film_on_object_mm2 > 0))
    return is_inside_out(report)   ? std::string("no film stays on the object: ") + kLooksInwards
           : coverage.torn_mm2 > 0 ? "all film that meets the object tears"
                                   : "no film lies on the object";
  if (!has_wanted(report) && !(coverage.torn_mm2 > 0))
    return fmt::format("{} of the object covered, stretched up to {:.2f} times, no tears",
                       percent(coverage.covered_share()), coverage.stretch_max);
  std::string text =
      has_wanted(report)
          ? fmt::format(
                "{} of what shall be printed covered{}, {} of the film that meets the object torn",
                percent(report.wanted->covered_share()), only_perhaps(report.wanted),
                percent(coverage.torn_share()))
          : fmt::format("{} of the object covered, {} of the film that meets it torn",
                        percent(coverage.covered_share()), percent(coverage.torn_share()));
  if (coverage.stretch_max > kMostStretch)
    text += fmt::format(", the rest stretched up to {:.2f} times", coverage.stretch_max);
  return text;
}

std::string uncapitalized(std::string words) {
  if (!words.empty() && words[0] >= 'A' && words[0] <= 'Z') words[0] = char(words[0] - 'A' + 'a');
  return words;
}

}  // namespace

ReportInput describe_input(const std::string& role, const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = read_file(path);
  return {role, path.string(), sha256_hex(bytes), bytes.size()};
}

std::string title_of(const Report& report) {
  if (!report.title.empty() || report.inputs.empty()) return report.title;
  return std::filesystem::path(report.inputs.front().path).filename().string();
}

std::optional<double> missed_share(const Report& report) {
  if (report.wanted) return report.wanted->missed_share();
  if (report.together) return report.together->missed_share();
  return std::nullopt;
}

std::string only_perhaps(const std::optional<ReportWanted>& wanted) {
  if (!wanted || wanted->doubtful_share() < kSomeDoubt) return "";
  return fmt::format(", {} of it only perhaps", percent(wanted->doubtful_share()));
}

bool is_inside_out(const Report& report) {
  return report.mesh && report.mesh->inside_out && report.coverage &&
         !(report.coverage->film_on_object_mm2 > 0);
}

std::string no_film_verdict(const Coverage& coverage, bool inside_out) {
  if (inside_out)
    return fmt::format("No film stays on the object: {}; {}.", kLooksInwards, kTurnNormals);
  return coverage.torn_mm2 > 0
             ? "No film stays on the object: all that meets it tears; turn a flatter side down "
               "with --rotate or --down."
             : "No film lies on the object: check --down and --depth.";
}

std::string short_verdict(const Report& report) {
  const std::vector<Finding> list = findings(report);
  const Finding* obstacle = first_obstacle(list);
  const std::string film = short_film_part(report);
  // What forbids the dip comes first: margins and captions are short.
  return obstacle
             ? fmt::format("{}: {}; {}", uncapitalized(obstacle->title), obstacle->figure, film)
             : film;
}

namespace {

std::string unknown_verdict(const ReportEquilibrium& equilibrium) {
  return fmt::format(
      "In {} of {} steps no equilibrium of the film was found, so where it comes to lie is not "
      "known: turn steep sides and deep recesses away, or dip less deep.",
      equilibrium.unconverged_steps, equilibrium.steps);
}

// What gets film, or would if it bore it.
std::string covered_part(const Report& report) {
  const Coverage& c = *report.coverage;
  const bool breaks = c.stretch_max > kMostStretch;
  const char* covers = breaks ? "would cover" : "covers";
  if (has_wanted(report))
    return fmt::format("The film {} {} of what shall be printed{}", covers,
                       percent(report.wanted->covered_share()), only_perhaps(report.wanted));
  if (c.torn_mm2 > 0)
    return fmt::format("{} film {} {} of the object",
                       breaks ? "If the rest of it held, the" : "Where it holds, the", covers,
                       percent(c.covered_share()));
  return fmt::format("The film {} {} of the object ({} of what faces down)", covers,
                     percent(c.covered_share()), percent(c.covered_downward_share()));
}

// What becomes of the film.
std::string lost_part(const Report& report) {
  const Coverage& c = *report.coverage;
  const std::string lost = percent(c.torn_share());
  if (c.stretch_max > kMostStretch)
    return fmt::format("; it would be stretched {:.2f} times, and no film bears more than {:g}.",
                       c.stretch_max, kMostStretch);
  if (!(c.torn_mm2 > 0)) return fmt::format(" and stretches up to {:.2f} times", c.stretch_max);
  if (!(report.tear_stretch > 0))
    return fmt::format("; {} of what meets the object folds over and is lost.", lost);
  if (has_wanted(report))
    return fmt::format(
        "; {} of the film that meets the object tears, and {}.", lost,
        report.finished_image ? "what the image has there is lost" : "nothing is printed on it");
  return fmt::format(
      "; it tears: {} of what meets the object is lost. To keep it, turn steep sides down "
      "(--rotate, --down) or dip less (--depth) and the rest in another turn.",
      lost);
}

// Whether the film is said to tear, or to be stretched too far: why not to dip it.
bool tells_of_loss(const Report& report) {
  return report.coverage->torn_mm2 > 0 || report.coverage->stretch_max > kMostStretch;
}

// Why not to dip it, besides what becomes of the film; empty: nothing else.
std::string obstacle(const std::vector<Finding>& list) {
  const Finding* first = first_obstacle(list);
  return first ? fmt::format(" {}: {} {}", first->title, first->figure, first->text) : "";
}

std::string whole_film_part(const Report& report, Concern concern) {
  if (report.coverage->covered_downward_share() < kNearlyAll && !has_wanted(report))
    return "; it does not tear. What stays bare needs another dip, turned.";
  return concern == Concern::kNone ? "; it does not tear: dip it like this."
                                   : "; it does not tear.";
}

std::string plain_verdict(const Report& report) {
  const Coverage& c = *report.coverage;
  if (!(c.film_on_object_mm2 > 0)) return no_film_verdict(c, is_inside_out(report));
  if (report.equilibrium.unconverged_steps > 0) return unknown_verdict(report.equilibrium);
  const std::vector<Finding> list = findings(report);
  std::string text = covered_part(report) + lost_part(report);
  if (!tells_of_loss(report)) text += whole_film_part(report, concern_of(list));
  return text + obstacle(list);
}

std::string several_dips_verdict(const Report& report) {
  const Coverage& c = *report.coverage;
  if (is_inside_out(report)) return no_film_verdict(c, true);
  const std::size_t dips = report.dips.size();
  return fmt::format(
             "{} {}; {}", dips == 1 ? "1 dip covers" : fmt::format("{} dips cover", dips),
             has_wanted(report) ? percent(report.wanted->covered_share()) +
                                      " of what shall be printed" + only_perhaps(report.wanted)
                                : percent(c.covered_share()) + " of the object",
             c.torn_mm2 > 0
                 ? fmt::format("{} of the film that meets {} tears.", percent(c.torn_share()),
                               has_wanted(report) ? "the object" : "it")
                 : "nothing tears.") +
         obstacle(findings(report));
}

}  // namespace

std::string verdict_of(const Report& report) {
  if (!report.coverage) return "";
  return report.dips.empty() ? plain_verdict(report) : several_dips_verdict(report);
}

void write_report_json(const std::filesystem::path& path, const Report& report) {
  write_file(path, report_json(report));
}

void write_report_html(const std::filesystem::path& path, const Report& report,
                       const ReportPictures& pictures) {
  write_file(path, report_html(report, pictures));
}

}  // namespace hydrodip
