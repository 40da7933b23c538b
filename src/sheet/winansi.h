// Text for the standard PDF fonts, which know Latin letters only.
#pragma once

#include <string>

namespace hydrodip {

// UTF-8 to Windows-1252 ("WinAnsi"). Accented letters that it lacks lose their accents, combining
// accents and control characters vanish, everything else (other scripts, invalid bytes) becomes
// '?'.
std::string to_winansi(const std::string& utf8);

}  // namespace hydrodip
