// A quantity over the film coordinates of the part that lies on the object, as a small raster.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/context.h"
#include "render/appearance.h"
#include "transfer/film_map.h"

namespace hydrodip {

struct FilmLayer {
  std::string
      key;      // known to the page's table of overlays: "color_error", "out_of_gamut", "pressed"
  Box2 extent;  // film coordinates, mm
  int width = 0, height = 0;  // cells
  std::vector<float> values;  // row 0 at +y; NaN where there is nothing
};

// CIEDE2000 between wanted and predicted colour, each averaged over the cell.
FilmLayer color_error_layer(const TriangleMesh& object, const FilmMap& map,
                            const Appearance& appearance, const RunContext& context);

// From a value per pixel of the film image (`width_px` x `height_px` over the whole sheet, row by
// row; NaN: nothing there): means over cells, within the film coordinates `extent`.
FilmLayer pixel_layer(const std::string& key, const std::function<float(std::size_t pixel)>& value,
                      int width_px, int height_px, const Vec2& sheet_mm, const Box2& extent);

// By how many percent film that lies on the object is pressed together where it is most: 100 (1 -
// smallest principal stretch), never below 0.
FilmLayer pressed_layer(const DippedFilm& film, const Box2& extent);

// Of the values that are there; all 0 if there are none.
struct LayerSummary {
  double mean = 0;
  double most_of = 0;  // 95 % of the area has no more
};
LayerSummary summarize(const FilmLayer& layer);

}  // namespace hydrodip
