// How much memory this process may have.
#pragma once

namespace hydrodip {

// The least of the machine's memory and its container's, in bytes: for what is used.
double memory_limit_bytes();

// The least of the process's own limits, in bytes, infinity without any: for what is asked for,
// used or not.
double address_limit_bytes();

}  // namespace hydrodip
