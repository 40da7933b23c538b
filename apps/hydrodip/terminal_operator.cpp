#include "terminal_operator.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>

#include "base/error.h"
#include "base/text.h"
#include "harmless.h"

namespace hydrodip {
namespace {

constexpr double kPoll_s = 0.1;

}  // namespace

void TerminalOperator::say(const std::string& text) {
  clear_line();
  std::fputs((harmless(text) + "\n").c_str(), stderr);
}

std::string TerminalOperator::ask(const std::string& question) {
  clear_line();
  std::fputs(harmless(question).c_str(), stderr);
  std::fflush(stderr);
  std::string line;
  while (!take_line(line)) {
    if (ended_) throw Cancelled("nobody answers: the input has ended");
    read_some(kPoll_s);
    if (context_.cancelled()) {
      std::fputc('\n', stderr);
      throw Cancelled();
    }
  }
  if (::isatty(STDIN_FILENO) == 0) std::fputs((line + "\n").c_str(), stderr);
  return line;
}

// Where nobody looks on, lines would only pile up.
void TerminalOperator::show(const std::string& line) {
  if (::isatty(STDERR_FILENO) == 0) return;
  std::fputs(("\r\033[K" + harmless(line)).c_str(), stderr);
  std::fflush(stderr);
  shown_ = true;
}

bool TerminalOperator::pressed_enter() {
  read_some(0);
  std::string line;
  if (take_line(line)) return true;
  if (ended_) throw Cancelled("nobody answers: the input has ended");
  return false;
}

bool TerminalOperator::read_some(double seconds) {
  if (ended_ || !clock_.wait_readable(STDIN_FILENO, seconds)) return !ended_;
  std::array<char, 256> buffer;
  const ssize_t got = ::read(STDIN_FILENO, buffer.data(), buffer.size());
  if (got > 0) typed_.append(buffer.data(), static_cast<std::size_t>(got));
  if (got == 0 || (got < 0 && errno != EINTR && errno != EAGAIN)) ended_ = true;
  return !ended_;
}

bool TerminalOperator::take_line(std::string& line) {
  const std::size_t end = typed_.find('\n');
  if (end == std::string::npos) return false;
  line = trimmed(std::string_view(typed_).substr(0, end));
  typed_.erase(0, end + 1);
  return true;
}

void TerminalOperator::clear_line() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

}  // namespace hydrodip
