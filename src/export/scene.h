// What the report page's 3D view shows, as text to put into the page: object, film, dip, sheet.
#pragma once

#include <string>
#include <vector>

#include "base/context.h"
#include "dip/dip_history.h"
#include "export/film_layer.h"
#include "film/film.h"
#include "object/object.h"
#include "render/view.h"

namespace hydrodip {

// A finish of several coats, painted on the object: known to the page's table of overlays by its
// key: "none" (the colours), "parts", "finish_error".
struct FinishLook {
  std::string key;
  Object object;
};

struct SceneSource {
  const Object& object;
  const DippedFilm& film;
  const DipHistory& history;
  const Image& sheet;  // the film image, whole sheet as seen from above; a small copy will do
  double sheet_width_mm = 210;
  double sheet_height_mm = 297;
  double bath_width_mm = 370;
  double bath_height_mm = 270;
  double tear_stretch = 0;       // the film's limit; 0: it never tears
  LinearColor base{1, 1, 1, 1};  // the bare object's colour
  Standing standing = {};
  Vec3 first_look = -Vec3::UnitZ();  // from the object to the eye that opens the page; unit
  std::vector<FilmLayer> layers = {};
  // Not empty: what is predicted is these, and the film is one without triangles.
  std::vector<FinishLook> looks = {};
  int dips = 1;  // that made them
};

// One JSON object in ASCII without '<', so that it can stand in a script element. Lengths are
// quantised to a 65535th of the scene's extent. An object of very many triangles is simplified for
// the eye.
std::string scene_json(const SceneSource& source, const RunContext& context);

}  // namespace hydrodip
