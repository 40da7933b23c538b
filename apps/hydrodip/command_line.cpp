#include "command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "base/error.h"
#include "base/nearest_name.h"
#include "base/shell_word.h"
#include "build_version.h"

namespace hydrodip {
namespace {

constexpr std::size_t kHelpColumn = 36;

std::string general_help() {
  std::string help =
      "hydrodip: from a textured model to a film image to print on PVA film and dip.\n\n"
      "Usage: hydrodip COMMAND [OPTIONS]\n\nCommands:\n";
  for (const Command& command : commands())
    help += fmt::format("  {:<17}  {}\n", command.name, command.summary);
  help += "\nTry it:\n";
  for (const std::string& command : first_commands()) help += "  " + command + "\n";
  help +=
      "\n'hydrodip COMMAND --help' shows a command's options, 'hydrodip --version' the version.\n"
      "Lengths are in mm, angles in degrees.\nExit codes:\n";
  for (const Remark& code : exit_codes())
    help += fmt::format("  {:<4} {}\n", code.what, code.means);
  for (const Remark& variable : environment_variables())
    help += variable.what + " " + variable.means + ".\n";
  return help;
}

std::vector<const CLI::Option*> positionals(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

// CLI11's layout, with the usage line and the values' names as this program's users read them.
class HelpFormatter : public CLI::Formatter {
 public:
  explicit HelpFormatter(const Command& command) : command_(command) { column_width(kHelpColumn); }

  std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override {
    const std::string operands = operands_of(command_, *app);
    std::string help = app->get_description() + "\n\nUsage: " + app->get_name() +
                       (operands.empty() ? "" : " " + operands) + " [OPTIONS]\n\n";
    for (const CLI::Option* option : positionals(*app)) help += make_option(option, true);
    for (const std::string& group : app->get_groups()) help += options_of(app, group);
    return help + (app->get_footer().empty() ? "" : "\n" + app->get_footer() + "\n");
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_name().empty() ? "" : " " + option->get_type_name();
  }

 private:
  std::string options_of(const CLI::App* app, const std::string& group) const {
    std::string text;
    for (const CLI::Option* option : app->get_options())
      if (option->nonpositional() && option->get_group() == group && option != app->get_help_ptr())
        text += make_option(option, false);
    return text.empty() ? "" : "\n" + group + ":\n" + text;
  }

  const Command& command_;
};

// Names such as "rig sheet" begin with the name of their group.
std::string group_help(const std::string& group) {
  std::string help;
  for (const Command& command : commands())
    if (command.name.starts_with(group + " "))
      help += fmt::format("  {:<17}  {}\n", command.name, command.summary);
  return help;
}

std::string first_of_group(const std::string& group) {
  const auto first = std::ranges::find_if(
      commands(), [&](const Command& command) { return command.name.starts_with(group + " "); });
  return first == commands().end() ? group : first->name;
}

bool is_command(const std::string& name) {
  return std::any_of(commands().begin(), commands().end(),
                     [&](const Command& command) { return command.name == name; });
}

// How many of the arguments name the command: 2 in a group, unless the group's name alone is a
// command as well.
std::size_t count_name_words(const std::vector<std::string>& arguments) {
  if (group_help(arguments[0]).empty()) return 1;
  if (is_command(arguments[0]))
    return arguments.size() > 1 && is_command(arguments[0] + " " + arguments[1]) ? 2 : 1;
  if (arguments.size() < 2)
    throw InputError(
        fmt::format("name what to do, as in 'hydrodip {}'; 'hydrodip {} --help' lists all",
                    first_of_group(arguments[0]), arguments[0]));
  return 2;
}

bool is_file(const std::string& name) {
  std::error_code ignored;
  return std::filesystem::exists(name, ignored);
}

const Command& find_command(const std::string& name) {
  std::vector<std::string> names;
  for (const Command& command : commands()) {
    if (command.name == name) return command;
    names.push_back(command.name);
  }
  const std::string hint =
      is_file(name)
          ? ": name what to do with that file, as in 'hydrodip print " + shell_word(name) + "'"
          : did_you_mean(name, names);
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

// CLI11 leaves in `rest` what it could not place, and the -- that ends the options.
void refuse_rest(const CLI::App& app, const Command& command, std::vector<std::string> rest) {
  const bool ended = std::erase(rest, "--") > 0;
  for (const std::string& argument : rest) {
    if (ended || !argument.starts_with("-")) continue;
    const std::string name = argument.substr(0, argument.find('='));
    const std::string hint = is_file(argument)
                                 ? fmt::format("; for the file of that name write ./{}", argument)
                                 : did_you_mean(name, option_names(app));
    throw InputError(fmt::format("unknown option '{}'{}", name,
                                 hint.empty() ? "; " + usage(command) + " lists them" : hint));
  }
  if (!rest.empty())
    throw InputError(fmt::format("unexpected argument '{}'; see {}", rest.front(), usage(command)));
}

// CLI11 takes whatever comes next for an option's value.
void refuse_options_as_values(const CLI::App& app, const std::vector<std::string>& arguments) {
  const auto option_of = [&](const std::string& argument) {
    return argument.starts_with("-") ? app.get_option_no_throw(argument) : nullptr;
  };
  for (std::size_t i = 0; i + 1 < arguments.size() && arguments[i] != "--"; ++i) {
    const CLI::Option* option = option_of(arguments[i]);
    if (!option || option->get_items_expected_min() == 0) continue;
    const std::string& value = arguments[++i];
    if (option_of(value))
      throw InputError(
          fmt::format("{0}: a value is missing, as {1} is an option; {2}={1} if that is the value",
                      arguments[i - 1], value, option->get_name()));
  }
}

CommandLine parse_command(const Command& command, std::vector<std::string> arguments) {
  CommandLine line;
  line.request.command_line = {"hydrodip", command.name};
  line.request.command_line.insert(line.request.command_line.end(), arguments.begin(),
                                   arguments.end());
  const std::unique_ptr<CLI::App> app = command_options(command, line.request);
  refuse_options_as_values(*app, arguments);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  try {
    app->parse(arguments);
  } catch (const CLI::CallForHelp&) {
    line.text = app->help();
    return line;
  } catch (const CLI::ParseError& error) {
    throw InputError(fmt::format("{}; see {}", error.what(), usage(command)));
  }
  refuse_rest(*app, command, app->remaining());
  refuse_two_values(*app);
  line.command = &command;
  return line;
}

}  // namespace

std::unique_ptr<CLI::App> command_options(const Command& command, Request& request) {
  auto app = std::make_unique<CLI::App>(command.summary, "hydrodip " + command.name);
  app->allow_extras();
  app->formatter(std::make_shared<HelpFormatter>(command));
  app->footer(command.details);
  command.declare(*app, request);
  allow_same_value_twice(*app);
  return app;
}

std::string operands_of(const Command& command, const CLI::App& app) {
  if (!command.operands.empty()) return command.operands;
  std::string text;
  for (const CLI::Option* option : positionals(app))
    text += (text.empty() ? "" : " ") + option->get_name(true) +
            (option->get_expected_max() > 1 ? "..." : "");
  return text;
}

const std::vector<Remark>& exit_codes() {
  static const std::vector<Remark> codes = {
      {"0", "done"},
      {"2", "bad input or usage"},
      {"3", "the dip could not be computed"},
      {"4", "do not dip it like this (with --strict)"},
      {"130", "cancelled"},
  };
  return codes;
}

const std::vector<Remark>& environment_variables() {
  static const std::vector<Remark> variables = {
      {"HYDRODIP_SIMD",
       "baseline, avx2 or avx512 picks the instruction set by hand; results are the "
       "same"},
  };
  return variables;
}

const std::vector<std::string>& first_commands() {
  static const std::vector<std::string> all = {
      "hydrodip sample mask -o models", "hydrodip print models/mask.obj --film a4 -o mask-print"};
  return all;
}

CommandLine parse_command_line(const std::vector<std::string>& arguments) {
  const std::string first = arguments.empty() ? "" : arguments.front();
  if (first.empty())
    throw InputError("name a command, as in 'hydrodip print MODEL'; see 'hydrodip --help'");
  if (first == "help" && arguments.size() > 1) {
    std::vector<std::string> about(arguments.begin() + 1, arguments.end());
    about.emplace_back("--help");
    return parse_command_line(about);
  }
  if (first == "--help" || first == "-h" || first == "help") return {nullptr, {}, general_help()};
  const bool asks = arguments.size() == 2 && (arguments[1] == "--help" || arguments[1] == "-h");
  if (asks && !group_help(first).empty() && !is_command(first))
    return {nullptr, {}, "Usage: hydrodip " + first + " COMMAND [OPTIONS]\n\n" + group_help(first)};
  if (first == "--version") return {nullptr, {}, fmt::format("hydrodip {}\n", build_version())};
  const std::size_t words = count_name_words(arguments);
  const std::string name = words == 2 ? first + " " + arguments[1] : first;
  return parse_command(find_command(name),
                       {arguments.begin() + static_cast<std::ptrdiff_t>(words), arguments.end()});
}

}  // namespace hydrodip
