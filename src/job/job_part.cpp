#include "job/job_part.h"

#include <fmt/format.h>

namespace hydrodip {

void do_part(const std::string& name, const RunContext& context,
             const std::function<void(const RunContext&)>& work) {
  const RunContext own = context.quiet();
  own.on_progress(
      [&](const std::string& activity, double fraction) { context.progress(activity, fraction); });
  own.on_log([&](const std::string& line) { context.log(line); });
  work(own);
  for (const std::string& warning : own.warnings())
    context.warn(fmt::format("{}: {}", name, warning));
}

}  // namespace hydrodip
