#include "air/flood.h"

#include <algorithm>

#include "base/run_scope.h"

namespace hydrodip {

// From the border inwards, cells that stay open longest first: a cell's way is the best one when
// its turn comes.
Flood flood(const AirCells& cells, const std::vector<std::uint16_t>& wet) {
  Flood result;
  result.closed.assign(wet.size(), Flood::kInside);
  result.from.assign(wet.size(), 0);
  const std::uint16_t last = *std::max_element(wet.begin(), wet.end());
  std::vector<std::vector<std::uint32_t>> waiting(std::size_t(last) + 1);
  for (std::size_t cell = 0; cell < wet.size(); ++cell) {
    if (!cells.on_border(cell)) continue;
    result.closed[cell] = wet[cell];
    result.from[cell] = std::uint32_t(cell);
    waiting[wet[cell]].push_back(std::uint32_t(cell));
  }
  CheckEvery check(1 << 14);
  for (std::size_t moment = waiting.size(); moment-- > 0;) {
    while (!waiting[moment].empty()) {
      check();
      const std::uint32_t cell = waiting[moment].back();
      waiting[moment].pop_back();
      cells.for_linked(cell, [&](std::size_t next) {
        if (result.closed[next] != Flood::kInside) return;
        result.closed[next] = std::min(result.closed[cell], wet[next]);
        result.from[next] = cell;
        waiting[result.closed[next]].push_back(std::uint32_t(next));
      });
    }
  }
  return result;
}

}  // namespace hydrodip
