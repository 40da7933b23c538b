#include "sweep/sweep_command.h"

#include <utility>

#include "base/error.h"

namespace hydrodip {
namespace {

constexpr std::pair<const char*, SweepCommand> kCommands[] = {{"simulate", SweepCommand::kSimulate},
                                                              {"print", SweepCommand::kPrint},
                                                              {"orient", SweepCommand::kOrient}};

}  // namespace

std::vector<std::string> sweep_command_names() {
  std::vector<std::string> names;
  for (const auto& [name, command] : kCommands) names.emplace_back(name);
  return names;
}

std::string name_of(SweepCommand wanted) {
  for (const auto& [name, command] : kCommands)
    if (command == wanted) return name;
  return "";
}

SweepCommand sweep_command_of(const std::string& wanted) {
  for (const auto& [name, command] : kCommands)
    if (name == wanted) return command;
  throw InputError("a sweep knows no command '" + wanted + "'; plan it again");
}

}  // namespace hydrodip
