// What it costs to give each part of the object's surface to each dip, and to lay a seam between
// two.
#pragma once

#include <cstdint>
#include <vector>

#include "plan/labelling.h"
#include "plan/seams.h"

namespace hydrodip {

// Of the task's nodes, for best_labels().
struct SeamCosts {
  std::vector<std::int32_t> of_dips;       // node by node, dip by dip
  std::vector<std::uint8_t> cheapest;      // per node: that dip
  std::vector<LabelEdge> edges;            // between neighbours
  std::vector<std::vector<float>> inside;  // per dip, per node: 0 at its film's border, 1 well in
};

// Throws Cancelled.
SeamCosts seam_costs(const SeamTask& task);

// About how long the seams of such a division are.
double seam_length_mm(const std::vector<LabelEdge>& edges, const std::vector<std::uint8_t>& dip_of,
                      double spacing_mm);

}  // namespace hydrodip
