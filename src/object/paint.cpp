#include "object/paint.h"

#include <utility>

namespace hydrodip {
namespace {

class ModelPaint : public Paint {
 public:
  ModelPaint(std::shared_ptr<const Object> object, const LinearColor& base)
      : Paint(base), object_(std::move(object)), says_anything_(object_->has_appearance()) {}

  LinearColor color_at(const SurfacePoint& point) const override {
    return hydrodip::color_at(*object_, point, base());
  }
  bool says_anything() const override { return says_anything_; }
  const Object* as_object() const override { return object_.get(); }

 private:
  std::shared_ptr<const Object> object_;
  bool says_anything_;
};

}  // namespace

std::shared_ptr<const Paint> model_paint(std::shared_ptr<const Object> object,
                                         const LinearColor& base) {
  return std::make_shared<ModelPaint>(std::move(object), base);
}

}  // namespace hydrodip
