#include "base/blank_array.h"

#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace hydrodip {

// Elsewhere, what becomes of pages that are given back is not as sure; then they stay.
void give_back(void* begin, std::size_t bytes) {
#if defined(__linux__)
  const auto page = std::uintptr_t(sysconf(_SC_PAGESIZE));
  const auto first = (std::uintptr_t(begin) + page - 1) / page * page;
  const auto end = (std::uintptr_t(begin) + bytes) / page * page;
  if (first < end)
    madvise(static_cast<char*>(begin) + (first - std::uintptr_t(begin)), end - first,
            MADV_DONTNEED);
#else
  static_cast<void>(begin);
  static_cast<void>(bytes);
#endif
}

}  // namespace hydrodip
