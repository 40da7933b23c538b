// The desktop's browser.
#pragma once

#include <string>

namespace hydrodip {

// Whether there is a screen on which one could be seen.
bool has_screen();

// Whether the desktop's opener took the file or address. It returns at once, and says nothing.
bool open_in_browser(const std::string& what);

}  // namespace hydrodip
