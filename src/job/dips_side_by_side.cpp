#include "job/dips_side_by_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace hydrodip {

void dip_side_by_side(std::size_t count, const std::string& activity, const RunContext& context,
                      const std::function<void(std::size_t, const RunContext&)>& dip) {
  const int threads = std::max(1, context.threads() / std::max(1, int(count)));
  std::vector<std::vector<std::string>> warnings(count);
  std::vector<std::function<void()>> tasks;
  for (std::size_t i = 0; i < count; ++i)
    tasks.emplace_back([&, i] {
      const RunContext own = context.quiet().with_threads(threads);
      dip(i, own);
      warnings[i] = own.warnings();
    });
  context.side_by_side(activity, tasks);
  for (std::size_t i = 0; i < count; ++i)
    for (const std::string& warning : warnings[i])
      context.warn(fmt::format("dip {}: {}", i + 1, warning));
}

}  // namespace hydrodip
