// Large arrays of zeros that take memory only where something is written: most of a sheet stays
// blank.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/run_scope.h"

namespace hydrodip {

// Gives whole pages back to the system, which makes new ones of zeros once they are looked at. What
// was there is lost: some of it stays and the rest is zero.
void give_back(void* begin, std::size_t bytes);

// std::vector<T>(count), made in pieces. Throws Cancelled, as check_cancelled() does.
template <typename T>
std::vector<T> blank(std::size_t count) {
  constexpr std::size_t kPiece = (std::size_t(1) << 22U) / sizeof(T);
  std::vector<T> values;
  values.reserve(count);
  while (values.size() < count) {
    check_cancelled();
    const std::size_t begin = values.size();
    values.resize(std::min(count, begin + kPiece));
    give_back(values.data() + begin, (values.size() - begin) * sizeof(T));
  }
  return values;
}

}  // namespace hydrodip
