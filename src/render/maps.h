// maps.png and angles.png: where the film has a hard time. Colours on the object, from the two
// directions that the preview takes: the dipping angle with its limit; the film's stretch, and
// where it tears.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/context.h"
#include "film/film.h"
#include "object/dip_angles.h"
#include "render/appearance.h"
#include "render/normals.h"
#include "render/telling_views.h"
#include "render/view.h"
#include "transfer/coverage.h"
#include "transfer/film_map.h"

namespace hydrodip {

// Whether a point of one of the object's triangles stays in trapped air.
using InAir = std::function<bool(int triangle, const Vec3& position)>;

struct MapOptions {
  int width_px = 1600;
  double tear_stretch = 0;             // the film's limit, marked on the scale; 0: it never tears
  DoubtfulStretch doubtful = {};       // where it may tear or hold
  std::string caption;                 // one line under the picture
  DippingDirection direction_at = {};  // empty: straight down as deep as the film says
  InAir in_air = {};                   // where air keeps the water away; empty: nowhere
  Standing standing = {};              // how the object is shown
};

// Both maps side by side, a row for each direction. `map` is the film's over the same object.
Image render_maps(const TriangleMesh& object, const Surface& surface, const DippedFilm& film,
                  const FilmMap& map, const MapOptions& options, const RunContext& context);

// The same of views that are lit already, as wide as those are.
Image render_maps(const TellingViews& views, const TriangleMesh& object, const DippedFilm& film,
                  const FilmMap& map, const MapOptions& options, const RunContext& context);

// The angle map alone; no film is needed.
Image render_angle_map(const TriangleMesh& object, const Surface& surface,
                       const DippingDirection& direction_at, const MapOptions& options,
                       const RunContext& context);

// One line under the maps: shares beyond the limits. `coverage` may be null.
std::string map_caption(const DipAngles& angles, const Coverage* coverage);

// --- What the maps are made of ---

// Of the curved surface that the triangles stand for; edges sharper than 30 degrees stay edges.
std::vector<CornerNormals> map_normals(const TriangleMesh& object);

// Dipping angle at a point that met the water in this direction, degrees: 0 faces it, 180 faces
// away.
double angle_at(const TriangleMesh& object, const std::vector<CornerNormals>& normals,
                const SurfacePoint& point, const Vec3& direction = Vec3(0, 0, -1));

// Blue to pale up to the limit, orange to dark red beyond it, grey for what does not face down.
LinearColor angle_color(double angle_deg);

// Linear from 1 to the largest value on the scale; dark violet over green to yellow.
LinearColor stretch_color(double stretch, double largest);

// The end of the stretch scale: the film's limit, or without one what was measured, rounded up.
double stretch_scale_end(const DippedFilm& film, double tear_stretch);

// The maps as the two appearances of one view: `wanted` the angle, `predicted` the film; bare
// surface is grey, torn film hatched along the camera's diagonal, doubtful film the more the more
// doubtful it is. Keeps references.
struct MapScene {
  const TriangleMesh& object;
  const std::vector<CornerNormals>& normals;
  DippingDirection direction_at;  // what it has no answer for stays dry
  InAir in_air = {};
  const FilmMap* map = nullptr;  // null: no film
  double largest_stretch = 1;    // end of the scale
  DoubtfulStretch doubtful = {};
};
Appearance map_appearance(const MapScene& scene, const Camera& camera, double hatch_mm);

}  // namespace hydrodip
