#include "base/blank_pages.h"

#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace hydrodip {

namespace {

// Of the whole pages in a part of memory.
enum class Advice { kGiveBack, kLargePages, kOrdinaryPages };

void advise([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes,
            [[maybe_unused]] Advice advice) {
#if defined(__linux__)
  const auto page = std::uintptr_t(sysconf(_SC_PAGESIZE));
  const auto first = (std::uintptr_t(begin) + page - 1) / page * page;
  const auto end = (std::uintptr_t(begin) + bytes) / page * page;
  if (first >= end) return;
  const int how = advice == Advice::kGiveBack     ? MADV_DONTNEED
                  : advice == Advice::kLargePages ? MADV_HUGEPAGE
                                                  : MADV_NOHUGEPAGE;
  madvise(static_cast<char*>(begin) + (first - std::uintptr_t(begin)), end - first, how);
#endif
}

}  // namespace

// Elsewhere than on Linux, what becomes of pages that are given back is not as sure; then they
// stay.
void give_back(void* begin, std::size_t bytes) { advise(begin, bytes, Advice::kGiveBack); }

LargePages::LargePages(void* begin, std::size_t bytes) : begin_(begin), bytes_(bytes) {
  advise(begin_, bytes_, Advice::kLargePages);
}
// What is written later is rows here and there: whole large pages for them would be a waste.
LargePages::~LargePages() { advise(begin_, bytes_, Advice::kOrdinaryPages); }

}  // namespace hydrodip
