// Text from files and paths, made safe for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace hydrodip {

// Control characters (C0 but line feed and tab, DEL, C1 alone or as UTF-8), characters that turn
// the direction of text, and bytes that are no UTF-8 become visible: "\u001b", which is also how
// JSON writes them. All else stays.
std::string harmless(std::string_view text);

}  // namespace hydrodip
