// For tests of what is refused.
#pragma once

#include <functional>
#include <string>

#include "base/error.h"

namespace hydrodip {

// The sentence with which it refuses; empty: it does not.
inline std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace hydrodip
