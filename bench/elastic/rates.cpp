// No header with inline functions may be used here: the linker could keep a copy of theirs that
// other files' code would then run.
#include "elastic/rates.h"

namespace hydrodip::rates {
namespace {

#if defined(__AVX512F__)
constexpr int kBytes = 64;
#elif defined(__AVX__)
constexpr int kBytes = 32;
#else
constexpr int kBytes = 16;
#endif
// As many as registers take with two constants; more than any unit's delay in turns.
constexpr int kChains = 12;

typedef float Floats __attribute__((vector_size(kBytes)));
typedef double Doubles __attribute__((vector_size(kBytes)));

// step(chain, x) on every chain in every turn.
template <typename Vector, typename Step>
inline double run(std::size_t turns, double& sink, const Step& step) {
  constexpr int kNumbers = kBytes / int(sizeof(Vector{}[0]));
  Vector chain[kChains];
  for (int c = 0; c < kChains; ++c)
    for (int n = 0; n < kNumbers; ++n) chain[c][n] = 1 + c / 16.0F + n / 256.0F;
  for (std::size_t turn = 0; turn < turns; ++turn)
#pragma GCC unroll 12
    for (int c = 0; c < kChains; ++c) chain[c] = step(c, chain[c]);
  for (const Vector& x : chain)
    for (int n = 0; n < kNumbers; ++n) sink += double(x[n]);
  return double(turns) * kChains * kNumbers;
}

template <typename Vector, typename Number>
double apart(std::size_t turns, double& sink) {
  const Number scale = Number(1 - 1e-6), shift = Number(1e-6);
  return run<Vector>(turns, sink,
                     [=](int c, Vector x) { return c % 2 == 0 ? x * scale : x + shift; });
}

template <typename Vector, typename Number>
double fused(std::size_t turns, double& sink) {
  const Number scale = Number(1 - 1e-6), shift = Number(1e-6);
  return 2 * run<Vector>(turns, sink, [=](int, Vector x) { return x * scale + shift; });
}

}  // namespace

double floats(std::size_t turns, double& sink) { return apart<Floats, float>(turns, sink); }
double doubles(std::size_t turns, double& sink) { return apart<Doubles, double>(turns, sink); }
double fused_floats(std::size_t turns, double& sink) { return fused<Floats, float>(turns, sink); }
double fused_doubles(std::size_t turns, double& sink) {
  return fused<Doubles, double>(turns, sink);
}

double roots(std::size_t turns, double& sink) {
  constexpr int kNumbers = 16 * kBytes;  // in the innermost cache
  float x[kNumbers];
  for (int n = 0; n < kNumbers; ++n) x[n] = 1 + float(n) / kNumbers;
  for (std::size_t turn = 0; turn < turns; ++turn)
    for (int n = 0; n < kNumbers; ++n) x[n] = 1 / __builtin_sqrtf(x[n]);
  for (const float value : x) sink += double(value);
  return double(turns) * kNumbers;
}

}  // namespace hydrodip::rates
