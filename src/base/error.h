// What a stage throws. Each carries one clear sentence (what, where, how to mend) for the user;
// the app turns the type into the exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace hydrodip {

// Bad input or usage: exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The input is fine but the dip could not be computed: exit code 3.
class DipError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The user cancelled: exit code 130.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled; nothing was written") {}
  explicit Cancelled(const std::string& outcome) : std::runtime_error(outcome) {}
};

}  // namespace hydrodip
