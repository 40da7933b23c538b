#include "job/job_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/json_text.h"
#include "dip/travel.h"
#include "job/logo.h"
#include "job/sheet_of.h"
#include "job/ways.h"
#include "report/findings.h"
#include "settings/artwork_tables.h"
#include "settings/dip_tables.h"
#include "settings/params.h"
#include "settings/path_file.h"

namespace hydrodip {
namespace {

using json = nlohmann::ordered_json;

std::vector<ReportOutput> outputs(const std::string& command, const JobConfig& config) {
  const InkSide ink_side = config.print.ink_side;
  std::vector<ReportOutput> list;
  if (makes_sheet(command))
    list = {{"print.pdf", fmt::format("the sheet: print it at 100 % (no scaling), ink side {}",
                                      ink_side == InkSide::kUp ? "up" : "down")},
            {"print.png", "what the sheet will look like, sRGB"},
            {"print.tif", "the inks of the film image, CMYK with their ICC profile"}};
  if (makes_sheet(command) && config.pictures && config.film_image.empty())
    list.push_back({"gamut.png", "which colours cannot be reached, and by how much"});
  if (config.pictures)
    list.insert(list.end(),
                {{"preview.png", "what was asked for beside what will come out"},
                 {"maps.png", "dipping angle, stretch, doubt and tears on the object"}});
  list.insert(list.end(), {{"preview.glb", "the dipped object in 3D"},
                           {"film.ply", "the film after the dip"},
                           {"report.html", "everything about this job, for people"},
                           {"report.json", "the same for programs"}});
  return list;
}

ReportParameter describe_parameter(const Parameter& parameter, const JobConfig& config) {
  const ParameterValue value = parameter.get(config);
  ReportParameter described{parameter.name, parameter.unit, {}, value != parameter.default_value()};
  if (parameter.type == ParameterType::kInteger)
    described.value = static_cast<std::int64_t>(std::get<double>(value));
  else
    std::visit([&](const auto& v) { described.value = v; }, value);
  return described;
}

void describe_artwork(const std::vector<ArtworkLayer>& layers,
                      std::vector<ReportParameter>& parameters) {
  const std::vector<std::string> usual = layer_values({});
  for (std::size_t n = 0; n < layers.size(); ++n) {
    const std::vector<std::string> values = layer_values(layers[n]);
    for (std::size_t k = 0; k < values.size(); ++k)
      parameters.push_back({fmt::format("artwork[{}].{}", n + 1, layer_keys()[k].name),
                            layer_keys()[k].unit, values[k], values[k] != usual[k]});
  }
}

std::vector<ReportFigure> dip_figures(const DipStatistics& s) {
  return {
      {"steps", "Steps", std::int64_t(s.steps), ""},
      {"iterations", "Iterations", std::int64_t(s.iterations), ""},
      {"unconverged_steps", "Steps at the iteration bound", std::int64_t(s.unconverged_steps), ""},
      {"largest_residual_mm", "The furthest that film moved in any step's last iteration",
       s.largest_residual_mm, "mm"}};
}

std::vector<ReportFigure> ink_figures(const InkRound& round, bool first) {
  std::vector<ReportFigure> figures = {
      {"printed_area_mm2", "Printed area", round.printed_mm2, "mm2"},
      {"mean_modulus", "Mean stiffness over blank film", round.mean_modulus, ""},
      {"step_mm", "Steps of the dip", round.step_mm, "mm"},
      {"tears_kept", "Tears kept from before", round.tears_kept, ""}};
  if (!first)
    figures.insert(figures.begin(),
                   {"change_mm", "Mean change of whole film on the object", round.change_mm, "mm"});
  return figures;
}

std::vector<ReportRound> rounds(const JobRecord& record) {
  if (record.ink == nullptr) return {{"dip", 1, dip_figures(record.dipped().statistics)}};
  std::vector<ReportRound> list;
  const std::vector<InkRound>& made = record.ink->rounds;
  for (std::size_t n = 0; n < made.size(); ++n)
    list.push_back({"dip", int(n) + 1, dip_figures(made[n].dip)});
  for (std::size_t n = 0; n < made.size(); ++n)
    list.push_back({"ink", int(n) + 1, ink_figures(made[n], n == 0)});
  return list;
}

void add_ink(const JobRecord& record, std::vector<ReportFigure>& figures) {
  figures.push_back({"ink_model", "Inks by", record.ink_model, ""});
  if (record.ink == nullptr) return;
  const Reach& reach = record.ink->reach;
  figures.insert(
      figures.end(),
      {{"ink_rounds", "Rounds", std::int64_t(record.ink->rounds.size()), ""},
       {"ink_settled", "Ink settled", record.ink->settled, ""},
       {"ink_last_change_mm", "Mean change of whole film on the object by the last ink",
        record.ink->last_change_mm(), "mm"},
       {"lightened", "Factor on all inks (gamut.policy=scale)", record.ink->ink.inking.lightened,
        ""},
       {"out_of_gamut_mm2", "Colours that cannot be reached", reach.out_of_reach_mm2, "mm2"},
       {"out_of_gamut_share", "Share of the covered surface", reach.out_of_reach_share(), ""},
       {"out_of_gamut_difference", "Their mean difference (CIEDE2000)", reach.mean_beyond, ""},
       {"color_difference", "Mean difference everywhere (CIEDE2000)", reach.mean, ""},
       {"color_difference_in_gamut", "Mean difference of the others (CIEDE2000)", reach.mean_within,
        ""},
       {"color_difference_max", "Largest difference (CIEDE2000)", reach.largest, ""}});
}

}  // namespace

ReportFigure model_size(const PosedObject& posed) {
  const Vec3 size = posed.scale() * posed.object().bounds().size();
  return {"model_size_mm", "Model as it stands (x, y, z)",
          std::array<double, 3>{size.x(), size.y(), size.z()}, "mm"};
}

namespace {

std::vector<ReportFigure> figures(const DippedObject& dipped) {
  const Vec3 size = dipped.posed.mesh().bounds().size();
  const DippedFilm& film = *dipped.film;
  return {{"object_size_mm", "Object as posed (x, y, z)",
           std::array<double, 3>{size.x(), size.y(), size.z()}, "mm"},
          model_size(dipped.posed),
          {"depth_mm", "Depth of the dip", film.depth_mm, "mm"},
          {"film_triangles", "Film triangles", std::int64_t(film.mesh().triangles.size()), ""},
          {"film_cell_mm", "Film grid spacing", film.mesh().cell_mm, "mm"}};
}

std::string role_of(const std::filesystem::path& file, const JobConfig& config,
                    const PreparedObject& prepared) {
  if (file == config.model) return "model";
  for (const ArtworkLayer& layer : config.object.artwork)
    if (file == layer.image) return "artwork";
  for (const LaidLayer& layer : prepared.artwork)
    for (const FontUse& font : layer.fonts)
      if (file == font.file) return "font";
  const std::string extension = file.extension().string();
  if (extension == ".mtl" || extension == ".MTL") return "material";
  return extension == ".bin" ? "model data" : "texture";
}

}  // namespace

std::vector<ReportInput> describe_inputs(const JobConfig& config, const PreparedObject& prepared,
                                         const Printer& printer) {
  std::vector<ReportInput> inputs;
  for (const auto& file : prepared.files)
    inputs.push_back(describe_input(role_of(file, config, prepared), file));
  if (!config.film_image.empty()) inputs.push_back(describe_input("film image", config.film_image));
  if (!config.correction.empty()) inputs.push_back(describe_input("correction", config.correction));
  for (const DipEntry& dip : config.dips)
    if (!dip.correction.empty()) inputs.push_back(describe_input("correction", dip.correction));
  if (!printer.profile_file.empty())
    inputs.push_back({"printer profile", printer.profile_file.string(),
                      sha256_hex(printer.profile_bytes), printer.profile_bytes.size()});
  for (const auto& file : config.settings_files)
    inputs.push_back(describe_input(is_path_file(file) ? "path" : "settings", file));
  if (!config.report.logo.empty()) {
    inputs.push_back(describe_input("logo", config.report.logo));
    logo_png(config.report.logo);  // what is wrong with it is said before all the work
  }
  return inputs;
}

void announce_outputs(OutputFolder& folder, const std::string& command, const JobConfig& config,
                      const std::vector<ReportInput>& inputs) {
  std::vector<std::string> names;
  for (const ReportOutput& output : outputs(command, config)) names.push_back(output.name);
  std::vector<std::filesystem::path> paths;
  paths.reserve(inputs.size());
  for (const ReportInput& input : inputs) paths.emplace_back(input.path);
  folder.announce(names, paths);
}

// So many moments of a way that is not straight down, for those who have to go it.
constexpr int kWayRows = 12;

std::vector<WayPoint> way_in(const JobConfig& config, const TriangleMesh& mesh) {
  const Trajectory way = make_trajectory(config.design.trajectory, mesh.positions);
  std::vector<WayPoint> rows;
  if (way.is_straight_down()) return rows;
  const Travel travel(way, mesh.positions, mesh.triangles);
  for (int row = 0; row <= kWayRows; ++row) {
    const double travelled = travel.length_mm() * row / kWayRows;
    rows.push_back({travelled, way.at(travel.at(travelled).t)});
  }
  return rows;
}

ReportEquilibrium equilibrium_of(const DipStatistics& dip, const InkResult* ink) {
  return {dip.steps, dip.unconverged_steps, dip.largest_residual_mm,
          ink != nullptr && !ink->settled ? ink->last_change_mm() : 0};
}

Report make_report(const JobRecord& record) {
  Report report;
  report.tool_version = HYDRODIP_VERSION;
  report.command = record.command;
  report.command_line = record.config.command_line;
  report.title = record.config.print.job_name;
  report.for_customer = record.config.report.for_customer;
  report.draft = is_draft(record.config.design);
  report.equilibrium = equilibrium_of(record.dipped().statistics, record.ink);
  report.better_way = record.better_way;
  report.inputs = record.inputs;
  for (const Parameter& parameter : parameters())
    report.parameters.push_back(describe_parameter(parameter, record.config));
  describe_artwork(record.config.object.artwork, report.parameters);
  for (const Timing& time : record.times.list()) report.stages.push_back({time.what, time.seconds});
  report.total_seconds = record.times.total_s();
  report.rounds = rounds(record);
  report.coverage = record.dipped().coverage;
  report.wanted = record.wanted;
  report.ink = record.laid;
  report.air = record.dipped().air;
  report.way_in = way_in(record.config, record.dipped().posed.mesh());
  report.angles = record.dipped().angles;
  report.mesh = record.prepared.health;
  report.tear_stretch = record.config.design.dip.material.tear_stretch;
  report.finished_image = !record.config.film_image.empty();
  report.found_best = is_best_found(record.config);
  report.has_artwork = !record.config.object.artwork.empty();
  report.one_dip_only = record.prepared.paint->depends_on_film();
  if (makes_sheet(record.command)) report.bleed_mm = record.config.design.inverse.bleed_mm;
  report.figures = figures(record.dipped());
  for (std::size_t n = 0; n < record.prepared.artwork.size(); ++n)
    report.figures.push_back({fmt::format("artwork_{}", n + 1),
                              "Artwork: " + record.prepared.artwork[n].name,
                              describe(record.prepared.artwork[n]), ""});
  add_ink(record, report.figures);
  report.warnings = record.context.warnings();
  report.outputs = outputs(record.command, record.config);
  report.peak_memory_bytes = peak_memory_bytes();
  return report;
}

namespace {

std::string better_dips(const Report& report) {
  if (!more_dips_may_help(report)) return "hydrodip plan looks for better ways to hold it.\n";
  return fmt::format(
      "hydrodip plan looks for better ways to hold it, and for more of them with --dips {}.\n",
      report.dips.size() + 1);
}

}  // namespace

JobResult describe_result(const Report& report, const std::filesystem::path& folder,
                          const std::string& places) {
  JobResult result;
  result.folder = folder;
  const Concern concern = concern_of(findings(report));
  result.do_not_dip = concern == Concern::kStop;
  result.text = headline(concern) + ". " + verdict_of(report) + "\n";
  if (!report.better_way.empty())
    result.text += "Better: " + report.better_way + "\n";
  else if (report.found_best && result.do_not_dip)
    result.text += beyond_best_dip(report) + "\n";
  else if (result.do_not_dip && !is_inside_out(report))
    result.text += report.dips.empty()
                       ? fmt::format(
                             "hydrodip orient looks for better ways to hold it; --rotate "
                             "auto{} takes the best.\n",
                             report.way_in.empty() ? " --depth auto" : "")
                       : better_dips(report);
  result.text += places + fmt::format("wrote to {}:\n", folder.string());
  for (const ReportOutput& output : report.outputs) {
    result.files.push_back(output.name);
    result.text += fmt::format("  {:<12} {}\n", output.name, output.description);
  }
  for (const std::string& warning : report.warnings) result.text += "warning: " + warning + "\n";

  json machine = {{"folder", folder.string()}};
  machine.update(json::parse(report_json(report)));
  result.json = json_text(machine);
  return result;
}

}  // namespace hydrodip
