#include "transfer/film_cells.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydrodip {
namespace {

TEST(CellMeans, KeepThePlaceOfPixels) {
  // 2000 x 1000 px over 200 x 100 mm: a value only right of x = 20 mm and above y = 10 mm.
  const SheetRaster raster{200, 100, 254};
  ASSERT_EQ(raster.width_px(), 2000);
  Box2 extent;
  extent.add({0, 0});
  extent.add({40, 20});
  CellMeans means(raster, extent);
  for (int y = 0; y < 400; ++y)
    for (int x = 1200; x < 2000; ++x) means.add(x, y, 3);
  const FilmCells cells = means.cells();
  ASSERT_EQ(cells.width, 400);
  for (int y = 0; y < cells.height; ++y)
    for (int x = 0; x < cells.width; ++x) {
      const float value = cells.values[std::size_t(y * cells.width + x)];
      const bool there = x >= cells.width / 2 && y < cells.height / 2;
      ASSERT_EQ(std::isnan(value), !there) << x << ", " << y;
      ASSERT_TRUE(std::isnan(value) || value == 3.0F);
    }
}

// A cell of 2 x 2 pixels.
TEST(CellMeans, AreMeansOfWhatWasAdded) {
  Box2 extent;
  extent.add({-40, -20});
  extent.add({40, 20});
  CellMeans means({80, 40, 254}, extent);
  means.add(10, 20, 1);
  means.add(11, 20, 2);
  means.add(10, 21, 6);
  means.add(12, 20, 5);
  const FilmCells cells = means.cells();
  EXPECT_EQ(cells.values[std::size_t(10 * cells.width + 5)], 3);
  EXPECT_EQ(cells.values[std::size_t(10 * cells.width + 6)], 5);
  EXPECT_TRUE(std::isnan(cells.values[std::size_t(10 * cells.width + 7)]));
}

TEST(CellMeans, OfNoFilmAreNone) {
  CellMeans means({80, 40, 254}, Box2());
  means.add(10, 20, 1);
  EXPECT_TRUE(means.cells().values.empty());
}

}  // namespace
}  // namespace hydrodip
