// `hydrodip rig sheet|guide|jig|stage`.
#pragma once

#include "commands.h"

namespace hydrodip {

std::vector<Command> rig_commands();

}  // namespace hydrodip
