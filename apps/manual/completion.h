// Completion for shells.
#pragma once

#include <string>
#include <vector>

#include "describe.h"

namespace hydrodip {

std::string bash_completion(const std::vector<CommandText>& commands);
std::string zsh_completion(const std::vector<CommandText>& commands);
std::string fish_completion(const std::vector<CommandText>& commands);

}  // namespace hydrodip
