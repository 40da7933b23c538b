// One of several labels for each node of a graph, so that the labels fit their nodes and change
// where that costs least.
#pragma once

#include <cstdint>
#include <vector>

namespace hydrodip {

struct LabelEdge {
  std::int32_t a = 0, b = 0;
  std::int32_t cost = 0;  // not negative; of different labels at its ends
};

// The labels whose costs have the least sum that alpha expansion finds: every expansion is an exact
// minimum cut (Boykov, Veksler, Zabih, "Fast approximate energy minimization via graph cuts",
// 2001). costs[node * labels + label] is not negative; `start` holds a label per node. The sum of
// all costs must stay below 2^62. Deterministic. Throws Cancelled.
std::vector<std::uint8_t> best_labels(int labels, const std::vector<std::int32_t>& costs,
                                      const std::vector<LabelEdge>& edges,
                                      std::vector<std::uint8_t> start);

// What labels cost in all.
std::int64_t cost_of_labels(int labels, const std::vector<std::int32_t>& costs,
                            const std::vector<LabelEdge>& edges,
                            const std::vector<std::uint8_t>& label);

}  // namespace hydrodip
