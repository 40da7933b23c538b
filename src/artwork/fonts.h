// Which of this machine's fonts a text is set in: the only place that knows Fontconfig.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hydrodip {

// "DejaVu Serif bold italic" taken apart.
struct FontWish {
  std::string family = "sans-serif";
  bool bold = false, italic = false;
};
FontWish parse_font(std::string font);

struct FontUse {
  std::string name;            // "DejaVu Sans Bold"
  std::filesystem::path file;  // what decides what the letters look like
  bool is_wanted = true;       // the family that was asked for, or any for a general name as "sans"
};

// In the order of their first letters. `what`: whose text it is, for errors. Throws InputError: no
// fonts are installed, or none that has one of the letters.
std::vector<FontUse> fonts_for(const std::string& text, const FontWish& wish,
                               const std::string& what);

// The text's letters that no font has, each once, in UTF-8; on a machine without fonts all of them.
// Throws InputError, as fonts_for does, if the text is not valid UTF-8.
std::vector<std::string> letters_without_font(const std::string& text, const FontWish& wish,
                                              const std::string& what);

bool has_fonts();
// Throws InputError if this machine has no fonts.
void require_fonts(const std::string& what);

}  // namespace hydrodip
