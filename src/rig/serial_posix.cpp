// The only place that knows POSIX terminals and clocks.
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>

#include "rig/link.h"

namespace hydrodip {
namespace {

// A port that takes no byte for this long is as good as gone.
constexpr double kSendTimeout_s = 0.2;

class SystemClock : public Clock {
 public:
  double now_s() override {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }

  bool wait_readable(int descriptor, double seconds) override {
    pollfd wanted = {descriptor, POLLIN, 0};
    const int ms = static_cast<int>(std::ceil(1000 * std::min(seconds, 3600.0)));
    return ::poll(&wanted, 1, std::max(0, ms)) > 0;
  }

  std::string utc() override {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", parts.tm_year + 1900,
                       parts.tm_mon + 1, parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec);
  }
};

struct Speed {
  int baud;
  speed_t code;
};
constexpr std::array<Speed, 11> kSpeeds = {{{1200, B1200},
                                            {2400, B2400},
                                            {4800, B4800},
                                            {9600, B9600},
                                            {19200, B19200},
                                            {38400, B38400},
                                            {57600, B57600},
                                            {115200, B115200},
                                            {230400, B230400},
                                            {500000, B500000},
                                            {1000000, B1000000}}};

speed_t speed_code(int baud) {
  for (const Speed& speed : kSpeeds)
    if (speed.baud == baud) return speed.code;
  throw InputError(fmt::format(
      "stage.baud: a serial port has no speed of {}; 115200 and 9600 are usual (250000 is not "
      "supported: set the printer to 115200)",
      baud));
}

class SerialLink : public Link {
 public:
  SerialLink(int descriptor, std::string port, Clock& clock)
      : descriptor_(descriptor), port_(std::move(port)), clock_(clock) {}
  ~SerialLink() override { ::close(descriptor_); }
  SerialLink(const SerialLink&) = delete;
  SerialLink& operator=(const SerialLink&) = delete;

  void send(const std::string& bytes) override {
    const char* at = bytes.data();
    std::size_t left = bytes.size();
    while (left > 0) {
      const ssize_t sent = ::write(descriptor_, at, left);
      if (sent > 0) {
        at += sent;
        left -= static_cast<std::size_t>(sent);
      } else if (sent < 0 && errno == EAGAIN) {
        wait_for_room();
      } else if (sent == 0 || errno != EINTR) {
        gone();
      }
    }
  }

  std::string receive(double seconds) override {
    if (!clock_.wait_readable(descriptor_, seconds)) return "";
    std::array<char, 256> buffer;
    const ssize_t got = ::read(descriptor_, buffer.data(), buffer.size());
    if (got > 0) return {buffer.data(), static_cast<std::size_t>(got)};
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return "";
    gone();
  }

 private:
  void wait_for_room() {
    pollfd wanted = {descriptor_, POLLOUT, 0};
    const int ready = ::poll(&wanted, 1, static_cast<int>(1000 * kSendTimeout_s));
    if (ready == 0 || (ready > 0 && (wanted.revents & (POLLERR | POLLHUP)) != 0)) gone();
  }

  [[noreturn]] void gone() const {
    throw LinkError(
        fmt::format("the link to the stage on {} is gone: is the cable still in?", port_));
  }

  int descriptor_;
  std::string port_;
  Clock& clock_;
};

[[noreturn]] void refuse(const std::string& port, const std::string& why) {
  throw InputError(fmt::format("{}: {}", port, why));
}

int open_port(const std::string& port) {
  const int descriptor = ::open(port.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor >= 0) return descriptor;
  if (errno == EACCES)
    refuse(port,
           "no permission; add yourself to the port's group (sudo usermod -aG dialout "
           "$USER) and log in again");
  if (errno == EBUSY) refuse(port, "another program is using this port; close it first");
  refuse(port, fmt::format("cannot be opened ({}); 'hydrodip rig stage find' lists the ports",
                           std::strerror(errno)));
}

// Raw bytes; a line that drops ends in an error rather than in a signal.
void set_up(int descriptor, const std::string& port, speed_t speed) {
  termios settings{};
  if (::tcgetattr(descriptor, &settings) != 0) refuse(port, "is not a serial port");
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS | HUPCL);
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  ::cfsetispeed(&settings, speed);
  ::cfsetospeed(&settings, speed);
  if (::tcsetattr(descriptor, TCSANOW, &settings) != 0)
    refuse(port, fmt::format("cannot be set up ({})", std::strerror(errno)));
  ::tcflush(descriptor, TCIOFLUSH);
}

}  // namespace

std::unique_ptr<Clock> system_clock() { return std::make_unique<SystemClock>(); }

std::unique_ptr<Link> open_serial(const std::string& port, int baud, Clock& clock) {
  const speed_t speed = speed_code(baud);
  const int descriptor = open_port(port);
  auto link = std::make_unique<SerialLink>(descriptor, port, clock);
  if (::ioctl(descriptor, TIOCEXCL) != 0) refuse(port, "is not a serial port");
  set_up(descriptor, port, speed);
  return link;
}

}  // namespace hydrodip
