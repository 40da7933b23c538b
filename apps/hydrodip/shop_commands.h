// The commands for those who do the same often: profiles, history.
#pragma once

#include <vector>

#include "commands.h"

namespace hydrodip {

std::vector<Command> shop_commands();

}  // namespace hydrodip
