// Large arrays, which the system clears page by page: a tenth of a second for a sheet at 600 dpi.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/run_scope.h"

namespace hydrodip {

// std::vector(count, value), made in pieces. Throws Cancelled, as check_cancelled() does.
template <typename T>
std::vector<T> filled(std::size_t count, T value) {
  constexpr std::size_t kPiece = (std::size_t(1) << 22) / sizeof(T);
  std::vector<T> values;
  values.reserve(count);
  while (values.size() < count) {
    check_cancelled();
    values.resize(std::min(count, values.size() + kPiece), value);
  }
  return values;
}

}  // namespace hydrodip
