#include "job/dip_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dip/dip.h"

namespace hydrodip {
namespace {

constexpr double kCheckerCell_mm = 10;

}  // namespace

std::unique_ptr<DippedObject> undipped(LoadedObject posed) {
  auto object = std::make_unique<DippedObject>();
  object->loaded = std::move(posed);
  object->surface =
      std::make_unique<Surface>(object->object().positions, object->object().triangles);
  return object;
}

void dip_again(DippedObject& dipped, const SharedFilmMesh& film, const Trajectory& trajectory,
               const DipOptions& options, StageTimes& times, RunContext& context) {
  const Object& object = dipped.object();
  times.measure("dip", [&] {
    DipHistory history;
    DipResult result = dip(film, object.positions, object.triangles, *dipped.surface, trajectory,
                           options, context, [&](auto&&... state) { history.record(state...); });
    dipped.map.reset();  // refers to the film that goes
    dipped.dip = std::move(result);
    dipped.history = std::move(history);
  });
  times.measure("map", [&] {
    context.progress("mapping", 0);
    dipped.map = std::make_unique<FilmMap>(object, *dipped.surface, dipped.film());
    dipped.coverage = measure_coverage(object, dipped.film());
    dipped.angles = dip_angles(object, dipped.film().depth_mm);
    context.progress("mapping", 1);
  });
}

SheetRaster sheet_raster(const JobConfig& config, double dpi) {
  return {config.film.width_mm, config.film.height_mm, dpi};
}

Appearance appearance(const DippedObject& dipped, const Image& film_image,
                      const SheetRaster& raster, const LinearColor& base) {
  Appearance result;
  if (dipped.object().has_appearance())
    result.wanted = [&dipped, base](const SurfacePoint& point, const Vec3&, const Vec3&) {
      return color_at(dipped.object(), point, base);
    };
  else
    result.wanted = [base](const SurfacePoint&, const Vec3&, const Vec3&) { return base; };
  result.predicted = [&dipped, &film_image, raster, base](const SurfacePoint&, const Vec3& position,
                                                          const Vec3& normal) {
    return predicted_color(film_image, raster, *dipped.map, position, normal, base);
  };
  return result;
}

namespace {

// Both kinds of image have 4 bytes a pixel.
template <class Pixels>
Pixels mirror_image(const Pixels& image) {
  Pixels result(image.width_px, image.height_px);
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x)
      std::copy_n(image.pixel(image.width_px - 1 - x, y), 4, result.pixel(x, y));
  return result;
}

}  // namespace

Image mirrored(const Image& image) { return mirror_image(image); }
InkImage mirrored(const InkImage& image) { return mirror_image(image); }

Image checkerboard(const SheetRaster& raster) {
  constexpr std::uint8_t kDark[4] = {38, 84, 124, 255};
  constexpr std::uint8_t kLight[4] = {255, 255, 255, 255};
  Image image(raster.width_px(), raster.height_px());
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) {
      const Vec2 u = raster.to_film(x + 0.5, y + 0.5) / kCheckerCell_mm;
      const bool dark = (long(std::floor(u.x())) + long(std::floor(u.y()))) % 2 != 0;
      std::copy_n(dark ? kDark : kLight, 4, image.pixel(x, y));
    }
  return image;
}

}  // namespace hydrodip
