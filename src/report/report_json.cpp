#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "report/findings.h"
#include "report/report.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json value_json(const ReportValue& value) {
  struct Visitor {
    Json operator()(double v) const { return number(v); }
    Json operator()(std::int64_t v) const { return v; }
    Json operator()(bool v) const { return v; }
    Json operator()(const std::string& v) const { return v; }
    Json operator()(const std::array<double, 3>& v) const {
      return Json::array({number(v[0]), number(v[1]), number(v[2])});
    }
  };
  return std::visit(Visitor{}, value);
}

Json inputs_json(const Report& report) {
  Json list = Json::array();
  for (const ReportInput& input : report.inputs) {
    list.push_back({{"role", input.role},
                    {"path", input.path},
                    {"sha256", input.sha256},
                    {"bytes", input.bytes}});
  }
  return list;
}

Json outputs_json(const Report& report) {
  Json list = Json::array();
  for (const ReportOutput& output : report.outputs) {
    list.push_back({{"name", output.name}, {"description", output.description}});
  }
  return list;
}

Json parameters_json(const Report& report) {
  Json object = Json::object();
  for (const ReportParameter& parameter : report.parameters) {
    object[parameter.name] = {{"value", value_json(parameter.value)},
                              {"unit", parameter.unit},
                              {"changed", parameter.changed}};
  }
  return object;
}

Json figures_json(const std::vector<ReportFigure>& figures) {
  Json object = Json::object();
  for (const ReportFigure& figure : figures) object[figure.key] = value_json(figure.value);
  return object;
}

Json rounds_json(const Report& report) {
  Json list = Json::array();
  for (const ReportRound& round : report.rounds) {
    Json entry = {{"process", round.process}, {"round", round.round}};
    entry.update(figures_json(round.figures));
    list.push_back(entry);
  }
  return list;
}

Json coverage_json(const Coverage& c) {
  return {{"object_mm2", number(c.object_mm2)},
          {"covered_mm2", number(c.covered_mm2)},
          {"covered_share", number(c.covered_share())},
          {"doubtful_mm2", number(c.doubtful_mm2)},
          {"downward_mm2", number(c.downward_mm2)},
          {"covered_downward_mm2", number(c.covered_downward_mm2)},
          {"covered_downward_share", number(c.covered_downward_share())},
          {"film_on_object_mm2", number(c.film_on_object_mm2)},
          {"torn_mm2", number(c.torn_mm2)},
          {"torn_share", number(c.torn_share())}};
}

Json point_json(const Vec3& p) { return {number(p.x()), number(p.y()), number(p.z())}; }

Json way_json(const std::vector<WayPoint>& way) {
  Json rows = Json::array();
  for (const WayPoint& w : way)
    rows.push_back({{"travelled_mm", number(w.travelled_mm)},
                    {"lower_mm", number(w.pose.lower_mm)},
                    {"shift_x_mm", number(w.pose.shift_x_mm)},
                    {"shift_y_mm", number(w.pose.shift_y_mm)},
                    {"turn_x_deg", number(w.pose.turn_x_deg)},
                    {"turn_y_deg", number(w.pose.turn_y_deg)},
                    {"turn_z_deg", number(w.pose.turn_z_deg)}});
  return rows;
}

Json air_json(const TrappedAir& air) {
  Json pockets = Json::array();
  for (const AirPocket& pocket : air.pockets) {
    Json one = {{"area_mm2", number(pocket.area_mm2)},
                {"volume_mm3", number(pocket.volume_mm3)},
                {"closed_at_mm", number(pocket.closed_at_mm)},
                {"top_mm", point_json(pocket.top)},
                {"escapes_share", number(pocket.escapes_share)}};
    if (pocket.lets_out)
      one["lets_out"] = {{"tilt_deg", number(pocket.lets_out->tilt_deg)},
                         {"tilt_toward_deg", number(pocket.lets_out->toward_deg)}};
    pockets.push_back(std::move(one));
  }
  Json vents = Json::array();
  for (const AirVent& vent : air.vents)
    vents.push_back({{"at_mm", point_json(vent.at)},
                     {"width_mm", number(vent.width_mm)},
                     {"area_mm2", number(vent.area_mm2)}});
  return {{"area_mm2", number(air.area_mm2())},
          {"volume_mm3", number(air.volume_mm3())},
          {"cell_mm", number(air.cell_mm)},
          {"pockets", std::move(pockets)},
          {"vents", std::move(vents)}};
}

Json stretch_json(const Coverage& c) {
  return {{"stretch_mean", number(c.stretch_mean)},
          {"stretch_max", number(c.stretch_max)},
          {"area_ratio_mean", number(c.area_ratio_mean)},
          {"area_ratio_max", number(c.area_ratio_max)}};
}

Json angles_json(const DipAngles& angles) {
  return {{"limit_deg", kDipAngleLimit_deg},
          {"bin_deg", 10},
          {"area_mm2", angles.area_mm2},
          {"downward_mm2", number(angles.downward_mm2)},
          {"vertical_or_upward_mm2", number(angles.upward_mm2)},
          {"over_limit_mm2", number(angles.over_limit_mm2)},
          {"over_limit_share", number(angles.over_limit_share())}};
}

Json mesh_json(const MeshHealth& mesh) {
  return {{"vertices", mesh.vertices},
          {"triangles", mesh.triangles},
          {"degenerate_removed", mesh.degenerate_removed},
          {"duplicates_removed", mesh.duplicates_removed},
          {"flipped", mesh.flipped},
          {"boundary_edges", mesh.boundary_edges},
          {"holes", mesh.holes},
          {"nonmanifold_edges", mesh.nonmanifold_edges},
          {"shells", mesh.shells},
          {"closed", mesh.closed()},
          {"volume_mm3", number(mesh.volume_mm3)},
          {"area_mm2", number(mesh.area_mm2)},
          {"findings", mesh.findings()}};
}

Json findings_json(const Report& report) {
  Json list = Json::array();
  for (const Finding& finding : findings(report)) {
    list.push_back({{"key", finding.key},
                    {"concern", concern_name(finding.concern)},
                    {"title", finding.title},
                    {"figure", finding.figure},
                    {"text", finding.text},
                    {"advice", finding.advice}});
  }
  return list;
}

Json ink_json(const ReportInk& ink) {
  Json json = {{"density_max", number(ink.density_max)}};
  if (ink.density_limit > 0) json["density_limit"] = number(ink.density_limit);
  json["mean"] = {{"cyan", number(ink.mean[0])},
                  {"magenta", number(ink.mean[1])},
                  {"yellow", number(ink.mean[2])},
                  {"black", number(ink.mean[3])}};
  return json;
}

Json colors_json(const ReportColors& colors) {
  return {{"error_mean_ciede2000", number(colors.error_mean)},
          {"error_95_percent_ciede2000", number(colors.error_most_of)}};
}

Json dips_json(const Report& report) {
  Json list = Json::array();
  for (const ReportDip& dip : report.dips)
    list.push_back({{"down", dip.down},
                    {"rotate_deg", dip.rotate_deg},
                    {"depth_mm", number(dip.depth_mm)},
                    {"hold", dip.hold},
                    {"folder", dip.folder},
                    {"part_share", number(dip.part_share)},
                    {"gained_share", number(dip.gained_share)},
                    {"covered_share", number(dip.covered_share)},
                    {"torn_share", number(dip.torn_share)}});
  for (std::size_t k = 0; k < report.dips.size(); ++k) {
    Json path = Json::array();
    for (const Keyframe& key : report.dips[k].path)
      path.push_back({number(key.lower_mm), number(key.shift_x_mm), number(key.shift_y_mm),
                      number(key.turn_x_deg), number(key.turn_y_deg), number(key.turn_z_deg)});
    list[k]["path"] = std::move(path);
    if (const auto& share = report.dips[k].gained_wanted_share)
      list[k]["gained_wanted_share"] = number(*share);
  }
  return list;
}

Json seams_json(const ReportSeams& seams) {
  return {{"length_mm", number(seams.length_mm)},
          {"overlap_mm", number(seams.overlap_mm)},
          {"error_mean_ciede2000", number(seams.error_mean)},
          {"off_mm", number(seams.off_mm)},
          {"error_mean_off_ciede2000", number(seams.error_mean_off)}};
}

Json seconds_json(const Report& report) {
  double total = 0;
  Json stages = Json::array();
  for (const ReportStage& stage : report.stages) {
    total += stage.seconds;
    stages.push_back({{"stage", stage.name}, {"seconds", number(stage.seconds)}});
  }
  if (report.total_seconds > 0) total = report.total_seconds;
  return {{"total", number(total)}, {"stages", stages}};
}

}  // namespace

std::string dip_angles_json(const DipAngles& angles) { return angles_json(angles).dump(); }

std::string report_json(const Report& report) {
  Json json;
  json["schema_version"] = kReportSchemaVersion;
  json["tool"] = {{"name", "hydrodip"}, {"version", report.tool_version}};
  json["command"] = report.command;
  json["command_line"] = report.command_line;
  json["title"] = title_of(report);
  json["verdict"] = verdict_of(report);
  json["concern"] = concern_name(concern_of(findings(report)));
  json["findings"] = findings_json(report);
  json["warnings"] = report.warnings;
  json["inputs"] = inputs_json(report);
  json["outputs"] = outputs_json(report);
  json["parameters"] = parameters_json(report);
  if (report.coverage) {
    json["coverage"] = coverage_json(*report.coverage);
    json["stretch"] = stretch_json(*report.coverage);
    json["wrinkled_mm2"] = number(report.coverage->wrinkled_mm2);
    json["lifted_mm2"] = number(report.coverage->lifted_mm2);
  }
  if (report.wanted)
    json["wanted"] = {{"object_mm2", number(report.wanted->object_mm2)},
                      {"covered_mm2", number(report.wanted->covered_mm2)},
                      {"covered_share", number(report.wanted->covered_share())},
                      {"doubtful_mm2", number(report.wanted->doubtful_mm2)},
                      {"doubtful_share", number(report.wanted->doubtful_share())}};
  if (const auto missed = missed_share(report)) json["missed_share"] = number(*missed);
  if (!report.way_in.empty()) json["way_in"] = way_json(report.way_in);
  if (report.air) json["air"] = air_json(*report.air);
  if (report.coverage) json["short_verdict"] = short_verdict(report);
  if (report.dip_number > 0)
    json["dip_of_several"] = {{"number", report.dip_number}, {"of", report.dip_of}};
  if (!report.dips.empty()) json["dips"] = dips_json(report);
  if (report.seams) json["seams"] = seams_json(*report.seams);
  if (!report.better_way.empty()) json["better_way"] = report.better_way;
  if (report.angles) json["dip_angles"] = angles_json(*report.angles);
  if (report.mesh) json["mesh"] = mesh_json(*report.mesh);
  if (report.ink) json["ink"] = ink_json(*report.ink);
  if (report.colors) json["colors"] = colors_json(*report.colors);
  json["figures"] = figures_json(report.figures);
  json["rounds"] = rounds_json(report);
  json["seconds"] = seconds_json(report);
  if (report.peak_memory_bytes > 0) json["peak_memory_bytes"] = report.peak_memory_bytes;
  // Paths need not be UTF-8; JSON must be.
  return json_text(json);
}

}  // namespace hydrodip
