#include "dip/dip_history.h"

#include <algorithm>

namespace hydrodip {
namespace {

// 40000 triangles in 32 frames, and no more in total.
constexpr std::size_t kMostPositions = 700000;
constexpr int kMostFrames = 200;  // attached_from is a byte

int frame_limit(int wanted, std::size_t vertices) {
  const std::size_t affordable = kMostPositions / std::max<std::size_t>(1, vertices);
  return std::clamp(int(std::min<std::size_t>(affordable, kMostFrames)), 2, std::max(2, wanted));
}

}  // namespace

// Evenly spread over the steps.
bool DipHistory::is_kept(int step, int steps) const {
  if (step == 0 || step == steps) return true;
  const auto frame = [&](int s) { return long(s) * (limit_ - 1) / steps; };
  return frame(step) != frame(step - 1);
}

void DipHistory::record(int step, int steps, const Moment& moment,
                        const std::vector<Vec3>& position, const std::vector<VertexState>& state) {
  if (step == 0) {
    kept_.clear();
    limit_ = frame_limit(frames_, position.size());
    attached_from_.assign(position.size(), 0);
  }
  if (!is_kept(step, steps)) return;
  DipFrame frame;
  frame.moment = moment;
  frame.position.reserve(position.size());
  for (std::size_t v = 0; v < position.size(); ++v) {
    Vec3 p = position[v];
    if (state[v] == VertexState::kClamped) p = moment.afloat(p.head<2>());
    frame.position.push_back({float(p.x()), float(p.y()), float(p.z())});
  }
  kept_.push_back(std::move(frame));
  for (std::size_t v = 0; v < state.size(); ++v) {
    if (state[v] != VertexState::kAttached) attached_from_[v] = std::uint8_t(kept_.size());
  }
}

}  // namespace hydrodip
