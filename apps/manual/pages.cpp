#include "pages.h"

#include <fmt/format.h>

#include "command_line.h"
#include "settings/artwork_tables.h"
#include "settings/params.h"

namespace hydrodip {
namespace {

// As a cell of a table, or between backticks in one.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|')
      out += "&#124;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '*' || c == '_')
      out += std::string("\\") + c;
    else
      out += c;
  }
  return out;
}

std::string code(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? "&#124;" : c == '<' ? "&lt;" : std::string(1, c);
  return "<code>" + out + "</code>";
}

std::string options_table(const CommandText& command) {
  std::string text;
  for (const std::string& group : command.groups) {
    if (group == "Options") continue;  // --help
    text += "\n**" + cell(group) + "**\n\n| option | what it does |\n|---|---|\n";
    for (const OptionText& option : command.options) {
      if (option.group != group) continue;
      std::string name = option.short_name.empty() ? "" : option.short_name + ", ";
      name += option.name;
      if (!option.value.shown.empty()) name += " " + option.value.shown;
      text += "| " + code(name) + " | " + cell(option.help) + " |\n";
    }
  }
  return text;
}

}  // namespace

std::string commands_page(const std::vector<CommandText>& commands) {
  std::string text =
      "# Commands\n\nMade from the program's own tables, as `hydrodip COMMAND --help` and the "
      "manual "
      "pages are. Lengths are in mm, angles in degrees.\n\n| command | what for |\n|---|---|\n";
  for (const CommandText& command : commands)
    text +=
        fmt::format("| [`{}`](#{}) | {} |\n", command.name, command.page(), cell(command.summary));
  text += "\n| exit code | what it means |\n|---|---|\n";
  for (const Remark& remark : exit_codes())
    text += "| " + remark.what + " | " + cell(remark.means) + " |\n";
  for (const Remark& variable : environment_variables())
    text += "\n`" + variable.what + "` " + cell(variable.means) + ".\n";
  for (const CommandText& command : commands) {
    text += fmt::format("\n## hydrodip {} {{#{}}}\n\n{}.\n\n    hydrodip {}", command.name,
                        command.page(), cell(command.summary), command.name);
    text += (command.operands.empty() ? "" : " " + command.operands) + " [OPTIONS]\n\n";
    for (const ArgumentText& argument : command.arguments)
      text += "- " + code(argument.name) + ": " + cell(argument.help) + "\n";
    if (!command.details.empty()) {
      std::string lines = command.details;
      for (std::size_t at = 0; (at = lines.find('\n', at)) != std::string::npos; at += 5)
        lines.replace(at, 1, "\n    ");
      text += "\n    " + lines + "\n";
    }
    text += options_table(command);
  }
  return text;
}

std::string parameters_reference() {
  std::string text =
      "# Parameters\n\nAll of them may stand in a profile, a configuration or a job file, and "
      "after "
      "`--set`. `hydrodip params` prints this list, `hydrodip params --json` prints it for "
      "programs.\n";
  std::string group;
  for (const Parameter& p : parameters()) {
    const std::string this_group = p.name.substr(0, p.name.find('.'));
    if (this_group != group)
      text += "\n## " + this_group +
              "\n\n| parameter | what it does | default | range |\n|---|---|---|---|\n";
    group = this_group;
    text += "| " + code(p.name) + " | " + cell(p.help) + " | " +
            cell(show_value(p, p.default_value())) + " | " + cell(show_range(p)) + " |\n";
  }
  text +=
      "\n## artwork tables\n\nLayers on the object, the bottom one first, each an `[[artwork]]` "
      "table.\n\n| key | what it does | what it has to be |\n|---|---|---|\n";
  for (const LayerKey& key : layer_keys())
    text += "| " + code(key.name) + " | " + cell(key.help) + " | " + cell(key.range) + " |\n";
  return text;
}

}  // namespace hydrodip
