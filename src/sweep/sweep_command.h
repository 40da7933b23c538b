// What each run of a sweep does.
#pragma once

#include <string>
#include <vector>

namespace hydrodip {

enum class SweepCommand { kSimulate, kPrint, kOrient };

// "simulate", which is meant where nothing is said, and the others.
std::vector<std::string> sweep_command_names();
std::string name_of(SweepCommand command);
// Throws InputError for another name.
SweepCommand sweep_command_of(const std::string& name);

}  // namespace hydrodip
