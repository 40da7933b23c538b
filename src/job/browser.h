// The desktop's browser.
#pragma once

#include <string>

namespace hydrodip {

// Whether there is a screen on which one could be seen.
bool has_screen();

// Whether the desktop's opener took the file or address, of which it says nothing. Waits for it:
// where there is no desktop it may be the browser itself, and end with that.
bool open_in_browser(const std::string& what);

// The same for who has other things to do: waits for nothing, and what was opened outlives the
// program and its Ctrl-C.
void begin_in_browser(const std::string& what);

}  // namespace hydrodip
