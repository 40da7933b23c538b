// What this machine can do at best, measured: the yardstick for the inner loops.
#pragma once

#include <functional>

namespace hydrodip {

// The shortest time of one call, of many: one in which nobody else had the cores.
double fastest_seconds(const std::function<void()>& body);

// Bytes read and written a second by the simplest of loops over arrays (a = s a + b), with as many
// threads as parallel_for uses. `bytes`: of all arrays together; what fits comes from a cache.
double bytes_per_second(double bytes);

// A second and thread, in registers alone.
struct Rates {
  double floats = 0, fused_floats = 0;    // additions and multiplications; fused: two in one
  double doubles = 0, fused_doubles = 0;  // the same in double precision
  double roots = 0;                       // 1 / sqrt(x) in single precision
};
Rates operations_per_second();

}  // namespace hydrodip
