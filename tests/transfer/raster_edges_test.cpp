// Where the rasters of the film begin, end, and lie: tiles without film, symmetry, pixel centres.
#include <gtest/gtest.h>

#include "transfer/fixtures.h"

namespace hydrodip {
namespace {

using fixtures::kHalfSide_mm;

double outside_mm(const Vec2& u) {
  return (u.cwiseAbs() - Vec2::Constant(kHalfSide_mm)).cwiseMax(0).norm();
}

// At 300 dpi the image is worked on in tiles of 5.4 mm: some hold nothing but bleed.
TEST(RasterEdges, InkEndsWhereAWideBleedEnds) {
  const SheetRaster raster{60, 60, 300};
  const double pixel_mm = kMmPerInch / raster.dpi, bleed_mm = 6;
  const auto dipped = fixtures::mapped(fixtures::slab(), fixtures::film_on_slab(5000));
  RunContext context;
  InverseOptions options;
  options.bleed_mm = bleed_mm;
  const Image image =
      film_image(fixtures::paint_of(*dipped), *dipped->map, raster, options, Allotment(), context);
  const FilmStretch stretch = film_stretch(*dipped->map, raster, bleed_mm, context);
  long missing = 0, beyond = 0, off_object = 0, without_ratio = 0;
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) {
      const double outside = outside_mm(raster.to_film(x + 0.5, y + 0.5));
      const int ink = image.pixel(x, y)[3];
      missing += outside < bleed_mm - pixel_mm && ink != 255;
      beyond += outside > bleed_mm + pixel_mm && ink != 0;
      const auto i = std::size_t(y) * std::size_t(image.width_px) + std::size_t(x);
      off_object += outside > 1e-3 && stretch.on_object[i] != 0;
      without_ratio += outside < bleed_mm - pixel_mm && std::abs(stretch.area_ratio[i] - 1) > 1e-6;
    }
  EXPECT_EQ(missing, 0);
  EXPECT_EQ(beyond, 0);
  EXPECT_EQ(off_object, 0);
  EXPECT_EQ(without_ratio, 0);
}

// A quantity that is linear over the film comes out as what it is at each pixel's centre.
TEST(RasterEdges, TheStretchOfAPixelIsThatOfItsCentre) {
  DippedFilm film = fixtures::film_on_slab(5000);
  const auto ratio = [](const Vec2& u) { return 1.5 + 0.01 * u.x() - 0.007 * u.y(); };
  for (std::size_t v = 0; v < film.area_ratio.size(); ++v)
    film.area_ratio[v] = ratio(film.mesh().u[v]);
  const auto dipped = fixtures::mapped(fixtures::slab(), std::move(film));
  const SheetRaster raster{60, 60, 150};
  RunContext context;
  const FilmStretch stretch = film_stretch(*dipped->map, raster, 1, context);
  long on_object = 0;
  for (int y = 0; y < raster.height_px(); ++y)
    for (int x = 0; x < raster.width_px(); ++x) {
      const auto i = std::size_t(y) * std::size_t(raster.width_px()) + std::size_t(x);
      if (stretch.on_object[i] == 0) continue;
      ++on_object;
      ASSERT_NEAR(stretch.area_ratio[i], ratio(raster.to_film(x + 0.5, y + 0.5)), 1e-6);
    }
  const double pixel_mm = kMmPerInch / raster.dpi;
  const double film_mm2 = 4 * kHalfSide_mm * kHalfSide_mm;
  EXPECT_NEAR(double(on_object) * pixel_mm * pixel_mm / film_mm2, 1, 0.01);
}

// Film and object are their own mirror images, and so are the rasters, pixel by pixel.
TEST(RasterEdges, ASymmetricDipHasSymmetricRasters) {
  DippedFilm film = fixtures::film_on_slab(5000);
  for (std::size_t v = 0; v < film.area_ratio.size(); ++v)
    film.area_ratio[v] = 1 + 0.01 * std::abs(film.mesh().u[v].x());
  const auto dipped = fixtures::mapped(fixtures::slab(), std::move(film));
  const SheetRaster raster{60, 60, 127};  // an even number of pixels, 0.2 mm each
  RunContext context;
  const FilmStretch stretch = film_stretch(*dipped->map, raster, 1, context);
  const Image image =
      film_image(fixtures::paint_of(*dipped), *dipped->map, raster, {}, Allotment(), context);
  const int w = raster.width_px(), h = raster.height_px();
  const auto at = [&](int x, int y) { return std::size_t(y) * std::size_t(w) + std::size_t(x); };
  long uneven = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      uneven += stretch.on_object[at(x, y)] != stretch.on_object[at(w - 1 - x, y)];
      uneven += stretch.on_object[at(x, y)] != stretch.on_object[at(x, h - 1 - y)];
      uneven +=
          std::abs(stretch.area_ratio[at(x, y)] - stretch.area_ratio[at(w - 1 - x, y)]) > 1e-4;
      uneven += std::abs(image.pixel(x, y)[3] - image.pixel(w - 1 - x, y)[3]) > 1;
      uneven += std::abs(image.pixel(x, y)[3] - image.pixel(x, h - 1 - y)[3]) > 1;
    }
  EXPECT_EQ(uneven, 0);
}

}  // namespace
}  // namespace hydrodip
