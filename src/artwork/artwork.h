// Layers of artwork over the colours that an object has: a paint like any other.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "artwork/laid_layer.h"
#include "artwork/layer.h"
#include "artwork/picture.h"
#include "base/context.h"
#include "object/paint.h"
#include "object/posed_object.h"

namespace hydrodip {

// Pictures are read before anything else, so that a broken one is named before anything is computed
// or found wrong with a model. In the layers' order. Throws InputError.
std::vector<PictureSource> read_pictures(const std::vector<ArtworkLayer>& layers);

struct ArtworkTask {
  std::vector<ArtworkLayer> layers;     // the bottom one first
  std::vector<PictureSource> pictures;  // of the layers
  std::shared_ptr<const Paint> under;   // of the same object
  bool closed = true;                   // the object has an inside (MeshHealth::closed())
  double dpi = 300;                     // of what is printed
  int samples_per_axis = 3;             // that a printed pixel is made of
};

// "40.0 x 20.0 mm, stretched 0.93 to 1.00 times, set in DejaVu Sans Bold".
std::string describe(const LaidLayer& layer);

// Where nothing of artwork comes out: if every layer is thinner than a pixel of that resolution,
// how large the first is and how to mend it. Else empty.
std::string told_thin(const std::vector<LaidLayer>& layers, double dpi);

struct Artwork {
  std::shared_ptr<const Paint> paint;
  std::vector<LaidLayer> layers;
};

// Every layer laid on the object. Layers on the film show where a film coordinate is given
// (Paint::color_on_film). Warns of pictures that wrap over themselves. Throws InputError for
// artwork that lies nowhere on the object, or is thinner than any printer's pixels. Memory: the
// pictures, and a byte per triangle and layer; with `wrap` some 60 bytes.
Artwork lay_artwork(ArtworkTask task, const PosedObject& posed, const RunContext& context);

}  // namespace hydrodip
