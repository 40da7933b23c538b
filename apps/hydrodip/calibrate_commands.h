// The commands that find a film's parameters: calibrate, calibrate kit, calibrate synth, measure.
#pragma once

#include <vector>

#include "commands.h"

namespace hydrodip {

std::vector<Command> calibrate_commands();

}  // namespace hydrodip
