// How near the solver's inner loops come to what this machine can do.
#pragma once

namespace hydrodip {

// Prints, for grids in the innermost cache, in the second and beyond: bytes and operations a
// second, what the machine can do of either, and the time that the slower of them would need at
// least.
void measure_inner_loops();

}  // namespace hydrodip
