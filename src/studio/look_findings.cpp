#include "studio/look_findings.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "job/job_record.h"
#include "job/prepare.h"
#include "report/plain_words.h"
#include "studio/job_files.h"
#include "studio/mends.h"

namespace hydrodip {
namespace {

std::string overlay_of(const std::string& key) {
  static const std::vector<std::pair<std::string, std::string>> overlays = {
      {"tears", "tears"},       {"stretch", "stretch"}, {"air", "air"},
      {"vent", "air"},          {"steepness", "angle"}, {"coverage", "coverage"},
      {"wrinkles", "wrinkles"}, {"lifted", "coverage"}};
  for (const auto& [finding, overlay] : overlays)
    if (finding == key) return overlay;
  return "";
}

// Where a camera had best look: of what is torn the part that is nearest to the middle of it, of
// stretch where it is largest.
std::optional<Vec3> place_of(const std::string& key, const DippedObject& dipped) {
  const DippedFilm& film = *dipped.film;
  if (key == "air" && !dipped.air->pockets.empty()) return dipped.air->pockets.front().top;
  if (key == "vent" && !dipped.air->vents.empty()) return dipped.air->vents.front().at;
  if (key == "lifted") return dipped.coverage.lifted_at;
  if (key == "stretch") {
    std::optional<std::size_t> most;
    for (std::size_t v = 0; v < film.stretch.size(); ++v)
      if (film.state[v] == VertexState::kAttached &&
          (!most || film.stretch[v] > film.stretch[*most]))
        most = v;
    if (most) return film.position[*most];
  }
  if (key != "tears" && key != "wrinkles") return std::nullopt;
  const std::vector<std::uint8_t>& marked = key == "tears" ? film.torn : film.wrinkled;
  std::vector<Vec3> places;
  Vec3 sum = Vec3::Zero();
  for (std::size_t t = 0; t < marked.size(); ++t) {
    if (!marked[t]) continue;
    Vec3 middle = Vec3::Zero();
    for (const std::int32_t v : film.mesh().triangles[t])
      middle += film.position[std::size_t(v)] / 3;
    places.push_back(middle);
    sum += middle;
  }
  if (places.empty()) return std::nullopt;
  const Vec3 mean = sum / double(places.size());
  return *std::min_element(places.begin(), places.end(), [&](const Vec3& a, const Vec3& b) {
    return (a - mean).squaredNorm() < (b - mean).squaredNorm();
  });
}

Json mends_for(const Finding& finding, const Look& look) {
  const DippedObject& dipped = look.made->dipped;
  if (finding.concern == Concern::kNone) return Json::array();
  if (finding.key == "tears" || (finding.key == "coverage" && finding.concern == Concern::kStop))
    return tear_mends(look.config, *dipped.film);
  if (finding.key == "air") return air_mends(*dipped.air);
  Json list = Json::array();
  if (finding.key == "steepness") list.push_back(orient_mend());
  return list;
}

bool is_blank(const Look& look) {
  const auto& laid = look.made->ink.ink.inking.inks.cmyk;
  return std::all_of(laid.begin(), laid.end(), [](std::uint8_t value) { return value == 0; });
}

}  // namespace

Report report_of(const Look& look, const std::filesystem::path& uploads,
                 const RunContext& context) {
  const RunContext words = context.quiet();
  for (const std::string& warning : look.warnings) words.warn(without_folder(warning, uploads));
  const PreparedObject prepared{.posed = look.made->dipped.posed,
                                .paint = look.paint,
                                .health = look.model->health,
                                .units = look.model->units,
                                .files = {},
                                .artwork = {},
                                .picture_problems = {}};
  const std::vector<ReportInput> inputs;
  const Finish finish(look.paint, {{look.made->dipped, look.made->raster, nullptr}});
  const Timings times;
  JobRecord record{"print", look.config, prepared,        inputs, finish,
                   times,   words,       &look.made->ink, "",     ""};
  record.wanted =
      wanted_coverage(look.made->dipped, *look.paint,
                      doubtful_stretch(look.config.design.dip.material), points_of(look.quality));
  return make_report(record);
}

std::vector<Finding> findings_of(const Look& look, const Report& report) {
  std::vector<Finding> list = findings(report);
  if (is_blank(look))
    list.insert(
        list.begin() + (list.empty() ? 0 : 1),
        {"blank", Concern::kCare, "Nothing to print", "",
         look.paint->says_anything() ? "What the film reaches has the object's own colour."
                                     : "The object has no colours yet: put a picture on it.",
         ""});
  if (look.dips > 1 && look.paint->depends_on_film())
    list.push_back({"pattern-dips", Concern::kStop, "Pattern film belongs to one dip", "",
                    "Films of several dips cannot share a pattern, so this job cannot be printed.",
                    "Lay the pattern on the object, or take the other dips away."});
  // Worst first, and otherwise as they come.
  std::stable_sort(list.begin(), list.end(),
                   [](const Finding& a, const Finding& b) { return a.concern > b.concern; });
  return list;
}

Json verdict_json(const Report& report, const std::vector<Finding>& list) {
  const Concern concern = concern_of(list);
  return {{"concern", concern_name(concern)},
          {"headline", headline(concern)},
          {"short", report.coverage ? in_plain_words(short_verdict(report)) : ""},
          {"text", in_plain_words(verdict_of(report))}};
}

Json finding_json(const Finding& finding, const std::string& overlay, Json mends) {
  return {{"key", finding.key},
          {"concern", concern_name(finding.concern)},
          {"title", finding.title},
          {"figure", finding.figure},
          {"text", in_plain_words(finding.text)},
          {"advice", in_plain_words(finding.advice)},
          {"overlay", overlay},
          {"at_mm", nullptr},
          {"mends", std::move(mends)}};
}

Json findings_json(const Look& look, const std::vector<Finding>& list) {
  Json all = Json::array();
  for (const Finding& f : list) {
    Json one = finding_json(f, overlay_of(f.key), mends_for(f, look));
    if (f.concern != Concern::kNone)
      if (const auto at = place_of(f.key, look.made->dipped))
        one["at_mm"] = {at->x(), at->y(), at->z()};
    all.push_back(std::move(one));
  }
  return all;
}

Json layers_json(const std::vector<DryLayer>& layers) {
  Json list = Json::array();
  for (const DryLayer& layer : layers) list.push_back(layer.layer);
  return list;
}

Json figures_json(const Look& look) {
  const DippedObject& d = look.made->dipped;
  const Coverage& c = d.coverage;
  const Reach& reach = look.made->ink.reach;
  return {{"covered_share", c.covered_share()},
          {"covered_downward_share", c.covered_downward_share()},
          {"covered_mm2", c.covered_mm2},
          {"torn_share", c.torn_share()},
          {"torn_mm2", c.torn_mm2},
          {"stretch_mean", c.stretch_mean},
          {"stretch_max", c.stretch_max},
          {"area_ratio_max", c.area_ratio_max},
          {"wrinkled_mm2", c.wrinkled_mm2},
          {"air_mm2", d.air->area_mm2()},
          {"air_volume_mm3", d.air->volume_mm3()},
          {"color_difference", reach.mean},
          {"out_of_gamut_share", reach.out_of_reach_share()},
          {"steep_share", d.angles.over_limit_share()}};
}

}  // namespace hydrodip
