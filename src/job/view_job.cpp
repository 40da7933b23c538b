#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "job/jobs.h"

extern char** environ;

namespace hydrodip {
namespace {

constexpr const char* kOpener = "xdg-open";

// The report itself, or the folder that holds it.
std::filesystem::path find_report(const std::filesystem::path& where) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(where, ignored) && where.extension() == ".html")
    return std::filesystem::absolute(where);
  const std::filesystem::path report = where / "report.html";
  if (std::filesystem::is_regular_file(report, ignored))
    return std::filesystem::weakly_canonical(report);
  if (!std::filesystem::exists(where, ignored))
    throw InputError(
        fmt::format("{}: there is no such folder; name the output folder of a job, as "
                    "in 'hydrodip view mask-print'",
                    where.string()));
  throw InputError(
      fmt::format("{}: there is no report.html here; name the output folder of a "
                  "'hydrodip print' or 'hydrodip simulate'",
                  where.string()));
}

bool has_screen() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* value = std::getenv(name);
    if (value && *value) return true;
  }
  return false;
}

// Whether the desktop's opener took the file. It returns at once, and says nothing.
bool open_in_browser(const std::string& path) {
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int descriptor : {0, 1, 2}) {
    posix_spawn_file_actions_addopen(&quiet, descriptor, "/dev/null", O_RDWR, 0);
  }
  std::string opener = kOpener, file = path;
  char* arguments[] = {opener.data(), file.data(), nullptr};
  pid_t child = -1;
  const int refused = posix_spawnp(&child, kOpener, &quiet, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&quiet);
  int status = 0;
  return refused == 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

}  // namespace

JobResult view_job(const std::filesystem::path& where) {
  const std::filesystem::path report = find_report(where);
  const bool opened = has_screen() && open_in_browser(report.string());
  JobResult result;
  result.text = opened ? fmt::format("opened {}\n", report.string())
                       : fmt::format("there is no browser here; open this file in one:\n{}\n",
                                     report.string());
  using json = nlohmann::ordered_json;
  result.json = json({{"report", report.string()}, {"opened", opened}})
                    .dump(2, ' ', false, json::error_handler_t::replace) +
                "\n";
  return result;
}

}  // namespace hydrodip
