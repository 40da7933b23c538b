// A calibrated tank as a file: camera.json.
#pragma once

#include <filesystem>
#include <string>

#include "camera/tank.h"

namespace hydrodip {

std::string tank_as_json(const Tank& tank);
// Throws InputError, naming the file, for what is none.
Tank read_tank(const std::filesystem::path& file);

}  // namespace hydrodip
