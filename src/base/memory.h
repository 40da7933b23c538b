// How much memory this process may have, and what it gives back.
#pragma once

namespace hydrodip {

// The least of the machine's memory, the process's limits and its container's, in bytes.
double memory_limit_bytes();

// Gives what was freed back to the system: the C library keeps small blocks for later, and a job's
// later stages need large ones.
void give_back_freed_memory();

}  // namespace hydrodip
