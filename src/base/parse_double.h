// A double from text. As std::from_chars, which libc++ lacks for doubles up to its version 19.
#pragma once

#include <charconv>

namespace hydrodip {

// For standard libraries without std::from_chars for doubles; the same result, up to the last bit.
std::from_chars_result parse_double_by_strtod(const char* first, const char* last, double& value);

// [first, last) begins with a number, in the C locale's decimal or scientific notation, without
// blanks or a plus before it. Sets `value` only if it does.
inline std::from_chars_result parse_double(const char* first, const char* last, double& value) {
#if defined(__cpp_lib_to_chars) || defined(__GLIBCXX__)
  return std::from_chars(first, last, value);
#else
  return parse_double_by_strtod(first, last, value);
#endif
}

}  // namespace hydrodip
