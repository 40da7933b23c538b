// A mesh for a 3D printer.
#pragma once

#include <filesystem>
#include <string>

#include "object/object.h"

namespace hydrodip {

// Binary STL, mm; the title is cut to the 80 bytes that the format has for it.
void write_stl(const std::filesystem::path& file, const TriangleMesh& mesh,
               const std::string& title);

}  // namespace hydrodip
