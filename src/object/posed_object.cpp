#include "object/posed_object.h"

#include <utility>

namespace hydrodip {

PosedObject::PosedObject(std::shared_ptr<const Object> object, const PoseOptions& pose)
    : object_(std::move(object)), matrix_(pose_matrix(*object_, pose)) {
  auto mesh = std::make_shared<TriangleMesh>(*object_);
  apply_pose(*mesh, matrix_);
  mesh_ = std::move(mesh);
  surface_ = std::make_shared<Surface>(mesh_);
}

double PosedObject::size_mm() const { return scale() * object_->bounds().size().maxCoeff(); }

}  // namespace hydrodip
