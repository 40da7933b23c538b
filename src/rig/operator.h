// The person at the bath.
#pragma once

#include <string>

namespace hydrodip {

class Operator {
 public:
  virtual ~Operator() = default;
  virtual void say(const std::string& text) = 0;  // whole lines
  // The answer, without spaces around it. Throws Cancelled on Ctrl-C and when input has ended.
  virtual std::string ask(const std::string& question) = 0;
  // A line that replaces itself: what is going on.
  virtual void show(const std::string& line) = 0;
  // Whether Enter was pressed since the last call, or since the last question.
  virtual bool pressed_enter() = 0;
};

}  // namespace hydrodip
