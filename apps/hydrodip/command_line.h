// From argv to a command and its request.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "commands.h"

namespace hydrodip {

// A command's arguments and options, which parsing writes into `request`.
std::unique_ptr<CLI::App> command_options(const Command& command, Request& request);

// What stands between its name and the options: "MODEL", "[MODEL]", "JOB_DIR SCAN..."; or "".
std::string operands_of(const Command& command, const CLI::App& app);

// Two columns of the general help.
struct Remark {
  std::string what;
  std::string means;
};
const std::vector<Remark>& exit_codes();             // "2", "bad input or usage"
const std::vector<Remark>& environment_variables();  // "HYDRODIP_SIMD", ...
const std::vector<std::string>& first_commands();    // to try, in order

struct CommandLine {
  const Command* command = nullptr;  // null: only text is to be shown
  Request request;
  std::string text;  // help or version
};

// `arguments` without the program's name. Throws InputError for anything that is not understood,
// with the nearest known name.
CommandLine parse_command_line(const std::vector<std::string>& arguments);

}  // namespace hydrodip
