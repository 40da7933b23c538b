// Loops that do nothing but compute, compiled for the machine that builds them.
#pragma once

#include <cstddef>

namespace hydrodip::rates {

// Each runs `turns` turns of chains that do not wait for each other, and adds what comes out to
// `sink`, so that it cannot be left out. Returns how many operations that is.
double floats(std::size_t turns, double& sink);  // multiplications and additions, equally many
double doubles(std::size_t turns, double& sink);
double fused_floats(std::size_t turns, double& sink);  // multiply-adds, which count twice
double fused_doubles(std::size_t turns, double& sink);
double roots(std::size_t turns, double& sink);  // 1 / sqrt(x), single precision

}  // namespace hydrodip::rates
