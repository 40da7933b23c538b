// Vertical projection, a baseline of the paper's figure 9: the film does not resist at all, and
// every point of it goes straight up to the object.

#include "dip/draped_film.h"

namespace hydrodip {

namespace {

class Projection : public Scheme {
 public:
  Projection(const DipSetting& setting, DipState& state) : set_(setting), state_(state) {}

  void advance(const Moment& to) override {
    const std::vector<std::uint8_t> meets = rise_to(to.level_mm, set_, state_);
    for (std::size_t v = 0; v < meets.size(); ++v)
      if (meets[v]) state_.state[v] = VertexState::kAttached;
    state_.moment = to;
  }

 private:
  const DipSetting set_;
  DipState& state_;
};

}  // namespace

std::unique_ptr<Scheme> make_projection(const DipSetting& setting, DipState& state) {
  return std::make_unique<Projection>(setting, state);
}

}  // namespace hydrodip
