#include "completion.h"

#include <fmt/format.h>

#include <algorithm>

#include "settings/params.h"

namespace hydrodip {
namespace {

constexpr const char* kMadeFrom =
    "# Made from the program's own table of commands and parameters: do not edit.\n";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
    text.replace(at, what.size(), with);
  return text;
}

// For all three shells.
std::string quoted(const std::string& text) { return "'" + replaced(text, "'", "'\\''") + "'"; }

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

// "rig" of "rig sheet"; "" of commands of one word.
std::string group_of(const std::string& name) {
  const std::size_t blank = name.find(' ');
  return blank == std::string::npos ? "" : name.substr(0, blank);
}

struct Word {
  std::string word;
  std::string help;
};

// What may follow "hydrodip": a group that is no command itself says what is in it.
std::vector<Word> first_words(const std::vector<CommandText>& commands) {
  std::vector<Word> words;
  const auto known = [&](const std::string& word) {
    return std::any_of(words.begin(), words.end(), [&](const Word& w) { return w.word == word; });
  };
  for (const CommandText& command : commands) {
    const std::string group = group_of(command.name);
    if (group.empty()) words.push_back({command.name, command.summary});
    if (group.empty() || known(group)) continue;
    std::vector<std::string> inside;
    for (const CommandText& other : commands)
      if (other.name == group) inside.assign(1, other.summary);
    if (inside.empty())
      for (const CommandText& other : commands)
        if (group_of(other.name) == group) inside.push_back(other.name.substr(group.size() + 1));
    words.push_back({group, joined(inside, ", ")});
  }
  // A command of one word may come after its group's others.
  std::vector<Word> once;
  for (const Word& word : words)
    if (std::none_of(once.begin(), once.end(), [&](const Word& w) { return w.word == word.word; }))
      once.push_back(word);
  once.push_back({"--help", "the list of commands"});
  once.push_back({"--version", "which hydrodip this is"});
  return once;
}

std::vector<Word> second_words(const std::vector<CommandText>& commands, const std::string& group) {
  std::vector<Word> words;
  for (const CommandText& command : commands)
    if (group_of(command.name) == group)
      words.push_back({command.name.substr(group.size() + 1), command.summary});
  return words;
}

std::vector<std::string> groups_of(const std::vector<CommandText>& commands) {
  std::vector<std::string> groups;
  for (const CommandText& command : commands) {
    const std::string group = group_of(command.name);
    if (!group.empty() && std::find(groups.begin(), groups.end(), group) == groups.end())
      groups.push_back(group);
  }
  return groups;
}

std::vector<std::string> only_words(const std::vector<Word>& words) {
  std::vector<std::string> names;
  names.reserve(words.size());
  for (const Word& word : words) names.push_back(word.word);
  return names;
}

// The words that a parameter's value may be.
std::vector<std::string> values_of(const Parameter& p) {
  std::vector<std::string> values;
  for (const std::string& choice : p.choices)
    if (!choice.empty()) values.push_back(choice);
  if (!p.word.empty()) values.push_back(p.word);
  return values;
}

// ---- bash ----

std::string bash_action(const ValueText& value) {
  switch (value.kind) {
    case ValueKind::kNone:
    case ValueKind::kFree:
      return ":";
    case ValueKind::kWords:
      return "_hydrodip_words " + quoted(joined(value.words, " "));
    case ValueKind::kFile:
      return "_hydrodip_files " + quoted(joined(value.extensions, "|")) +
             (value.profiles ? "; _hydrodip_profiles" : "");
    case ValueKind::kFolder:
      return "_hydrodip_folders";
    case ValueKind::kProfile:
      return "_hydrodip_profiles";
    case ValueKind::kParameter:
      return "_hydrodip_parameters";
  }
  return ":";
}

std::string bash_command(const CommandText& command) {
  std::vector<std::string> names;
  std::string text = "    " + quoted(command.name) + ")\n      case $previous in\n";
  for (const OptionText& option : command.options) {
    names.push_back(option.name);
    if (!option.short_name.empty()) names.push_back(option.short_name);
    if (option.value.kind == ValueKind::kNone) continue;
    text += "        " + option.name + (option.short_name.empty() ? "" : "|" + option.short_name) +
            ") " + bash_action(option.value) + "; return ;;\n";
  }
  text += "      esac\n      if [[ $current == -* ]]; then\n        _hydrodip_words " +
          quoted(joined(names, " ")) + "\n      else\n        ";
  text += command.arguments.empty() ? ":" : bash_action(command.arguments.front().value);
  return text + "\n      fi ;;\n";
}

// ---- zsh ----

// Inside "--option[help]:value:action".
std::string zsh_text(const std::string& text) {
  return replaced(replaced(replaced(text, "[", "\\["), "]", "\\]"), ":", "\\:");
}

std::string zsh_action(const ValueText& value) {
  switch (value.kind) {
    case ValueKind::kNone:
      return "";
    case ValueKind::kFree:
      return ":" + zsh_text(value.shown) + ": ";
    case ValueKind::kWords:
      return ":" + zsh_text(value.shown) + ":(" + joined(value.words, " ") + ")";
    case ValueKind::kFile:
      if (value.profiles) return ":" + zsh_text(value.shown) + ":_hydrodip_profiles_or_files";
      if (value.extensions.empty()) return ":" + zsh_text(value.shown) + ":_files";
      return ":" + zsh_text(value.shown) + ":_files -g \"*.(#i)(" + joined(value.extensions, "|") +
             ")\"";
    case ValueKind::kFolder:
      return ":" + zsh_text(value.shown) + ":_files -/";
    case ValueKind::kProfile:
      return ":" + zsh_text(value.shown) + ":_hydrodip_profiles";
    case ValueKind::kParameter:
      return ":" + zsh_text(value.shown) + ":_hydrodip_parameters";
  }
  return "";
}

std::string zsh_described(const std::vector<Word>& words) {
  std::string text;
  for (const Word& word : words)
    text += " " + quoted(replaced(word.word, ":", "\\:") + ":" + replaced(word.help, ":", "\\:"));
  return text;
}

std::string zsh_command(const CommandText& command) {
  std::string text = "    " + quoted(command.name) + ")\n      _arguments -s -S";
  for (const OptionText& option : command.options) {
    const std::string rest = "[" + zsh_text(option.help) + "]" + zsh_action(option.value);
    const bool valued = option.value.kind != ValueKind::kNone;
    const bool again = option.value.kind == ValueKind::kParameter;
    const auto add = [&](const std::string& name, const char* join) {
      text += " \\\n        ";
      text += quoted(fmt::format("{}{}{}{}", again ? "*" : "", name, valued ? join : "", rest));
    };
    add(option.name, "=");
    if (!option.short_name.empty()) add(option.short_name, "+");
  }
  for (std::size_t i = 0; i < command.arguments.size(); ++i) {
    const ArgumentText& argument = command.arguments[i];
    ValueText value = argument.value;
    value.shown = argument.name;
    text += " \\\n        " +
            quoted((argument.repeated ? "*" : fmt::format("{}:", i + 1)) + zsh_action(value));
  }
  return replaced(text, "'1::", "'1:") + " ;;\n";
}

// ---- fish ----

std::string fish_value(const ValueText& value) {
  switch (value.kind) {
    case ValueKind::kNone:
      return "";
    case ValueKind::kFree:
      return " -x";
    case ValueKind::kWords:
      return " -x -a " + quoted(joined(value.words, " "));
    case ValueKind::kFile:
      return value.profiles ? " -r -F -a '(__hydrodip_profiles)'" : " -r -F";
    case ValueKind::kFolder:
      return " -x -a '(__fish_complete_directories)'";
    case ValueKind::kProfile:
      return " -x -a '(__hydrodip_profiles)'";
    case ValueKind::kParameter:
      return " -x -a '(__hydrodip_parameters)'";
  }
  return "";
}

// fish knows two escapes inside single quotes.
std::string fish_quoted(const std::string& text) {
  return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

std::string fish_command(const CommandText& command) {
  const std::string at =
      "complete -c hydrodip -n " + fish_quoted("__hydrodip_at " + quoted(command.name));
  std::string text;
  for (const OptionText& option : command.options) {
    text += at + " -l " + option.name.substr(2);
    if (!option.short_name.empty()) text += " -s " + option.short_name.substr(1);
    text += fish_value(option.value) + " -d " + fish_quoted(option.help) + "\n";
  }
  if (command.arguments.empty()) return text;
  const ValueText& value = command.arguments.front().value;
  if (value.kind == ValueKind::kFile) text += at + " -F\n";
  if (value.kind == ValueKind::kFolder) text += at + " -a '(__fish_complete_directories)'\n";
  if (value.kind == ValueKind::kProfile) text += at + " -a '(__hydrodip_profiles)'\n";
  if (value.kind == ValueKind::kWords)
    text += at + " -a " + fish_quoted(joined(value.words, " ")) + "\n";
  return text;
}

}  // namespace

std::string bash_completion(const std::vector<CommandText>& commands) {
  std::string text = std::string("# bash completion for hydrodip\n") + kMadeFrom + R"(
_hydrodip_words() {
  COMPREPLY=($(compgen -W "$1" -- "$current"))
}

# Files whose names end in one of the extensions ("png|jpg"; empty: any), and folders.
_hydrodip_files() {
  local IFS=$'\n' file
  compopt -o filenames
  COMPREPLY=()
  for file in $(compgen -f -- "$current"); do
    if [[ -d $file || -z $1 || ${file##*.} =~ ^($1)$ ]]; then COMPREPLY+=("$file"); fi
  done
}

# The profiles in the user's folder, by name, besides what is offered already.
_hydrodip_profiles() {
  local file
  for file in "${XDG_CONFIG_HOME:-$HOME/.config}"/hydrodip/profiles/*.toml; do
    file=${file##*/}
    if [[ -n $current && ${file%.toml} != "$current"* ]]; then continue; fi
    if [[ $file != '*.toml' ]]; then COMPREPLY+=("${file%.toml}"); fi
  done
}

_hydrodip_folders() {
  local IFS=$'\n'
  compopt -o filenames
  COMPREPLY=($(compgen -d -- "$current"))
}

_hydrodip_parameters() {
  compopt -o nospace
  _hydrodip_words ')";
  for (const Parameter& p : parameters()) text += p.name + "= ";
  text += "'\n}\n\n_hydrodip_values() {\n  case $1 in\n";
  for (const Parameter& p : parameters()) {
    const std::vector<std::string> values = values_of(p);
    if (!values.empty())
      text += "    " + p.name + ") _hydrodip_words " + quoted(joined(values, " ")) + " ;;\n";
    else if (p.type == ParameterType::kPath || p.type == ParameterType::kWayIn)
      text += "    " + p.name + ") _hydrodip_files '' ;;\n";
  }
  text += R"(  esac
}

_hydrodip() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}
  local command=${COMP_WORDS[1]} at=$COMP_CWORD
  COMPREPLY=()
  # bash cuts words at '='.
  if [[ $current == = ]]; then current=; at=$((at + 1)); fi
  if ((at > 2)) && [[ ${COMP_WORDS[at-1]} == = ]]; then
    previous=${COMP_WORDS[at-2]}
    if [[ $previous != -* ]]; then _hydrodip_values "$previous"; return; fi
  fi
  if ((at == 1)); then
    _hydrodip_words ')";
  text +=
      joined(only_words(first_words(commands)), " ") + "'\n    return\n  fi\n  case $command in\n";
  for (const std::string& group : groups_of(commands)) {
    const std::vector<std::string> inside = only_words(second_words(commands, group));
    const bool alone = std::any_of(commands.begin(), commands.end(),
                                   [&](const CommandText& c) { return c.name == group; });
    text += "    " + group + ")\n      if ((at == 2)) && [[ $current != -* ]]; then\n";
    text += "        _hydrodip_words " + quoted(joined(inside, " ")) + "\n";
    // A group that is a command too has arguments of its own.
    text += alone ? "        if ((${#COMPREPLY[@]})) && [[ -n $current ]]; then return; fi\n"
                  : "        return\n";
    text += "      else\n        case ${COMP_WORDS[2]} in\n          " + joined(inside, "|") +
            ") command=\"$command ${COMP_WORDS[2]}\" ;;\n        esac\n      fi ;;\n";
  }
  text += "  esac\n  case $command in\n";
  for (const CommandText& command : commands) text += bash_command(command);
  return text + "  esac\n}\n\ncomplete -F _hydrodip hydrodip\n";
}

std::string zsh_completion(const std::vector<CommandText>& commands) {
  std::string text = std::string("#compdef hydrodip\n") + kMadeFrom + R"(
_hydrodip_profiles() {
  compadd -- ${XDG_CONFIG_HOME:-$HOME/.config}/hydrodip/profiles/*.toml(N:t:r)
}

_hydrodip_profiles_or_files() {
  _alternative 'profiles:profile:_hydrodip_profiles' 'files:file:_files -g "*.(#i)toml"'
}

_hydrodip_parameters() {
  if compset -P '*='; then
    case ${IPREFIX#*set=} in
)";
  for (const Parameter& p : parameters()) {
    const std::vector<std::string> values = values_of(p);
    if (!values.empty())
      text += "      *" + p.name + "=) compadd -- " + joined(values, " ") + " ;;\n";
    else if (p.type == ParameterType::kPath || p.type == ParameterType::kWayIn)
      text += "      *" + p.name + "=) _files ;;\n";
  }
  text += "    esac\n    return\n  fi\n  local -a names=(";
  for (const Parameter& p : parameters())
    text += "\n    " + quoted(replaced(p.name + ":" + p.help, "\n", " "));
  text += R"(
  )
  _describe -t parameters parameter names -S = -q
}

_hydrodip() {
  local command=$words[2]
  if ((CURRENT == 2)); then
    local -a first=()";
  text += zsh_described(first_words(commands)) +
          ")\n    _describe -t commands command first\n    "
          "return\n  fi\n  shift words\n  ((CURRENT--))\n  case $command in\n";
  for (const std::string& group : groups_of(commands)) {
    const std::vector<Word> inside = second_words(commands, group);
    const bool alone = std::any_of(commands.begin(), commands.end(),
                                   [&](const CommandText& c) { return c.name == group; });
    text += "    " + group +
            ")\n      if ((CURRENT == 2)) && [[ $words[2] != -* ]]; then\n        "
            "local -a inside=(" +
            zsh_described(inside) + ")\n        _describe -t commands command inside\n" +
            (alone ? "" : "        return\n") + "      fi\n      case $words[2] in\n        " +
            joined(only_words(inside), "|") +
            ") command=\"$command $words[2]\"; shift words; ((CURRENT--)) ;;\n      esac ;;\n";
  }
  text += "  esac\n  case $command in\n";
  for (const CommandText& command : commands) text += zsh_command(command);
  return text + "  esac\n}\n\n_hydrodip \"$@\"\n";
}

std::string fish_completion(const std::vector<CommandText>& commands) {
  std::string text = std::string("# fish completion for hydrodip\n") + kMadeFrom + R"(
# Whether the command is this one: the words that are no options begin with its name, and with no
# longer name's.
function __hydrodip_at
    set -l words (string match -v -- '-*' (commandline -opc)[2..-1])
    set -l pair (string join ' ' $words[1..2])
    if contains -- "$pair" )";
  for (const CommandText& command : commands)
    if (!group_of(command.name).empty()) text += quoted(command.name) + " ";
  text += R"(
        test "$pair" = "$argv[1]"
    else
        test "$words[1]" = "$argv[1]"
    end
end

# Whether the command is still to be named, or its second word.
function __hydrodip_first
    test (count (commandline -opc)) -eq 1
end
function __hydrodip_second
    set -l words (commandline -opc)
    test (count $words) -eq 2 -a "$words[2]" = "$argv[1]"
end

# The profiles in the user's folder, by name.
function __hydrodip_profiles
    set -l folder "$HOME/.config"
    set -q XDG_CONFIG_HOME; and set folder "$XDG_CONFIG_HOME"
    for file in "$folder"/hydrodip/profiles/*.toml
        string replace -r '.*/(.*)[.]toml$' '$1' -- "$file"
    end
end

function __hydrodip_parameters
)";
  for (const Parameter& p : parameters()) {
    text +=
        "    printf '%s\\t%s\\n' " + fish_quoted(p.name + "=") + " " + fish_quoted(p.help) + "\n";
    for (const std::string& value : values_of(p))
      text += "    printf '%s\\n' " + fish_quoted(p.name + "=" + value) + "\n";
  }
  text += "end\n\ncomplete -c hydrodip -f\n";
  for (const Word& word : first_words(commands))
    text += "complete -c hydrodip -n __hydrodip_first -a " + fish_quoted(word.word) + " -d " +
            fish_quoted(word.help) + "\n";
  for (const std::string& group : groups_of(commands))
    for (const Word& word : second_words(commands, group))
      text += "complete -c hydrodip -n '__hydrodip_second " + group + "' -a " +
              fish_quoted(word.word) + " -d " + fish_quoted(word.help) + "\n";
  for (const CommandText& command : commands) text += fish_command(command);
  return text;
}

}  // namespace hydrodip
