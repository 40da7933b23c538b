#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/output_folder.h"
#include "base/run_scope.h"
#include "calibrate/calibrate.h"
#include "calibrate/checkerboard_dip.h"
#include "calibrate/resolution.h"
#include "calibrate/synthetic.h"
#include "scan/read_scan.h"

namespace hydrodip {
namespace {

void check(const CalibrationRequest& request) {
  if (!(request.noise_mm >= 0 && request.noise_mm <= 10))
    throw InputError("--noise: give the noise in mm, from 0 to 10");
  if (!(request.missing_share >= 0 && request.missing_share < 1))
    throw InputError("--missing: give the share of corners to leave out, from 0 to below 1");
}

std::string truth_toml(const FilmParameters& truth, const FilmOptions& film) {
  return fmt::format(
      "# The parameters that these synthetic scans were computed with.\n[material]\n"
      "z_stretch = {}\nink_stiffness_ratio = {}\npoisson = {}\n\n[film]\n"
      "swelling_x = {}\nswelling_y = {}\n",
      truth.z_stretch, truth.stiffness_ratio, truth.poisson, film.swelling_x, film.swelling_y);
}

}  // namespace

JobResult synth_job(const JobConfig& config, const CalibrationRequest& request,
                    const RunContext& context) {
  check(request);
  require_no_correction_of_board(config);
  const RunScope scope(context.with_threads(config.threads));
  // Finer than any film that calibrate dips with the same configuration.
  const DesignOptions fine = finer_film(finer_film(config.design));
  const FilmParameters truth = film_parameters(config.design);
  const Board board = board_named(request.board, request.square_mm);
  const CheckeredFilm film = checkered_film(fine, board);
  OutputFolder folder(config.output, config.earlier_result);
  JobResult result;
  const GridPlace reach = reach_of(config.design.film, board.square_mm);
  nlohmann::ordered_json scans = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < request.scans.size(); ++i) {
    const CalibrationObject object = calibration_object(request.scans[i], config, context);
    const Surface surface(object.object.positions, object.object.triangles);
    const CheckerboardDip dip = dip_checkerboard(film, object, surface, truth, fine.dip, context);
    const CornerGrid grid = synthetic_scan(
        dip.landing(object), reach,
        {request.noise_mm, request.missing_share, request.seed * 1000 + i, request.aligned});
    const std::string comment = fmt::format(
        "{}: {} dipped {:g} mm, z_stretch {:g}, ink_stiffness_ratio {:g}, poisson {:g}, noise {:g} "
        "mm, seed {}",
        kSyntheticMark, object.name, object.depth_mm, truth.z_stretch, truth.stiffness_ratio,
        truth.poisson, request.noise_mm, request.seed);
    const std::string name = object.name + "-scan";
    write_scan_quads(folder.path(name + ".obj"), grid, comment);
    write_scan_table(folder.path(name + ".csv"), grid, comment);
    result.files.push_back(name + ".obj");
    result.files.push_back(name + ".csv");
    scans.push_back({{"name", object.name}, {"corners", grid.position.size()}});
  }
  write_file(folder.path("truth.toml"), truth_toml(truth, config.design.film));
  result.files.push_back("truth.toml");
  folder.announce(result.files, config.settings_files);
  context.check_cancelled();
  folder.commit();

  result.folder = config.output;
  result.text = folder.told_replaced();
  for (const std::string& file : result.files)
    result.text += fmt::format("wrote {}\n", (config.output / file).string());
  result.text += "These scans are computed, not measured: they test the calibration, not a film.\n";
  result.json =
      json_answer("calibrate synth",
                  {{"folder", config.output.string()}, {"files", result.files}, {"scans", scans}});
  return result;
}

}  // namespace hydrodip
