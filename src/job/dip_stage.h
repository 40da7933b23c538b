// The stages that print and simulate share.
#pragma once

#include <memory>

#include "base/context.h"
#include "dip/dip_history.h"
#include "ink/inks.h"
#include "job/stage_times.h"
#include "object/dip_angles.h"
#include "object/surface.h"
#include "render/appearance.h"
#include "settings/config.h"
#include "transfer/coverage.h"
#include "transfer/film_map.h"
#include "transfer/raster.h"

namespace hydrodip {

// A dipped object with everything that later stages ask. The film map refers to its neighbours, so
// it stays where it was made.
struct DippedObject {
  LoadedObject loaded;  // posed
  std::unique_ptr<Surface> surface;
  DipResult dip;
  DipHistory history;
  std::unique_ptr<FilmMap> map;
  Coverage coverage;
  DipAngles angles;

  const Object& object() const { return loaded.object; }
  const DippedFilm& film() const { return dip.film; }
};

// The object alone, before any dip.
std::unique_ptr<DippedObject> undipped(LoadedObject posed);

// Simulates its dip on film that it fits; everything but the object is made anew. If that throws,
// the last dip stays.
void dip_again(DippedObject& dipped, const SharedFilmMesh& film, const Trajectory& trajectory,
               const DipOptions& options, StageTimes& times, RunContext& context);

// Where the sheet's pixels lie at `dpi`.
SheetRaster sheet_raster(const JobConfig& config, double dpi);

// Wanted: the model's own colours; predicted: `film_image`, which shows every pixel of the film as
// it looks on the object. Keeps references to all
// three.
Appearance appearance(const DippedObject& dipped, const Image& film_image,
                      const SheetRaster& raster, const LinearColor& base);

// Mirrors left and right: the film as seen from above, when the ink lies on its underside.
Image mirrored(const Image& image);
InkImage mirrored(const InkImage& image);

// A 10 mm checkerboard over the whole sheet: makes the film's stretch visible.
Image checkerboard(const SheetRaster& raster);

}  // namespace hydrodip
