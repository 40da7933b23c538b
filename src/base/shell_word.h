// Command lines as people copy them.
#pragma once

#include <string>

namespace hydrodip {

// A word as a shell takes it: in quotation marks if it has more than plain letters.
std::string shell_word(const std::string& word);

}  // namespace hydrodip
