// Pictures of the object as it hangs at the stage, for the run sheet.
#pragma once

#include <string>
#include <vector>

#include "base/context.h"
#include "image/image.h"
#include "object/object.h"
#include "rig/rig_job.h"

namespace hydrodip {

struct PosePicture {
  std::string caption;
  Image image;
};

// The object from the front (-y), from the right (+x) and from below, up as it hangs: the model, if
// it is still what was printed, else the job's preview.glb. Throws InputError if that is missing or
// is no model.
std::vector<PosePicture> pose_pictures(const RigJob& job, int width_px, int height_px,
                                       const RunContext& context);

// A mesh in one colour.
struct ShownPart {
  TriangleMesh mesh;  // posed-object frame
  LinearColor color;
};
// All of them from the front, somewhat from above and from the right.
Image draw_parts(const std::vector<ShownPart>& parts, int width_px, int height_px,
                 const RunContext& context);

}  // namespace hydrodip
