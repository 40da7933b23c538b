// The pictures of a finish: what comes out, which dip does what, and how far colours are off.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/context.h"
#include "coat/finish.h"
#include "job/finish_check.h"
#include "job/made_dips.h"
#include "object/object.h"
#include "plan/seams.h"

namespace hydrodip {

struct DipsPictures {
  std::vector<std::uint8_t> preview_png, dips_png;
  std::string scene;  // of the report's 3D view
};

// The colour of a dip's part, told apart by everybody.
LinearColor dip_color(std::size_t dip);

// The model's own mesh as it looks in the end, and by which dip.
struct PaintedFinish {
  Object colors, parts;
};
PaintedFinish paint_finish(const MadeDips& all, const SharedSurface& shared, const Finish& finish,
                           int texture_px);

// The object as it stands; `caption` is the preview's.
DipsPictures draw_dips(const MadeDips& all, const SharedSurface& shared, const Finish& finish,
                       const FinishCheck& check, const std::string& caption,
                       const RunContext& context);

}  // namespace hydrodip
