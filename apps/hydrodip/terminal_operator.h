// The operator at this terminal: questions and countdowns on stderr, answers from stdin.
#pragma once

#include "base/context.h"
#include "rig/link.h"
#include "rig/operator.h"

namespace hydrodip {

class TerminalOperator : public Operator {
 public:
  TerminalOperator(Clock& clock, const RunContext& context) : clock_(clock), context_(context) {}
  void say(const std::string& text) override;
  std::string ask(const std::string& question) override;
  void show(const std::string& line) override;
  bool pressed_enter() override;

 private:
  bool read_some(double seconds);  // false: input has ended
  bool take_line(std::string& line);
  void clear_line();

  Clock& clock_;
  const RunContext& context_;
  std::string typed_;
  bool ended_ = false;
  bool shown_ = false;
};

}  // namespace hydrodip
