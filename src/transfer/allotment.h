// Which part of a point's ink a coat lays down, where several dips share an object.
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "object/object.h"

namespace hydrodip {

// So many dips may share an object.
inline constexpr int kMostDips = 24;

// A function on the object's surface, the same in every pose. Immutable, safe to ask from many
// threads.
class Allotment {
 public:
  Allotment() = default;  // all of it everywhere
  // Values in [0, 1]. `over`: that of all points of a triangle, where they are known to have one.
  explicit Allotment(std::function<float(const SurfacePoint&)> share,
                     std::function<std::optional<float>(int triangle)> over = {})
      : share_(std::move(share)), over_(std::move(over)) {}

  float at(const SurfacePoint& point) const { return share_ ? share_(point) : 1.0F; }
  std::optional<float> over(int triangle) const {
    if (over_) return over_(triangle);
    return share_ ? std::nullopt : std::optional(1.0F);
  }

 private:
  std::function<float(const SurfacePoint&)> share_;
  std::function<std::optional<float>(int triangle)> over_;
};

}  // namespace hydrodip
