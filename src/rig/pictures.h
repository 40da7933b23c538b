// Pictures of the object as it hangs at the stage, for the run sheet.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "image/image.h"

namespace hydrodip {

struct PosePicture {
  std::string caption;
  Image image;
};

// The dipped object of the job's preview.glb from the front (-y), from the right (+x) and from
// below, up as it hangs. Throws InputError if the file is missing or is no model.
std::vector<PosePicture> pose_pictures(const std::filesystem::path& preview_glb, int width_px,
                                       int height_px, RunContext& context);

}  // namespace hydrodip
