#include "elastic/kernel_variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "base/error.h"

namespace hydrodip::kernels {

extern const Table kBaseline;
#ifdef HYDRODIP_X86
extern const Table kAvx2, kAvx512;
#endif

namespace {

constexpr std::array<std::string_view, 3> kNames = {"baseline", "avx2", "avx512"};

std::vector<Variant> find_variants() {
  std::vector<Variant> found = {{kNames[0], &kBaseline}};
#ifdef HYDRODIP_X86
  if (__builtin_cpu_supports("avx2")) found.push_back({kNames[1], &kAvx2});
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
    found.push_back({kNames[2], &kAvx512});
#endif
  return found;
}

std::string names_here() {
  std::string names;
  for (const Variant& v : variants())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", v.name);
  return names;
}

const Table& choose() {
  const char* wanted = std::getenv("HYDRODIP_SIMD");
  if (wanted == nullptr || *wanted == '\0') return *variants().back().table;
  for (const Variant& v : variants())
    if (v.name == wanted) return *v.table;
  const bool known = std::find(kNames.begin(), kNames.end(), wanted) != kNames.end();
  throw InputError(
      fmt::format("HYDRODIP_SIMD={}: {}; unset it for the best, or choose from {}.", wanted,
                  known ? "this processor does not have it" : "no instruction set has that name",
                  names_here()));
}

}  // namespace

const std::vector<Variant>& variants() {
  static const std::vector<Variant> found = find_variants();
  return found;
}

// Read once, and constant from then on: it says what this process can run, not what a job wants,
// and tests and benchmarks compare processors with it. All variants give the same bytes.
const Table& best() {
  static const Table& chosen = choose();
  return chosen;
}

}  // namespace hydrodip::kernels
