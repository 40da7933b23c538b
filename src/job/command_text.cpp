#include "job/command_text.h"

#include <algorithm>
#include <array>

#include "base/shell_word.h"

namespace hydrodip {
namespace {

constexpr std::array<const char*, 5> kAlone = {"--json", "--quiet", "--strict", "-q", "--"};
constexpr std::array<const char*, 6> kWithValue = {"-o",      "--output", "--rotate",
                                                   "--depth", "--down",   "--dips"};

bool is_one_of(const std::string& word, const auto& list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

}  // namespace

std::string command_text(const JobConfig& config, const std::string& command) {
  std::string text = "hydrodip " + command;
  const std::vector<std::string>& typed = config.command_line;
  if (typed.size() < 3) return text + " " + shell_word(config.model.string());
  for (std::size_t i = 2; i < typed.size(); ++i) {
    const std::string name = typed[i].substr(0, typed[i].find('='));
    if (is_one_of(name, kAlone)) continue;
    if (is_one_of(name, kWithValue)) {
      if (name == typed[i]) ++i;
      continue;
    }
    text += " " + shell_word(typed[i]);
  }
  return text;
}

}  // namespace hydrodip
