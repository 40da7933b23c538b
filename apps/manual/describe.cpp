#include "describe.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <memory>
#include <string_view>

#include "base/text.h"
#include "command_line.h"
#include "commands.h"

namespace hydrodip {
namespace {

bool has_capital(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isupper(c) != 0; });
}

// "MM|auto": capitals stand for what the user has to say, "0..1" for a range, "#rrggbb" for a
// pattern; all else is a word to be typed as it stands.
bool is_word(std::string_view text) {
  return !text.empty() && !has_capital(text) && text.find("..") == text.npos && text[0] != '#';
}

// Of models: those of model_io, and jobs.
const std::vector<std::string> kModelExtensions = {"obj", "ply",  "stl", "off",
                                                   "3mf", "gltf", "glb", "toml"};

ValueText value_of(const std::string& shown) {
  ValueText value{ValueKind::kFree, shown, {}, {}, false};
  if (shown == "NAME=VALUE") {
    value.kind = ValueKind::kParameter;
  } else if (shown == "DIR" || shown.ends_with("_DIR")) {
    value.kind = ValueKind::kFolder;
  } else if (shown == "MODEL" || shown.starts_with("MODEL|") || shown == "PART") {
    value.kind = ValueKind::kFile;
    value.extensions = kModelExtensions;
  } else if (shown == "IMG" || shown == "FILE" || shown.ends_with("SCAN") || shown == "PORT" ||
             shown == "PHOTO" || shown == "JOB") {
    value.kind = ValueKind::kFile;
  } else if (shown.starts_with("FILE.") || shown.find("|FILE.") != std::string::npos) {
    value.kind = ValueKind::kFile;
    for (const std::string_view part : split(shown, '|')) {
      if (part.starts_with("FILE."))
        value.extensions.emplace_back(part.substr(5));
      else
        value.profiles = value.profiles || part == "NAME";
    }
  } else {
    for (const std::string_view part : split(shown, '|'))
      if (is_word(part)) value.words.emplace_back(part);
    if (!value.words.empty()) value.kind = ValueKind::kWords;
  }
  return value;
}

ArgumentText argument_of(const CLI::Option& option, const Command& command, bool first) {
  ArgumentText argument{option.get_name(true), option.get_description(),
                        option.get_expected_max() > 1, value_of(option.get_name(true))};
  if (first && !command.words.empty())
    argument.value = {ValueKind::kWords, argument.name, command.words, {}, false};
  // Of one that is brought in, a new name.
  if (argument.name == "NAME" && command.name.starts_with("profile ") && first)
    argument.value.kind = ValueKind::kProfile;
  return argument;
}

OptionText option_of(const CLI::Option& option) {
  OptionText text;
  text.name = "--" + option.get_lnames().front();
  if (!option.get_snames().empty()) text.short_name = "-" + option.get_snames().front();
  text.group = option.get_group();
  text.help = option.get_description();
  if (option.get_items_expected_max() > 0) text.value = value_of(option.get_type_name());
  return text;
}

CommandText text_of(const Command& command) {
  Request request;
  const std::unique_ptr<CLI::App> app = command_options(command, request);
  CommandText text{
      command.name, command.summary, command.details, operands_of(command, *app), {}, {}, {}};
  for (const CLI::Option* option : app->get_options()) {
    if (option->get_positional())
      text.arguments.push_back(argument_of(*option, command, text.arguments.empty()));
    else if (!option->get_lnames().empty())
      text.options.push_back(option_of(*option));
  }
  for (OptionText& option : text.options) {
    if (option.name == "--help") option.help = "what this command does and takes";
    if (std::find(text.groups.begin(), text.groups.end(), option.group) == text.groups.end())
      text.groups.push_back(option.group);
  }
  // --help, CLI11's own, comes last.
  const auto own = std::find(text.groups.begin(), text.groups.end(), "Options");
  if (own != text.groups.end()) std::rotate(own, own + 1, text.groups.end());
  return text;
}

}  // namespace

std::string CommandText::page() const {
  std::string page = "hydrodip-" + name;
  std::replace(page.begin(), page.end(), ' ', '-');
  return page;
}

std::vector<CommandText> describe_commands() {
  std::vector<CommandText> all;
  for (const Command& command : commands()) all.push_back(text_of(command));
  return all;
}

}  // namespace hydrodip
