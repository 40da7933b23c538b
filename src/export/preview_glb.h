// preview.glb: what the dipped object will look like, and what was asked for, in 3D.
#pragma once

#include <filesystem>

#include "film/film.h"
#include "object/object.h"
#include "object/surface.h"

namespace hydrodip {

// Binary glTF 2.0, y up, metres, the side that met the film (-z) facing the viewer (+z in glTF):
// the object in its base colour, and over it the film that lies on it, textured with `film_image`
// (whole sheet, row 0 at +y) by the film's own coordinates. That is the material variant
// "predicted" (KHR_materials_variants), shown by viewers that know no variants; "wanted" is the
// object in the model's own colours. No texture is longer than texture_px. `surface`: the object's.
void write_preview_glb(const std::filesystem::path& path, const Object& object,
                       const Surface& surface, const DippedFilm& film, const Image& film_image,
                       double sheet_width_mm, double sheet_height_mm, const LinearColor& base,
                       int texture_px = 2048);

}  // namespace hydrodip
