#include "study.h"

#include <algorithm>
#include <utility>

#include "image/resize.h"
#include "ink/stiffness.h"
#include "job/prepare.h"
#include "object/pose.h"
#include "render/canvas.h"
#include "render/normals.h"
#include "render/studio.h"
#include "render/text.h"

namespace hydrodip::paper {
namespace {

constexpr int kGap_px = 12, kTitle_px = 34;

// From below and a little from the side, so that edges and slopes show.
const Vec3 kEye = Vec3(0.25, -0.45, -1).normalized();

Image picture_of(const DippedObject& dipped, const Appearance& look, int size_px, bool wanted,
                 RunContext& context) {
  const Object& object = dipped.object();
  const std::vector<CornerNormals> normals = corner_normals(object.positions, object.triangles);
  const Studio studio{object, *dipped.surface, normals, true, 0.5};
  const ViewPair pair =
      LitView(studio, frame_object(object, kEye, 1, 0.9), size_px, size_px, context).show(look);
  return wanted ? pair.wanted : pair.predicted;
}

}  // namespace

JobConfig paper_config() {
  JobConfig config;
  config.film.width_mm = 215.9;
  config.film.height_mm = 279.4;
  config.dip.material.tear_stretch = 0;
  return config;
}

std::unique_ptr<DippedObject> to_dip(Object object) {
  LoadedObject loaded;
  apply_pose(object, pose_matrix(object, {}));
  loaded.object = std::move(object);
  return undipped(std::move(loaded));
}

void dip_printed(DippedObject& dipped, const SharedFilmMesh& film, const InkImage& inks,
                 const JobConfig& config, RunContext& context) {
  StageTimes times;
  DipOptions options = config.dip;
  options.modulus = film_modulus(*film, inks, sheet_raster(config, config.print.dpi),
                                 {config.ink.stiffness_ratio, config.ink.filter_mm});
  dip_again(dipped, film, trajectory(dipped.object(), config), options, times, context);
}

void dip_blank(DippedObject& dipped, const SharedFilmMesh& film, const JobConfig& config,
               RunContext& context) {
  StageTimes times;
  dip_again(dipped, film, trajectory(dipped.object(), config), config.dip, times, context);
}

InkResult designed(DippedObject& dipped, const SharedFilmMesh& film, const ColorModel& model,
                   JobConfig config, int rounds, RunContext& context) {
  StageTimes times;
  config.ink.rounds_max = rounds;
  return settle_ink(dipped, film, model, config, times, context);
}

Image panels(const std::vector<Panel>& list, int columns) {
  const int width = list.front().picture.width_px, height = list.front().picture.height_px;
  const int rows = (int(list.size()) + columns - 1) / columns;
  Image page = blank_page(columns * width + (columns + 1) * kGap_px,
                          rows * (height + kTitle_px) + (rows + 1) * kGap_px);
  TextStyle style;
  style.size_px = 13;
  style.color = kTitleInk;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const int column = int(i) % columns, row = int(i) / columns;
    const int x = kGap_px + column * (width + kGap_px);
    const int y = kGap_px + row * (height + kTitle_px + kGap_px);
    draw_centered(page, list[i].title, x + 0.5 * width, y + kTitle_px - 12, style);
    paste(page, list[i].picture, x, y + kTitle_px);
  }
  return page;
}

Image film_square(const Image& film_image, const SheetRaster& raster, double side_mm, int size_px) {
  const Vec2 corner = raster.to_pixel(Vec2(-side_mm / 2, side_mm / 2));
  const int side = int(side_mm / kMmPerInch * raster.dpi);
  Image cut(side, side);
  std::fill(cut.rgba.begin(), cut.rgba.end(), std::uint8_t{255});
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int from_x = int(corner.x()) + x, from_y = int(corner.y()) + y;
      if (from_x < 0 || from_y < 0 || from_x >= film_image.width_px ||
          from_y >= film_image.height_px)
        continue;
      const std::uint8_t* from = film_image.pixel(from_x, from_y);
      const float alpha = float(from[3]) / 255;
      for (int k = 0; k < 3; ++k)
        cut.pixel(x, y)[k] = linear_to_srgb8(alpha * srgb8_to_linear(from[k]) + (1 - alpha));
    }
  return resize(cut, size_px, size_px);
}

Image dipped_picture(const DippedObject& dipped, const Image& film_image, const SheetRaster& raster,
                     int size_px, RunContext& context) {
  const Appearance look = appearance(dipped, film_image, raster, {1, 1, 1, 1});
  return picture_of(dipped, look, size_px, false, context);
}

Image wanted_picture(const DippedObject& dipped, int size_px, RunContext& context) {
  Appearance look;
  look.wanted = [&](const SurfacePoint& point, const Vec3&, const Vec3&) {
    return color_at(dipped.object(), point, {1, 1, 1, 1});
  };
  look.predicted = look.wanted;
  return picture_of(dipped, look, size_px, true, context);
}

Table::Table(const std::vector<std::string>& header) {
  add(header);
  text_ += "|";
  for (std::size_t i = 0; i < header.size(); ++i) text_ += "---|";
  text_ += "\n";
}

void Table::add(const std::vector<std::string>& cells) {
  text_ += "|";
  for (const std::string& cell : cells) text_ += " " + cell + " |";
  text_ += "\n";
}

}  // namespace hydrodip::paper
