// What the program understands, taken from its own tables: for manual pages, completion and the
// documentation, which are made from here and written nowhere by hand.
#pragma once

#include <string>
#include <vector>

namespace hydrodip {

// What may stand as an option's or an argument's value.
enum class ValueKind {
  kNone,   // a switch
  kFree,   // numbers, text
  kWords,  // one of `words`, or free text where `words` is not all
  kFile,   // any file, or one with an extension of `extensions`
  kFolder,
  kProfile,    // the name of a profile in the user's folder
  kParameter,  // NAME=VALUE of a parameter
};

struct ValueText {
  ValueKind kind = ValueKind::kNone;
  std::string shown;                    // "MM", "letter|a4|a3|WxH"; empty for switches
  std::vector<std::string> words;       // "letter", "a4", "a3"
  std::vector<std::string> extensions;  // "toml"
  bool profiles = false;                // or the name of a profile in the user's folder
};

struct OptionText {
  std::string name;        // "--film"
  std::string short_name;  // "-o"; mostly empty
  std::string group;       // "Film and dip"
  std::string help;
  ValueText value;
};

struct ArgumentText {
  std::string name;  // "MODEL"
  std::string help;
  bool repeated = false;
  ValueText value;
};

struct CommandText {
  std::string name;      // "rig sheet"
  std::string summary;   // one line
  std::string details;   // lines; may be empty
  std::string operands;  // "JOB_DIR SCAN..."; may be empty
  std::vector<ArgumentText> arguments;
  std::vector<std::string> groups;  // of the options, in order
  std::vector<OptionText> options;

  std::string page() const;  // "hydrodip-rig-sheet", its manual page
};

// All of them, in the program's order.
std::vector<CommandText> describe_commands();

}  // namespace hydrodip
