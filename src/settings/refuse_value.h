// What a setting's value has to be instead.
#pragma once

#include <string>

#include "settings/params.h"

namespace hydrodip {

// What a value should have been: a single number, which somebody may have quoted by mistake.
enum class Wanted { kNumber, kOther };

// Throws InputError: where, which setting, what it must be, and what it is.
[[noreturn]] void refuse_value(const Setting& setting, Wanted wanted, const std::string& expected);

}  // namespace hydrodip
