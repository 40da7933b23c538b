#include "elastic/machine.h"

#include <algorithm>
#include <chrono>
#include <cstddef>

#include "base/parallel.h"
#include "elastic/film_grid.h"
#include "elastic/kernel_variants.h"
#include "elastic/rates.h"

namespace hydrodip {
namespace {

double rate_of(double (*work)(std::size_t, double&)) {
  constexpr std::size_t kTurns = 2000;
  double operations = 0, sink = 0;
  const double seconds = fastest_seconds([&] { operations = work(kTurns, sink); });
  return sink != 0 ? operations / seconds : 0;
}

}  // namespace

double fastest_seconds(const std::function<void()>& body) {
  using Clock = std::chrono::steady_clock;
  double best = 1e300;
  for (int n = 0; n < 20; ++n) {
    const auto start = Clock::now();
    for (int repeat = 0; repeat < 10; ++repeat) body();
    best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count() / 10);
  }
  return best;
}

double bytes_per_second(double bytes) {
  // Two vectors of two components.
  const auto entries = std::size_t(bytes / 16) / kernels::kLanes * kernels::kLanes;
  GridArray<float> ax(entries), ay(entries), bx(entries), by(entries);
  const std::size_t share = entries / kernels::kLanes / std::size_t(available_threads());
  const auto pass = [&](std::size_t begin, std::size_t end) {
    kernels::best().scale_and_add(begin, end, {ax.data(), ay.data()}, 0.5F, {bx.data(), by.data()});
  };
  // Small arrays are not worth two threads, for the solver neither.
  constexpr std::size_t kWorthSharing = 6000;
  const std::size_t grain = entries < kWorthSharing ? entries : (share + 1) * kernels::kLanes;
  const double seconds = fastest_seconds([&] { parallel_for(entries, grain, pass); });
  return 24 * double(entries) / seconds;  // a is read and written, b is read
}

Rates operations_per_second() {
  return {rate_of(rates::floats), rate_of(rates::fused_floats), rate_of(rates::doubles),
          rate_of(rates::fused_doubles), rate_of(rates::roots)};
}

}  // namespace hydrodip
