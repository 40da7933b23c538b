// What a setting's value has to be instead.
#pragma once

#include <string>

#include "settings/params.h"

namespace hydrodip {

// Throws InputError: where, which setting, what it must be, and what it is.
[[noreturn]] void refuse_value(const Setting& setting, const std::string& expected);

}  // namespace hydrodip
