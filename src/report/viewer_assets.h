// The report page's style, and the bundled script of its 3D view: built from viewer/ and put into
// the program by CMake (cmake/viewer.cmake).
#pragma once

#include <string>

namespace hydrodip {

std::string page_style();

// Empty when the program was built without the 3D view (HYDRODIP_VIEWER=OFF).
std::string viewer_script();

}  // namespace hydrodip
