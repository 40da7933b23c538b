#include "studio/look_bundles.h"

#include <fmt/format.h>

#include <string>
#include <type_traits>
#include <utility>

#include "base/run_scope.h"
#include "ink/printer.h"
#include "job/ways.h"
#include "plan/hold.h"
#include "report/findings.h"
#include "report/plain_words.h"
#include "studio/bundle.h"
#include "studio/job_files.h"
#include "studio/look_findings.h"

namespace hydrodip {
namespace {

template <class Vector>
void add_vector(std::vector<float>& to, const Vector& v) {
  for (Eigen::Index k = 0; k < v.size(); ++k) to.push_back(float(v[k]));
}

std::vector<std::uint32_t> indices_of(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> list;
  list.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (const std::int32_t v : t) list.push_back(std::uint32_t(v));
  return list;
}

template <class Item>
std::vector<float> floats_of(const std::vector<Item>& items) {
  std::vector<float> list;
  if constexpr (std::is_arithmetic_v<Item>) {
    list.assign(items.begin(), items.end());
  } else {
    list.reserve(items.size() * std::size_t(Item::SizeAtCompileTime));
    for (const Item& item : items) add_vector(list, item);
  }
  return list;
}

void add_film(Bundle& bundle, const DippedFilm& film) {
  bundle.add("film.u", floats_of(film.mesh().u), 2);
  bundle.add("film.position", floats_of(film.position), 3);
  std::vector<std::uint8_t> state;
  for (const VertexState s : film.state) state.push_back(std::uint8_t(s));
  bundle.add("film.state", state, 1);
  bundle.add("film.stretch", floats_of(film.stretch), 1);
  bundle.add("film.area_ratio", floats_of(film.area_ratio), 1);
  bundle.add("film.index", indices_of(film.mesh().triangles), 3);
  bundle.add("film.torn", film.torn, 1);
  bundle.add("film.wrinkled", film.wrinkled, 1);
}

void add_sheet(Bundle& bundle, const FilmInk& ink, const ColorModel& model) {
  bundle.add("sheet.printed", look_on_film(ink.inking.inks, ink.inking.printed, model).rgba, 4);
  BlankArray<std::uint8_t> predicted = ink.on_object.rgba;
  const BlankArray<std::uint8_t>& laid = ink.inking.inks.cmyk;
  for (std::size_t i = 0; i < predicted.size(); i += 4)
    predicted[i + 3] = laid[i] || laid[i + 1] || laid[i + 2] || laid[i + 3] ? 255 : 0;
  bundle.add("sheet.predicted", predicted, 4);
}

void add_air(Bundle& bundle, const DippedObject& dipped) {
  const TrappedAir& air = *dipped.air;
  const TriangleMesh& mesh = dipped.posed.mesh();
  std::vector<float> dry;
  std::vector<std::uint32_t> index;
  for (std::size_t t = 0; t < air.pocket_of.size(); ++t) {
    if (air.pocket_of[t] < 0) continue;
    Vec3 middle = Vec3::Zero();
    for (const std::int32_t v : mesh.triangles[t]) middle += mesh.positions[std::size_t(v)] / 3;
    if (!air.holds(int(t), middle)) continue;
    for (const std::int32_t v : mesh.triangles[t]) {
      index.push_back(std::uint32_t(dry.size() / 3));
      add_vector(dry, mesh.positions[std::size_t(v)]);
    }
  }
  bundle.add("air.position", dry, 3);
  bundle.add("air.index", index, 3);
  bundle.add("lids.position", floats_of(air.lids.positions), 3);
  bundle.add("lids.index", indices_of(air.lids.triangles), 3);
}

std::string hex_of(const LinearColor& c) {
  return fmt::format("#{:02x}{:02x}{:02x}", linear_to_srgb8(c.r), linear_to_srgb8(c.g),
                     linear_to_srgb8(c.b));
}

}  // namespace

std::vector<std::uint8_t> finish_bundle(const DipsTogether& look, Json head,
                                        const std::filesystem::path& uploads) {
  Report report = look.report;
  for (std::string& warning : report.warnings) warning = without_folder(warning, uploads);
  const ReportSeams& seams = *report.seams;
  const std::vector<Finding> list = findings(report);
  head["covered_share"] = report.coverage->covered_share();
  head["verdict"] = verdict_json(report, list);
  head["findings"] = Json::array();
  for (const Finding& f : list)
    head["findings"].push_back(
        finding_json(f, f.key == "seams" || f.key == "coverage" ? "parts" : "", Json::array()));
  head["dry_layers"] = layers_json(look.dry);
  head["dips"] = Json::array();
  for (std::size_t k = 0; k < report.dips.size(); ++k) {
    const ReportDip& dip = report.dips[k];
    head["dips"].push_back({{"part_share", dip.part_share},
                            {"gained_share", dip.gained_share},
                            {"covered_share", dip.covered_share},
                            {"torn_share", dip.torn_share},
                            {"color", hex_of(look.color_of[k])},
                            {"width_px", look.sheets[k].width_px},
                            {"height_px", look.sheets[k].height_px}});
  }
  head["seams"] = {{"length_mm", seams.length_mm},
                   {"overlap_mm", seams.overlap_mm},
                   {"error_mean", seams.error_mean},
                   {"off_mm", seams.off_mm},
                   {"error_mean_off", seams.error_mean_off}};
  Bundle bundle(std::move(head));
  for (std::size_t k = 0; k < look.sheets.size(); ++k)
    bundle.add(fmt::format("sheet.{}", k), look.sheets[k].rgba, 4);
  return bundle.finish();
}

std::vector<std::uint8_t> result_bundle(const Look& look, Json head,
                                        const std::filesystem::path& uploads,
                                        const RunContext& context) {
  const RunScope scope(context);
  const DippedObject& dipped = look.made->dipped;
  const DippedFilm& film = *dipped.film;
  const FilmInk& ink = look.made->ink.ink;
  const FilmOptions& sheet = look.config.design.film;
  const BathOptions& bath = look.config.bath;
  const Printer printer = make_printer(look.config.printer);
  const Report report = report_of(look, uploads, context);
  const std::vector<Finding> list = findings_of(look, report);
  head["quality"] = quality_name(look.quality);
  head["dip"] = look.dip;
  head["dips"] = look.dips;
  const Eigen::Matrix4d& matrix = dipped.posed.matrix();
  head["matrix"] = std::vector<double>(matrix.data(), matrix.data() + 16);
  head["scale"] = dipped.posed.scale();
  head["depth_mm"] = film.depth_mm;
  head["hold"] = describe_hold(look.config.object.pose, way_up(look.config));
  head["film"] = {{"width_mm", sheet.width_mm},
                  {"height_mm", sheet.height_mm},
                  {"margin_mm", sheet.margin_mm},
                  {"shape", sheet.shape == FilmShape::kDisc ? "disc" : "rectangle"},
                  {"cell_mm", film.mesh().cell_mm},
                  {"tear_stretch", look.config.design.dip.material.tear_stretch}};
  head["bath"] = {
      {"width_mm", bath.width_mm}, {"height_mm", bath.height_mm}, {"depth_mm", bath.depth_mm}};
  head["sheet"] = {{"width_px", ink.on_object.width_px}, {"height_px", ink.on_object.height_px}};
  head["verdict"] = verdict_json(report, list);
  head["findings"] = findings_json(look, list);
  head["figures"] = figures_json(look);
  head["artwork"] = Json::array();
  for (const LaidLayer& laid : look.artwork)
    head["artwork"].push_back({{"size_mm", {laid.size_mm.x(), laid.size_mm.y()}},
                               {"stretch", {laid.stretch_least, laid.stretch_most}}});
  head["dry_layers"] = layers_json(look.dry);
  head["warnings"] = Json::array();
  for (const std::string& warning : report.warnings)
    head["warnings"].push_back(in_plain_words(warning));
  Bundle bundle(std::move(head));
  add_film(bundle, film);
  add_sheet(bundle, ink, *printer.model);
  add_air(bundle, dipped);
  return bundle.finish();
}

std::vector<std::uint8_t> dip_bundle(const DippedObject& dipped) {
  const std::vector<DipFrame>& frames = dipped.history->frames();
  std::vector<float> positions;
  Json levels = Json::array(), poses = Json::array();
  for (const DipFrame& frame : frames) {
    levels.push_back(frame.moment.travelled_mm);
    if (frame.moment.moved) {
      Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
      pose.topLeftCorner<3, 3>() = frame.moment.turn;
      pose.topRightCorner<3, 1>() = frame.moment.shift - Vec3(0, 0, frame.moment.level_mm);
      poses.push_back(std::vector<double>(pose.data(), pose.data() + 16));
    }
    for (const auto& p : frame.position) positions.insert(positions.end(), p.begin(), p.end());
  }
  Json head = {{"frames", frames.size()}, {"levels_mm", levels}};
  if (!poses.empty()) head["poses"] = poses;
  Bundle bundle(std::move(head));
  bundle.add("position", positions, 3);
  bundle.add("attached_from", dipped.history->attached_from(), 1);
  return bundle.finish();
}

}  // namespace hydrodip
