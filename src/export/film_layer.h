// A quantity over the film coordinates of the part that lies on the object, as a small raster.
#pragma once

#include <string>

#include "base/context.h"
#include "render/appearance.h"
#include "transfer/film_cells.h"
#include "transfer/film_map.h"

namespace hydrodip {

struct FilmLayer : FilmCells {
  std::string
      key;  // known to the page's table of overlays: "color_error", "out_of_gamut", "pressed"
};

// CIEDE2000 between wanted and predicted colour, each averaged over the cell.
FilmLayer color_error_layer(const TriangleMesh& object, const FilmMap& map,
                            const Appearance& appearance, const RunContext& context);

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
