#include "elastic/kernel_variants.h"

#include <cstdlib>

namespace hydrodip::kernels {

extern const Table kBaseline;
#ifdef HYDRODIP_X86
extern const Table kAvx2, kAvx512;
#endif

namespace {

std::vector<Variant> find_variants() {
  std::vector<Variant> found = {{"baseline", &kBaseline}};
#ifdef HYDRODIP_X86
  if (__builtin_cpu_supports("avx2")) found.push_back({"avx2", &kAvx2});
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
    found.push_back({"avx512", &kAvx512});
#endif
  return found;
}

const Table& choose() {
  const char* wanted = std::getenv("HYDRODIP_SIMD");
  for (const Variant& v : variants())
    if (wanted && v.name == wanted) return *v.table;
  return *variants().back().table;
}

}  // namespace

const std::vector<Variant>& variants() {
  static const std::vector<Variant> found = find_variants();
  return found;
}

const Table& best() {
  static const Table& chosen = choose();
  return chosen;
}

}  // namespace hydrodip::kernels
