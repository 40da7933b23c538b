// For tests of messages.
#pragma once

#include <string>

namespace hydrodip {

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace hydrodip
