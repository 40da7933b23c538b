#include "console.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "base/error.h"
#include "harmless.h"

namespace hydrodip {
namespace {

std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  return harmless(text);
}

void write_error_line(const std::string& line) {
  std::fwrite(line.data(), 1, line.size(), stderr);
  std::fflush(stderr);
}

}  // namespace

void prepare_console() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor)
    if (::fcntl(descriptor, F_GETFD) == -1 && errno == EBADF) {
      if (::open("/dev/null", descriptor == 0 ? O_RDONLY : O_WRONLY) == -1) return;
    }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit then ends in a sentence, as a full disk does
}

void print_result(const std::string& text) {
  const std::string shown = harmless(text);
  std::fwrite(shown.data(), 1, shown.size(), stdout);
}

void print_error(const std::string& sentence) {
  write_error_line("error: " + one_line(sentence) + "\n");
}

void print_notice(const std::string& line) { write_error_line(one_line(line) + "\n"); }

void finish_results() {
  errno = 0;
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  if (failed && errno != EPIPE)
    throw InputError(std::string("could not write the result to standard output: ") +
                     std::strerror(errno ? errno : EIO));
}

}  // namespace hydrodip
