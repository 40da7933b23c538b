// preview.png: what the dipped object will look like beside what was asked for.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/context.h"
#include "film/film.h"
#include "render/appearance.h"
#include "render/telling_views.h"
#include "render/view.h"

namespace hydrodip {

struct PreviewOptions {
  int width_px = 1600;
  LinearColor base{1, 1, 1, 1};
  Standing standing;               // how the object is shown
  std::vector<SurfacePatch> told;  // what is to be seen; none: film on the object
};

// What one picture shows side by side.
struct PreviewPair {
  Appearance shown;  // what is absent is the bare object
  std::array<std::string, 2> titles = {"wanted", "predicted"};
  std::string caption;  // under the picture, in two lines at most, e.g. the verdict
  // On the left, instead of what is wanted, what the first pair has on the right.
  bool left_is_firsts_right = false;
};

// Ray-cast pictures, one for each pair: wanted beside predicted, from the two most telling
// directions (those that see most of what is told and, second, most of what the first does not
// see), soft light, neutral ground.
std::vector<Image> render_previews(const TriangleMesh& object, const Surface& surface,
                                   const DippedFilm& film, const std::vector<PreviewPair>& pairs,
                                   const PreviewOptions& options, const RunContext& context);
// The same of views that are lit already, as wide as those are.
std::vector<Image> render_previews(const TellingViews& views, const std::vector<PreviewPair>& pairs,
                                   const LinearColor& base, const RunContext& context);

}  // namespace hydrodip
