// `hydrodip calibrate printer`, `register` and `correct`.
#pragma once

#include "commands.h"

namespace hydrodip {

std::vector<Command> register_commands();

}  // namespace hydrodip
