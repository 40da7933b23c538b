#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"
#include "base/obstacle.h"
#include "job/browser.h"
#include "job/jobs.h"

namespace hydrodip {
namespace {

// The report itself, or the folder that holds it.
std::filesystem::path find_report(const std::filesystem::path& where) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(where, ignored) && where.extension() == ".html")
    return std::filesystem::absolute(where);
  const std::filesystem::path report = where / "report.html";
  if (std::filesystem::is_regular_file(report, ignored))
    return std::filesystem::weakly_canonical(report);
  throw InputError(
      fmt::format("{}: {}; name the output folder of a job, as in 'hydrodip view mask-print'",
                  where.string(), why_absent(where, "report.html")));
}

}  // namespace

JobResult view_job(const std::filesystem::path& where) {
  const std::filesystem::path report = find_report(where);
  const bool opened = has_screen() && open_in_browser(report.string());
  JobResult result;
  result.text = opened ? fmt::format("opened {}\n", report.string())
                       : fmt::format("there is no browser here; open this file in one:\n{}\n",
                                     report.string());
  result.json = json_answer("view", {{"report", report.string()}, {"opened", opened}});
  return result;
}

}  // namespace hydrodip
