// Sentences without the command line in them: findings and errors are written for both.
#pragma once

#include <string>

namespace hydrodip {

// "Turn steep sides down (--rotate, --down)." -> "Turn steep sides down."
std::string in_plain_words(const std::string& sentence);

}  // namespace hydrodip
