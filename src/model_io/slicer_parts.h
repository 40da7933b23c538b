// What slicers keep beside a 3MF's shapes: which of them are no shape to dip.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "model_io/package.h"

namespace hydrodip {

struct SlicerParts {
  // Numbers of an object's triangles, both ends included.
  using Range = std::pair<std::int64_t, std::int64_t>;

  // Bambu Studio and OrcaSlicer: an object and one of its components, by their ids.
  std::set<std::pair<std::int64_t, std::int64_t>> components;
  // PrusaSlicer: an object, by its id, and triangles of its mesh; ascending, apart.
  std::map<std::int64_t, std::vector<Range>> triangles;
  // What they are, for people: "modifiers".
  std::set<std::string> kinds;
};

// Modifiers, negative parts and support volumes of the whole package. Settings that cannot be read
// say nothing.
SlicerParts read_slicer_parts(const std::string& path, Package& package, const RunContext& context);

}  // namespace hydrodip
