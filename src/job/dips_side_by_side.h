// Dips of one job at the same time, on a part of the threads each.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "base/context.h"

namespace hydrodip {

// Triangles: larger films are dipped one at a time, by all threads.
inline constexpr int kSmallFilm = 100000;

// What they warn of is told in their order, with their number. Throws what they throw.
void dip_side_by_side(std::size_t count, const std::string& activity, const RunContext& context,
                      const std::function<void(std::size_t, const RunContext&)>& dip);

}  // namespace hydrodip
