#include "command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/error.h"
#include "job/nearest_name.h"

namespace hydrodip {
namespace {

constexpr std::size_t kHelpColumn = 36;

std::string general_help() {
  std::string help =
      "hydrodip: from a textured model to a film image to print on PVA film and dip.\n\n"
      "Usage: hydrodip COMMAND [OPTIONS]\n\nCommands:\n";
  for (const Command& command : commands())
    help += fmt::format("  {:<10} {}\n", command.name, command.summary);
  help +=
      "\nTry it:\n"
      "  hydrodip sample mask -o models\n"
      "  hydrodip print models/mask.obj --film a4 -o mask-print\n\n"
      "'hydrodip COMMAND --help' shows a command's options. Lengths are in mm, angles in degrees.\n"
      "Exit codes: 0 done, 2 bad input or usage, 3 the dip could not be computed, 130 cancelled.\n";
  return help;
}

const Command& find_command(const std::string& name) {
  std::vector<std::string> names;
  for (const Command& command : commands()) {
    if (command.name == name) return command;
    names.push_back(command.name);
  }
  const std::string hint = did_you_mean(name, names);
  throw InputError(fmt::format("unknown {} '{}'{}", name.starts_with("-") ? "option" : "command",
                               name,
                               hint.empty() ? "; 'hydrodip --help' lists the commands" : hint));
}

std::string usage(const Command& command) { return "'hydrodip " + command.name + " --help'"; }

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// CLI11 leaves in `rest` what it could not place.
void refuse_rest(const CLI::App& app, const Command& command,
                 const std::vector<std::string>& rest) {
  for (const std::string& argument : rest) {
    if (!argument.starts_with("-")) continue;
    const std::string name = argument.substr(0, argument.find('='));
    const std::string hint = did_you_mean(name, option_names(app));
    throw InputError(fmt::format("unknown option '{}'{}", name,
                                 hint.empty() ? "; " + usage(command) + " lists them" : hint));
  }
  if (!rest.empty())
    throw InputError(fmt::format("unexpected argument '{}'; see {}", rest.front(), usage(command)));
}

CommandLine parse_command(const Command& command, std::vector<std::string> arguments) {
  CommandLine line;
  CLI::App app(command.summary, "hydrodip " + command.name);
  app.allow_extras();
  app.get_formatter()->column_width(kHelpColumn);
  app.footer(command.details);
  command.declare(app, line.request);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  try {
    app.parse(arguments);
  } catch (const CLI::CallForHelp&) {
    line.text = app.help();
    return line;
  } catch (const CLI::ParseError& error) {
    throw InputError(fmt::format("{}; see {}", error.what(), usage(command)));
  }
  refuse_rest(app, command, app.remaining());
  line.command = &command;
  return line;
}

}  // namespace

CommandLine parse_command_line(const std::vector<std::string>& arguments) {
  const std::string first = arguments.empty() ? "" : arguments.front();
  if (first.empty())
    throw InputError("name a command, as in 'hydrodip print MODEL'; see 'hydrodip --help'");
  if (first == "--help" || first == "-h" || first == "help") return {nullptr, {}, general_help()};
  if (first == "--version") return {nullptr, {}, "hydrodip " HYDRODIP_VERSION "\n"};
  return parse_command(find_command(first), {arguments.begin() + 1, arguments.end()});
}

}  // namespace hydrodip
