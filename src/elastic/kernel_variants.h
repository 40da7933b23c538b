// Which instruction sets the kernels exist for, and which of them this processor runs.
#pragma once

#include <string_view>
#include <vector>

#include "elastic/kernels.h"

namespace hydrodip::kernels {

struct Variant {
  std::string_view name;  // "baseline", "avx2", "avx512"
  const Table* table;
};

// What this processor can run, best last. The first always exists.
const std::vector<Variant>& variants();

// The best of variants(), or the one that the environment variable HYDRODIP_SIMD names. Throws
// InputError if there is none of that name here.
const Table& best();

}  // namespace hydrodip::kernels
