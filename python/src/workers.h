// Threads for work, kept for the next piece: every thread that ever takes part in a loop of TBB
// leaves some 8 kB behind when it ends, and a thousand dips would be a thousand threads.
#pragma once

#include <functional>

namespace hydrodip::python {

// Begins the work, which throws nothing, on a thread that has none, or on a new one. In a forked
// child the parent's threads are gone, and forgotten.
void start_on_worker(std::function<void()> work);

}  // namespace hydrodip::python
