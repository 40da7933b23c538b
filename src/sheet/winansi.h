// Text for the standard PDF fonts, which know Latin letters only, and for a PDF's own records.
#pragma once

#include <string>

namespace hydrodip {

// UTF-8 as it can be set and written: without control characters and marks that turn lines around,
// '?' for every byte that is no UTF-8 and for what stands for no character.
std::string tidy_utf8(const std::string& utf8);

// Whether Windows-1252 has all letters of a tidy text as they are.
bool is_winansi(const std::string& tidy);

// UTF-8 to Windows-1252 ("WinAnsi"). Accented letters that it lacks lose their accents, combining
// accents and control characters vanish, everything else (other scripts, invalid bytes) becomes
// '?'.
std::string to_winansi(const std::string& utf8);

// A tidy text in UTF-16, the higher byte first, behind a byte order mark.
std::string to_utf16(const std::string& tidy);

}  // namespace hydrodip
