// Places of the sheet, measured on the dipped object, as a table.
#pragma once

#include <filesystem>
#include <vector>

#include "base/math.h"

namespace hydrodip {

struct PlaceRow {
  Vec2 on_sheet = Vec2::Zero();  // film coordinate, mm
  Vec3 position = Vec3::Zero();  // posed-object frame, mm
};

// Whether the file's first line has columns like those of the header below.
bool is_place_table(const std::filesystem::path& file);

// A table (TableRows): "film_x_mm,film_y_mm,x,y,z", then a line per place. Throws InputError naming
// file and line.
std::vector<PlaceRow> read_place_table(const std::filesystem::path& file);

}  // namespace hydrodip
