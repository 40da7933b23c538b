#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "calibrate/calibrate.h"
#include "calibrate/pictures.h"
#include "calibrate/subject.h"
#include "image/files.h"

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

struct Method {
  const char* name;
  DipMethod method;
};
constexpr Method kMethods[] = {{"full", DipMethod::kFull},
                               {"single-step", DipMethod::kSingleStep},
                               {"projection", DipMethod::kProjection}};

// One scan by one method.
struct Measurement {
  const char* method = "";
  GridError error;
  Alignment alignment;
  std::size_t unknown = 0;  // corners without film
  ErrorMap map;
};

Measurement measure(const Subject& subject, const CheckeredFilm& film, const DesignOptions& design,
                    const Method& method, double square_mm, const RunContext& context) {
  DipOptions options = design.dip;
  options.method = method.method;
  const CheckerboardDip dip = dip_checkerboard(film, subject.object, *subject.surface,
                                               film_parameters(design), options, context);
  Comparison comparison = compare(subject, dip);
  Measurement result;
  result.method = method.name;
  result.alignment = comparison.alignment;
  result.map.errors = length_errors(subject.lengths, comparison.warped, square_mm);
  result.error = grid_error(result.map.errors, square_mm);
  for (const auto& corner : comparison.warped) result.unknown += !corner;
  result.map.warped = std::move(comparison.warped);
  result.map.title = fmt::format("{}, {}", subject.name, method.name);
  result.map.figure =
      fmt::format("{:.4f} mm, worst {:.3f} mm", result.error.rms_mm, result.error.worst_mm);
  return result;
}

Json json_of(const Subject& subject, const std::vector<Measurement>& measurements) {
  Json methods;
  for (const Measurement& m : measurements)
    methods[m.method] = {{"rms_mm", m.error.rms_mm},
                         {"literal_mm05", m.error.literal},
                         {"mean_mm", m.error.mean_mm},
                         {"worst_mm", m.error.worst_mm},
                         {"edge_rms_mm", m.error.edge_rms_mm},
                         {"diagonal_rms_mm", m.error.diagonal_rms_mm},
                         {"edges", m.error.edges},
                         {"diagonals", m.error.diagonals},
                         {"corners_without_film", m.unknown}};
  return {{"name", subject.name},
          {"file", subject.file.string()},
          {"synthetic", subject.scan.synthetic},
          {"depth_mm", subject.object.depth_mm},
          {"corners", subject.scan.grid.position.size()},
          {"off_surface_rms_mm", measurements.front().alignment.rms_mm},
          {"off_surface_worst_mm", measurements.front().alignment.worst_mm},
          {"methods", methods}};
}

std::string text_of(const Subject& subject, const std::vector<Measurement>& measurements) {
  std::string text = fmt::format(
      "{} ({}{}): {} corners, {:.3f} mm off the surface\n"
      "  {:<12} {:>9} {:>9} {:>9} {:>9} {:>9} {:>12} {:>8}\n",
      subject.name, subject.file.filename().string(),
      subject.scan.synthetic ? ", computed, not scanned" : "", subject.scan.grid.position.size(),
      measurements.front().alignment.rms_mm, "method", "Eq. 4, mm", "edges", "diagonals", "mean",
      "worst", "literal", "lengths");
  for (const Measurement& m : measurements)
    text += fmt::format(
        "  {:<12} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>7.4f} mm^.5 {:>6}\n", m.method,
        m.error.rms_mm, m.error.edge_rms_mm, m.error.diagonal_rms_mm, m.error.mean_mm,
        m.error.worst_mm, m.error.literal, m.error.edges + m.error.diagonals);
  return text;
}

}  // namespace

JobResult measure_job(const JobConfig& given, const CalibrationRequest& request,
                      const RunContext& context) {
  const RunScope scope(context.with_threads(given.threads));
  const ScanSetup setup = scan_setup(given, request);
  const JobConfig& config = setup.config;
  const Board& board = setup.settings.board;
  const std::vector<Subject> subjects =
      load_subjects(request.scans, setup.settings, config, context);
  const CheckeredFilm film = checkered_film(config.design, board);

  JobResult result;
  Json scans = Json::array();
  std::vector<std::vector<ErrorMap>> maps;
  for (const Subject& subject : subjects) {
    std::vector<Measurement> measurements;
    for (const Method& method : kMethods)
      measurements.push_back(
          measure(subject, film, config.design, method, board.square_mm, context));
    const Measurement& full = measurements.front();
    const std::size_t corners = subject.scan.grid.position.size();
    require_film_on_most(subject, {full.error.edges > 0 ? full.unknown : corners, corners},
                         context);
    scans.push_back(json_of(subject, measurements));
    result.text += text_of(subject, measurements);
    maps.emplace_back();
    for (Measurement& m : measurements) maps.back().push_back(std::move(m.map));
  }
  for (const std::string& warning : context.warnings())
    result.text += fmt::format("warning: {}\n", warning);
  const FilmParameters parameters = film_parameters(config.design);
  result.json = json_answer(
      "measure",
      {{"folder", config.output.string()},
       {"parameters",
        {{"z_stretch", parameters.z_stretch},
         {"ink_stiffness_ratio", parameters.stiffness_ratio},
         {"poisson", parameters.poisson}}},
       {"swelling", {{"x", config.design.film.swelling_x}, {"y", config.design.film.swelling_y}}},
       {"board", board.name},
       {"square_mm", board.square_mm},
       {"scans", scans},
       {"warnings", context.warnings()}});
  if (config.output.empty()) return result;

  OutputFolder folder(config.output, config.earlier_result);
  folder.announce({"error-map.png", "measure.json"}, files_of(subjects, config));
  save_png(folder.path("error-map.png"),
           draw_error_maps(maps, any_synthetic(subjects)
                                     ? "Some of these scans were computed, not scanned."
                                     : "Scans carried back to the film."));
  write_file(folder.path("measure.json"), result.json);
  context.check_cancelled();
  folder.commit();
  result.text += folder.told_replaced();
  result.folder = config.output;
  result.files = {"error-map.png", "measure.json"};
  for (const std::string& file : result.files)
    result.text += fmt::format("wrote {}\n", (config.output / file).string());
  return result;
}

}  // namespace hydrodip
