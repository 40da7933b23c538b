// From argv to a command and its request.
#pragma once

#include <string>
#include <vector>

#include "commands.h"

namespace hydrodip {

struct CommandLine {
  const Command* command = nullptr;  // null: only text is to be shown
  Request request;
  std::string text;  // help or version
};

// `arguments` without the program's name. Throws InputError for anything that is not understood,
// with the nearest known name.
CommandLine parse_command_line(const std::vector<std::string>& arguments);

}  // namespace hydrodip
