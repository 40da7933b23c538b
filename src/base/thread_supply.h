// As many threads as the system lets this process have.
#pragma once

namespace hydrodip {

// How many threads parallel loops of this process may use: those that the processor runs at once,
// or one where limits on processes, threads or memory allow no more. TBB's threads are there when
// this has been called once; one that could not be started later would end the process, or leave
// Embree waiting for ever.
int threads_in_supply();

}  // namespace hydrodip
