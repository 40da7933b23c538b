// A checkerboard dipped onto three shapes: what came out, what is simulated, and the image that the
// simulation says was printed. What came out is itself computed, on a finer film: we have no scans.
#include <fmt/format.h>

#include <chrono>

#include "calibrate/checkerboard_dip.h"
#include "calibrate/printed_board.h"
#include "calibrate/resolution.h"
#include "figures.h"
#include "image/files.h"
#include "samples/samples.h"
#include "study.h"

namespace hydrodip::paper {
namespace {

Image as_image(const InkImage& inks) {
  Image image(inks.width_px, inks.height_px);
  for (std::size_t i = 0; i < inks.cmyk.size(); i += 4) {
    for (std::size_t k = 0; k < 3; ++k) image.rgba[i + k] = std::uint8_t(255 - inks.cmyk[i + 3]);
    image.rgba[i + 3] = 255;
  }
  return image;
}

DippedObject dipped(const std::string& name, const DesignOptions& options,
                    const PrintedBoard& board, const RunContext& context) {
  return dip_printed(posed(make_sample(name)), board.inks, options, context);
}

// Every point of the film gets the colour that lies on the true object where the simulation takes
// the point. In a perfect simulation that is the printed image.
Image recovered(const DippedObject& truth, const DippedObject& simulated, const PrintedBoard& board,
                double& share_right) {
  const TriangleMesh& mesh = truth.posed.mesh();
  const Image printed = as_image(board.inks);
  Image image = printed;
  double right = 0, count = 0;
  for (int y = 0; y < image.height_px; ++y) {
    FilmMap::Cursor cursor;
    for (int x = 0; x < image.width_px; ++x) {
      std::uint8_t* pixel = image.pixel(x, y);
      std::fill_n(pixel, 4, std::uint8_t{255});
      const auto point = simulated.map->to_object(board.raster.to_film(x + 0.5, y + 0.5), cursor);
      if (!point) continue;
      const auto u =
          truth.map->to_film(position_at(mesh, *point), face_normal(mesh, point->triangle));
      if (!u) continue;
      const Vec2 from = board.raster.to_pixel(*u);
      const int fx = std::clamp(int(from.x()), 0, image.width_px - 1);
      const int fy = std::clamp(int(from.y()), 0, image.height_px - 1);
      std::copy_n(printed.pixel(fx, fy), 4, pixel);
      right += pixel[0] == printed.pixel(x, y)[0];
      ++count;
    }
  }
  share_right = count > 0 ? right / count : 0;
  return image;
}

}  // namespace

std::string figure_8(const Study& study) {
  DesignOptions options = paper_config().design;
  const PrintedBoard board = print_board(options.film, black_board(kSquare_mm));
  options.dpi = board.raster.dpi;
  const Image printed = as_image(board.inks);
  std::vector<Panel> pictures;
  Table table(
      {"object", "depth (mm)", "steps", "simulated in (s)", "pixels recovered rightly (%)"});
  for (const KitShape& shape : sample_shapes()) {
    options.trajectory.depth_mm = shape.depth_mm;
    const DippedObject truth = dipped(shape.name, finer_film(options), board, study.context);
    const auto begin = std::chrono::steady_clock::now();
    const DippedObject simulated = dipped(shape.name, options, board, study.context);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    double share = 0;
    const Image image = recovered(truth, simulated, board, share);
    const std::string name = shape.name;
    pictures.push_back({name + ", computed 'scan'",
                        dipped_picture(truth, printed, board.raster, kPicture_px, study.context)});
    pictures.push_back({name + ", simulated", dipped_picture(simulated, printed, board.raster,
                                                             kPicture_px, study.context)});
    pictures.push_back(
        {name + ", recovered image", film_square(image, board.raster, 80, kPicture_px)});
    table.add({name, fmt::format("{:g}", shape.depth_mm),
               std::to_string(simulated.statistics.steps), fmt::format("{:.1f}", time.count()),
               fmt::format("{:.2f}", 100 * share)});
  }
  save_png(study.folder / "figure_8.png", panels(pictures, 3));
  return table.text() +
         "\nThe 'scans' are computed on four times the triangles and half the step, with the "
         "paper's "
         "parameters; the paper has real ones. The paper's times, for 40,000 triangles: 1.7 "
         "minutes "
         "for one simulation, 7 to 10 minutes with all rounds.\n";
}

}  // namespace hydrodip::paper
