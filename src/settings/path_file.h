// A way into the water from a table of keyframes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dip/trajectory.h"

namespace hydrodip {

// Reads a table (TableRows) with the header
// lower_mm,shift_x_mm,shift_y_mm,turn_x_deg,turn_y_deg,turn_z_deg and one keyframe a row. Throws
// InputError with file and line.
std::vector<Keyframe> read_path(const std::filesystem::path& file);

// Whether a file begins as one of those does; no configuration does.
bool is_path_file(const std::filesystem::path& file);

// The same rows in one line, "0,0,0,0,0,0; 20,6,0,0,10,0", as reports have them.
std::vector<Keyframe> path_of_rows(const std::string& text, const std::string& origin);
std::string rows_of(const std::vector<Keyframe>& keyframes);

// Throws InputError, beginning with `origin`, if there are fewer than two keyframes or more than a
// table by hand has, or if one is out of any bath.
void check_path(const std::vector<Keyframe>& keyframes, const std::string& origin);

}  // namespace hydrodip
