// Where the object hangs: from the model's frame to the posed-object frame. Posed-object frame:
// mm, z up, bounding box centred over x = y = 0, lowest point at z = 0; it enters the water lowest
// point first.
#pragma once

#include "object/object.h"

namespace hydrodip {

enum class ModelSide { kMinusX, kPlusX, kMinusY, kPlusY, kMinusZ, kPlusZ };

// "-x"
const char* side_name(ModelSide side);

struct PoseOptions {
  double size_mm = 0;                   // scale so that the largest extent is this; 0: keep
  ModelSide down = ModelSide::kMinusZ;  // model side that enters first
  Vec3 rotate_deg = Vec3::Zero();       // then about fixed x, y, z, in that order
};

// 4x4 that takes model coordinates (mm) to the posed-object frame. Largest extent: of the model's
// own bounding box, before turning. `down` is the smallest rotation that brings that side to -z
// (for +z: half a turn about x).
// Throws InputError for a size that is not positive and finite, or angles that are no numbers.
Eigen::Matrix4d pose_matrix(const TriangleMesh& mesh, const PoseOptions& options);

// Applies it to every vertex.
void apply_pose(TriangleMesh& mesh, const Eigen::Matrix4d& pose);

}  // namespace hydrodip
