// The dip as it went: where the film was at a bounded number of depths, for the animation.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "dip/travel.h"
#include "film/film.h"

namespace hydrodip {

struct DipFrame {
  Moment moment;
  std::vector<std::array<float, 3>> position;  // per film vertex, posed-object frame, mm
};

// Watches a dip. A second dip that starts over (step 0) replaces the first.
class DipHistory {
 public:
  // Keeps at most `frames` states, the first and the last included; fewer of a film so large that
  // they would take more than a report can hold.
  explicit DipHistory(int frames = 32) : frames_(frames) {}

  // The film after `step` of `steps`; step 0 is the flat film. Steps must ascend. The clamped rim
  // is kept at the water's level, where the bath holds it.
  void record(int step, int steps, const Moment& moment, const std::vector<Vec3>& position,
              const std::vector<VertexState>& state);

  const std::vector<DipFrame>& frames() const { return kept_; }
  // Per film vertex: the first frame from which on it is attached; frames().size() if none.
  const std::vector<std::uint8_t>& attached_from() const { return attached_from_; }

 private:
  bool is_kept(int step, int steps) const;

  int frames_;
  int limit_ = 2;
  std::vector<DipFrame> kept_;
  std::vector<std::uint8_t> attached_from_;
};

}  // namespace hydrodip
