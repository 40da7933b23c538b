// preview.png and preview.glb: what the dipped object will look like beside what was asked for.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "film/film.h"
#include "report/appearance.h"

namespace hydrodip {

struct PreviewOptions {
  int width_px = 1600;
  LinearColor base{1, 1, 1, 1};
};

// What one picture shows side by side.
struct PreviewPair {
  Appearance shown;  // what is absent is the bare object
  std::array<std::string, 2> titles = {"wanted", "predicted"};
  std::string caption;  // one line under the picture, e.g. the verdict
};

// Ray-cast pictures, one for each pair: wanted beside predicted, from the two most telling
// directions (those that see most of the film-covered area and, second, most of what the first does
// not see), soft light, neutral ground.
std::vector<Image> render_previews(const Object& object, const Surface& surface,
                                   const DippedFilm& film, const std::vector<PreviewPair>& pairs,
                                   const PreviewOptions& options, RunContext& context);

// Binary glTF 2.0, y up, metres, the side that met the film (-z) facing the viewer (+z in glTF):
// the object in its base colour, and over it the film that lies on it, textured with `film_image`
// (whole sheet, row 0 at +y) by the film's own coordinates. That is the material variant
// "predicted" (KHR_materials_variants), shown by viewers that know no variants; "wanted" is the
// object in the model's own colours. No texture is longer than texture_px. `surface`: the object's.
void write_preview_glb(const std::filesystem::path& path, const Object& object,
                       const Surface& surface, const DippedFilm& film, const Image& film_image,
                       double sheet_width_mm, double sheet_height_mm, const LinearColor& base,
                       int texture_px = 2048);

// film.ply: binary little-endian; x y z u v state area_ratio stretch.
void write_film_ply(const std::filesystem::path& path, const DippedFilm& film);

}  // namespace hydrodip
