// How much memory this process may have.
#pragma once

namespace hydrodip {

// The least of the machine's memory, the process's limits and its container's, in bytes.
double memory_limit_bytes();

}  // namespace hydrodip
