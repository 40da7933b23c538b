#include "object/simplify.h"

#include "plan/trial.h"

namespace hydrodip {

std::shared_ptr<const Object> simplified_for_trials(std::shared_ptr<const Object> object) {
  constexpr std::size_t kMany = 60000;
  if (object->triangles.size() <= kMany) return object;
  Object shape;  // trials look at nothing else
  shape.positions = object->positions;
  shape.triangles = object->triangles;
  shape.material_of.assign(shape.triangles.size(), 0);
  shape.materials.emplace_back();
  Object simple;
  double cells = 200;
  do {
    simple = drawn_together(shape, cells);
    cells /= 1.4;
  } while (simple.triangles.size() > kMany && cells > 20);
  return std::make_shared<const Object>(std::move(simple));
}

}  // namespace hydrodip
