// Which part of a point's ink a coat lays down, where several dips share an object.
#pragma once

#include <functional>
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
  // Values in [0, 1].
  explicit Allotment(std::function<float(const SurfacePoint&)> share) : share_(std::move(share)) {}

  bool is_full() const { return !share_; }
  float at(const SurfacePoint& point) const { return share_ ? share_(point) : 1.0F; }

 private:
  std::function<float(const SurfacePoint&)> share_;
};

}  // namespace hydrodip
