// A dip, watched step by step.
#include <hydrodip/hydrodip.h>

#include <algorithm>
#include <cstdio>
#include <vector>

int main() {
  const hydrodip::PosedObject posed = hydrodip::pose(hydrodip::sample("pyramid"), {.size_mm = 50});
  hydrodip::SimulationOptions options;
  options.film = {.width_mm = 110, .height_mm = 110, .elements = 6000};
  options.trajectory.depth_mm = 10;
  options.dip.step_mm = 0.5;

  const auto attached = [](const std::vector<hydrodip::VertexState>& state) {
    return std::count(state.begin(), state.end(), hydrodip::VertexState::kAttached);
  };
  // Called after every step, and for the flat film as step 0. What it is given lives until it
  // returns.
  const auto observe = [&attached](int step, int steps, const hydrodip::Moment& moment,
                                   const std::vector<hydrodip::Vec3>& position,
                                   const std::vector<hydrodip::VertexState>& state) {
    std::printf("step %2d of %d: %5.2f mm deep, %4td of %zu vertices attached\n", step, steps,
                moment.travelled_mm, attached(state), position.size());
  };
  const hydrodip::DippedObject dipped = hydrodip::simulate(posed, options, {}, observe);

  std::printf("in the end: %.2f mm deep, %td vertices attached\n", dipped.film->depth_mm,
              attached(dipped.film->state));
}
