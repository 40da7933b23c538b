// Which version this program is, commits after the last tag included. Made by
// cmake/build_version.cmake.
#pragma once

namespace hydrodip {

const char* build_version();

}  // namespace hydrodip
