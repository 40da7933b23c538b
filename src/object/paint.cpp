#include "object/paint.h"

#include <utility>

namespace hydrodip {
namespace {

class ModelPaint : public Paint {
 public:
  ModelPaint(std::shared_ptr<const Object> object, const LinearColor& base)
      : Paint(base), object_(std::move(object)), says_anything_(object_->has_appearance()) {
    // A model that says nothing may still carry its format's grey.
    const auto color = object_->one_color();
    is_as_object_ = says_anything_ || (is_white(base) && color && is_white(*color));
  }

  LinearColor color_at(const SurfacePoint& point) const override {
    return says_anything_ ? hydrodip::color_at(*object_, point, base()) : base();
  }
  bool says_anything() const override { return says_anything_; }
  const Object* as_object() const override { return is_as_object_ ? object_.get() : nullptr; }

 private:
  std::shared_ptr<const Object> object_;
  bool says_anything_, is_as_object_ = false;
};

}  // namespace

std::shared_ptr<const Paint> model_paint(std::shared_ptr<const Object> object,
                                         const LinearColor& base) {
  return std::make_shared<ModelPaint>(std::move(object), base);
}

}  // namespace hydrodip
