// A job's command line for another command, ready to be typed.
#pragma once

#include <string>

#include "settings/config.h"

namespace hydrodip {

// What was typed, without where to write, how to say it, and how the object is held and how deep:
// "hydrodip print spot.obj --size 80". Words with blanks are quoted for a shell.
std::string command_text(const JobConfig& config, const std::string& command);

}  // namespace hydrodip
