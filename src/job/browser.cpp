#include "job/browser.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <vector>

extern char** environ;

namespace hydrodip {
namespace {

constexpr const char* kOpener = "xdg-open";

// Whether it was found and ended well.
bool run_quietly(std::vector<std::string> words) {
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int descriptor : {0, 1, 2}) {
    posix_spawn_file_actions_addopen(&quiet, descriptor, "/dev/null", O_RDWR, 0);
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = -1;
  const int refused =
      posix_spawnp(&child, arguments[0], &quiet, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&quiet);
  int status = 0;
  return refused == 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

}  // namespace

bool has_screen() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* value = std::getenv(name);
    if (value && *value) return true;
  }
  return false;
}

bool open_in_browser(const std::string& what) { return run_quietly({kOpener, what}); }

// The shell ends at once; what it began is nobody's child here, and ignores Ctrl-C.
void begin_in_browser(const std::string& what) {
  run_quietly({"sh", "-c", R"("$0" "$1" &)", kOpener, what});
}

}  // namespace hydrodip
