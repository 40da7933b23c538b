// A motor on a screw: a place, a speed, and a bounded acceleration. Units as the owner likes.
#pragma once

#include <algorithm>
#include <cmath>

namespace hydrodip {

class Axis {
 public:
  double position = 0, velocity = 0, target = 0;
  double top_speed = 1, acceleration = 1;

  bool moving() const { return velocity != 0 || position != target; }

  void stop() {  // slowing down
    if (velocity == 0) return halt();
    const double sign = velocity < 0 ? -1 : 1;
    target = std::round(position + sign * velocity * velocity / (2 * acceleration));
  }
  void halt() {
    position = target = std::round(position);
    velocity = 0;
  }

  void step(double dt) {
    if (!moving()) return;
    const double way = target - position;
    const double wish =
        std::copysign(std::min(top_speed, std::sqrt(2 * acceleration * std::abs(way))), way);
    velocity = std::clamp(wish, velocity - acceleration * dt, velocity + acceleration * dt);
    const double next = position + velocity * dt;
    const bool arrives = (next - target) * way >= 0 && std::abs(velocity) <= 2 * std::abs(wish);
    if (arrives || std::abs(next - target) < 0.5) {
      position = target;
      velocity = 0;
    } else {
      position = next;
    }
  }
};

}  // namespace hydrodip
