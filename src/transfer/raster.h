// The film image, pixel by pixel, in tiles: from the wanted appearance (inverse), or back onto the
// object (forward).
#pragma once

#include <cstdint>
#include <vector>

#include "base/context.h"
#include "film/film.h"
#include "image/image.h"
#include "object/paint.h"
#include "transfer/allotment.h"
#include "transfer/film_map.h"

namespace hydrodip {

// Where a sheet's pixels lie. The sheet is seen from above; row 0 is its +y edge, column 0 its -x
// edge. The image's centre is the sheet's, film coordinate (0, 0), and a pixel is 25.4 / dpi mm, so
// that the whole number of pixels may miss the sheet's edge by up to half a pixel.
struct SheetRaster {
  double width_mm = 210;
  double height_mm = 297;
  double dpi = 300;
  int width_px() const;
  int height_px() const;
  // Film coordinate of pixel coordinates (x right, y down; pixel centres at +0.5).
  Vec2 to_film(double x_px, double y_px) const;
  // And back.
  Vec2 to_pixel(const Vec2& u) const;
};

// The whole sheet of that film.
SheetRaster raster_of(const FilmOptions& film, double dpi);

struct InverseOptions {
  double bleed_mm = 1;       // extended colour around the touched region
  int samples_per_axis = 3;  // supersampling: squared per pixel; 1 to 8
  bool quick_look = false;   // a pixel has the colour of its middle
};

// The image to print: opaque where ink goes, transparent elsewhere (partial alpha along edges).
// Where the allotment gives this film a part s of the ink, it is paler: the light that the ink
// leaves of the base's is that of the whole ink to the power of s, so that films whose parts add up
// to 1 look like the whole ink when they lie over each other.
Image film_image(const Paint& paint, const FilmMap& map, const SheetRaster& raster,
                 const InverseOptions& options, const Allotment& allotment,
                 const RunContext& context);

// How far the film of every pixel ends up stretched.
struct FilmStretch {
  BlankArray<float> area_ratio;  // deformed over flat; within the bleed that of the nearest film
                                 // on the object, elsewhere 0: not known
  BlankArray<std::uint8_t> on_object;  // per pixel: its centre lies on the object
};
FilmStretch film_stretch(const FilmMap& map, const SheetRaster& raster, double bleed_mm,
                         const RunContext& context);

// The colour (linear) that a film image leaves at a film coordinate: bilinear, transparent outside.
// The image is centred on the sheet and has raster.dpi.
LinearColor sample_film_image(const Image& image, const SheetRaster& raster, const Vec2& u);

// Predicted appearance at a point of the object when `image` was printed and dipped; over base.
LinearColor predicted_color(const Image& image, const SheetRaster& raster, const FilmMap& map,
                            const Vec3& position, const Vec3& normal, const LinearColor& base);

}  // namespace hydrodip
