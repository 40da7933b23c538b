#include "study.h"

#include <algorithm>
#include <utility>

#include "image/resize.h"
#include "ink/stiffness.h"
#include "render/canvas.h"
#include "render/lit_view.h"
#include "render/normals.h"
#include "render/text.h"

namespace hydrodip::paper {
namespace {

constexpr int kGap_px = 12, kTitle_px = 34;

// From below and a little from the side, so that edges and slopes show.
const Vec3 kEye = Vec3(0.25, -0.45, -1).normalized();

ViewPair pictures_of(const PosedObject& object, const Appearance& look, int size_px,
                     const RunContext& context) {
  const TriangleMesh& mesh = object.mesh();
  const std::vector<CornerNormals> normals = corner_normals(mesh.positions, mesh.triangles);
  const LitObject lit{mesh, object.surface(), normals};
  return LitView(lit, frame_object(mesh, kEye, 1, 0.9), size_px, size_px, context)
      .show(look, {normals, 0.5});
}

DippedObject dip_film(const PosedObject& object, const SharedFilmMesh& film, const DipOptions& dip,
                      const DesignOptions& options, const RunContext& context) {
  Timings timings;
  const Trajectory trajectory = make_trajectory(options.trajectory, object.mesh().positions);
  return dip_object(object, film, trajectory, dip, timings, context);
}

// The wanted side of an appearance. Refers to the paint.
auto colors_of(const Paint& paint) {
  const bool says = paint.says_anything();
  return [&paint, says](const SurfacePoint& point, const Vec3&, const Vec3&) {
    return says ? paint.color_at(point) : paint.base();
  };
}

}  // namespace

JobConfig paper_config() {
  JobConfig config;
  config.design.film.width_mm = 215.9;
  config.design.film.height_mm = 279.4;
  config.design.dip.material.tear_stretch = 0;
  return config;
}

PosedObject posed(Object object) {
  return {std::make_shared<const Object>(std::move(object)), PoseOptions()};
}

DippedObject dip_printed(const PosedObject& object, const InkImage& inks,
                         const DesignOptions& options, const RunContext& context) {
  const auto film = std::make_shared<const FilmMesh>(make_film_mesh(options.film));
  DipOptions dip = options.dip;
  dip.modulus = film_modulus(*film, inks, raster_of(options.film, options.dpi), options.stiffness);
  return dip_film(object, film, dip, options, context);
}

DippedObject dip_blank(const PosedObject& object, const DesignOptions& options,
                       const RunContext& context) {
  const auto film = std::make_shared<const FilmMesh>(make_film_mesh(options.film));
  return dip_film(object, film, options.dip, options, context);
}

Designed designed(const PosedObject& object, const ColorModel& model, DesignOptions options,
                  int rounds, const RunContext& context) {
  Timings timings;
  options.rounds_max = rounds;
  const auto paint = model_paint(object.shared_object());
  return design({object, *paint, Allotment(), model, options}, timings, context);
}

Image panels(const std::vector<Panel>& list, int columns) {
  const int width = list.front().picture.width_px, height = list.front().picture.height_px;
  const int rows = (int(list.size()) + columns - 1) / columns;
  Image page = blank_page(columns * width + (columns + 1) * kGap_px,
                          rows * (height + kTitle_px) + (rows + 1) * kGap_px);
  const TextStyle style = text_style(13, kTitleInk);
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
                     int size_px, const RunContext& context) {
  const auto paint = model_paint(dipped.posed.shared_object());
  const auto predicted = [&](const SurfacePoint&, const Vec3& position, const Vec3& normal) {
    return predicted_color(film_image, raster, *dipped.map, position, normal, paint->base());
  };
  return pictures_of(dipped.posed, {colors_of(*paint), predicted}, size_px, context).predicted;
}

Image wanted_picture(const PosedObject& object, int size_px, const RunContext& context) {
  const auto paint = model_paint(object.shared_object());
  const auto wanted = colors_of(*paint);
  return pictures_of(object, {wanted, wanted}, size_px, context).wanted;
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
