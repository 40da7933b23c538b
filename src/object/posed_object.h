// An object as it hangs over the bath: a value that shares the object, which stays as it was
// loaded.
#pragma once

#include <memory>

#include "object/object.h"
#include "object/pose.h"
#include "object/surface.h"

namespace hydrodip {

// Immutable; copies share everything. Surface points (triangle, u, v) mean the same on the object
// in any pose.
class PosedObject {
 public:
  PosedObject(std::shared_ptr<const Object> object, const PoseOptions& pose);

  const Object& object() const { return *object_; }  // in the model's frame
  const std::shared_ptr<const Object>& shared_object() const { return object_; }

  // In the posed-object frame (object/pose.h).
  const TriangleMesh& mesh() const { return *mesh_; }
  const Surface& surface() const { return *surface_; }

  // From model coordinates (mm) to the posed-object frame.
  const Eigen::Matrix4d& matrix() const { return matrix_; }
  // Lengths in the posed-object frame over those in the model's.
  double scale() const { return matrix_.col(0).head<3>().norm(); }
  // Largest extent of the object's own box, before it is turned: what PoseOptions calls its size.
  double size_mm() const;
  // Of directions, from the model's frame to the posed-object frame.
  Mat3 turn() const { return matrix_.topLeftCorner<3, 3>() / scale(); }

 private:
  std::shared_ptr<const Object> object_;
  Eigen::Matrix4d matrix_;
  std::shared_ptr<const TriangleMesh> mesh_;
  std::shared_ptr<const Surface> surface_;
};

}  // namespace hydrodip
