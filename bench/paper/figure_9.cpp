// Projection, single step and full method against the same truth, as figure 9; in numbers, for all
// three shapes. The truth is computed on a finer film: we have no scans.
#include <fmt/format.h>

#include "calibrate/pictures.h"
#include "calibrate/resolution.h"
#include "calibrate/synthetic.h"
#include "figures.h"
#include "image/files.h"
#include "scan/grid_error.h"
#include "study.h"

namespace hydrodip::paper {
namespace {

constexpr double kReach_mm = 2;

struct Method {
  const char* name;
  DipMethod method;
};
constexpr Method kMethods[] = {{"projection", DipMethod::kProjection},
                               {"single-step", DipMethod::kSingleStep},
                               {"full", DipMethod::kFull}};

CornerGrid true_corners(const CalibrationObject& object, const Surface& surface,
                        const DesignOptions& design, const RunContext& context) {
  const DesignOptions fine = finer_film(design);
  const CheckerboardDip dip =
      dip_checkerboard(checkered_film(fine, black_board(kSquare_mm)), object, surface,
                       film_parameters(design), fine.dip, context);
  return synthetic_scan(dip.landing(object), {30, 30}, {.aligned = true});
}

}  // namespace

std::string figure_9(const Study& study) {
  const JobConfig config = paper_config();
  const CheckeredFilm film = checkered_film(config.design, black_board(kSquare_mm));
  std::vector<std::vector<ErrorMap>> maps;
  Table table({"object", "projection (mm)", "single step (mm)", "full (mm)", "lengths"});
  for (const KitShape& shape : sample_shapes()) {
    const CalibrationObject object = calibration_object(shape.name, config, study.context);
    const Surface surface(object.object.positions, object.object.triangles);
    const CornerGrid grid = true_corners(object, surface, config.design, study.context);
    std::vector<std::string> cells = {shape.name};
    maps.emplace_back();
    GridError error;
    for (const Method& method : kMethods) {
      DipOptions options = config.design.dip;
      options.method = method.method;
      const CheckerboardDip dip = dip_checkerboard(
          film, object, surface, film_parameters(config.design), options, study.context);
      ErrorMap map;
      map.warped = warp(grid, surface, *dip.map, kReach_mm);
      map.errors = length_errors(grid_lengths(grid), map.warped, kSquare_mm);
      error = grid_error(map.errors, kSquare_mm);
      map.title = fmt::format("{}, {}", shape.name, method.name);
      map.figure = fmt::format("{:.4f} mm, worst {:.3f} mm", error.rms_mm, error.worst_mm);
      maps.back().push_back(std::move(map));
      cells.push_back(fmt::format("{:.4f}", error.rms_mm));
    }
    cells.push_back(std::to_string(error.edges + error.diagonals));
    table.add(cells);
  }
  save_png(study.folder / "figure_9.png",
           draw_error_maps(maps, "Computed scans, carried back to the film."));
  return table.text() +
         "\nEq. 4 as a root mean square over edges and diagonals. The truth is our own full method "
         "on "
         "a finer film, so that its column shows the film's resolution only, and the others how "
         "much "
         "gluing matters. The paper compares with real dips and shows pictures, no numbers.\n";
}

}  // namespace hydrodip::paper
