// A calibrated tank as a file: camera.json.
#pragma once

#include <filesystem>
#include <string>

#include "camera/tank.h"

namespace hydrodip {

std::string tank_as_json(const Tank& tank);
// Throws InputError, naming the file, for what is none.
Tank read_tank(const std::filesystem::path& file);

// Calibrating a camera anew moves no strip: the water's level and the film's place stay as they
// were said. False if the strips did move, by a millimetre: then only the level is kept, and a
// place that had been set is lost.
bool keep_what_was_said(const Tank& earlier, Tank& tank);

}  // namespace hydrodip
