// Corners found by their colours on computed scans with textures: how far they lie from where the
// dip laid them, and how many are misnumbered. `bench_corners [VIEWS [TEXEL_MM]]`: scans of each
// shape in random poses, under lamps from somewhere.
#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>

#include "base/run_scope.h"
#include "coloured_scan.h"
#include "scan/dark_squares.h"

namespace hydrodip {
namespace {

void study(const CalibrationObject& object, const JobConfig& config, int views, double texel_mm,
           const RunContext& context) {
  const RunScope scope(context);
  const Board board = tint_board(kTintSquare_mm);
  const Surface surface(object.object.positions, object.object.triangles);
  const CheckerboardDip dip =
      dip_checkerboard(checkered_film(config.design, board), object, surface, {0.65, 100, 0.1},
                       config.design.dip, context);
  const scans::ColouredScans scanner(object, surface, dip, texel_mm);
  scans::CornersFound all;
  std::size_t fewest = 1000000;
  for (int view = 1; view <= views; ++view) {
    const scans::ColouredScans::Scan scan = scanner.scan(std::uint32_t(view));
    const CornerGrid grid = grid_of_dark_squares(find_dark_squares(scan.object, board.square_mm));
    const scans::CornersFound found = scans::judge(grid, scan, dip.landing(object),
                                                   reach_of(config.design.film, board.square_mm));
    all.corners += found.corners;
    fewest = std::min(fewest, found.corners);
    all.misnumbered += found.misnumbered;
    all.rms_mm += found.rms_mm * found.rms_mm / views;
    all.worst_mm = std::max(all.worst_mm, found.worst_mm);
  }
  fmt::print("| {} | {} | {} ({} or more a view) | {} | {:.4f} | {:.4f} |\n", object.name, views,
             all.corners, fewest, all.misnumbered, std::sqrt(all.rms_mm), all.worst_mm);
  std::fflush(stdout);
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  using namespace hydrodip;
  const int views = argc > 1 ? std::max(1, atoi(argv[1])) : 17;
  const double texel_mm = argc > 2 ? std::clamp(atof(argv[2]), 0.02, 1.0) : 0.1;
  const RunContext context;
  JobConfig config;
  config.design.film.elements = 20000;
  fmt::print(
      "| shape | views | corners | misnumbered | rms, mm | worst, mm |\n|---|---|---|---|---|"
      "---|\n");
  for (const KitShape& kit : kit_shapes())
    study(calibration_object(kit.name, config, context), config, views, texel_mm, context);
  return 0;
}
