// The studio's page: built from page/ and put into the program by CMake (cmake/studio.cmake).
#pragma once

#include <string>

namespace hydrodip {

std::string studio_page();
// The bundled script; empty when the program was built without it (HYDRODIP_VIEWER=OFF).
std::string studio_script();
std::string studio_style();

}  // namespace hydrodip
