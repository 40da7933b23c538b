// Numbers in sentences for people: rounded alike wherever they stand, and never with an exponent.
#pragma once

#include <string>

namespace hydrodip {

// "0 %", "under 0.1 %", "2.1 %", "47 %".
std::string percent(double share);

// To about two digits: "under 0.01", "0.24", "2.4", "280".
std::string plain_number(double value);

// To three digits: "0.65", "282", "126000"; "0" below 0.0001.
std::string three_digits(double value);

// The number that is written with so many digits, in any locale.
double rounded_to_digits(double value, int digits);

}  // namespace hydrodip
