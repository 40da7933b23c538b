// The wire to a stage, and the clock by which everything at the bath is timed. Both are interfaces,
// so that tests run a whole dip in their own time.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/error.h"

namespace hydrodip {

// The stage cannot go on: no answer, a warning, a refusal. One sentence, as every DipError.
class StageError : public DipError {
 public:
  using DipError::DipError;
};

// The wire is silent, garbled or gone: what the stage does now is not known.
class LinkError : public StageError {
 public:
  using StageError::StageError;
};

class Clock {
 public:
  virtual ~Clock() = default;
  virtual double now_s() = 0;  // monotonic
  // Until the descriptor can be read (true) or the time is over (false); a negative descriptor only
  // waits. May return early with false, as when a signal comes.
  virtual bool wait_readable(int descriptor, double seconds) = 0;
  // Date and time for people, ISO 8601 in UTC.
  virtual std::string utc() = 0;

  void sleep(double seconds);
};

std::unique_ptr<Clock> system_clock();

class Link {
 public:
  virtual ~Link() = default;
  // Throws LinkError if the port is gone.
  virtual void send(const std::string& bytes) = 0;
  // What has arrived, waiting for it at most that long; "" if nothing has. Throws LinkError if the
  // port is gone.
  virtual std::string receive(double seconds) = 0;
};

// A serial port (8 data bits, no parity, 1 stop bit, no flow control), taken for this program
// alone. Throws InputError if it cannot be opened or set up.
std::unique_ptr<Link> open_serial(const std::string& port, int baud, Clock& clock);

// Cuts what arrives into lines.
class LineReader {
 public:
  LineReader(Link& link, Clock& clock) : link_(link), clock_(clock) {}
  // The next line without its end; nothing if none is whole by then.
  std::optional<std::string> line(double deadline_s);
  // Forgets what has arrived so far.
  void clear();

 private:
  Link& link_;
  Clock& clock_;
  std::string pending_;
};

}  // namespace hydrodip
