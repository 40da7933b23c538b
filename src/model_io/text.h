// Words and numbers of text model files, shared by the readers.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/parse_double.h"
#include "base/text.h"

namespace hydrodip {

// Without the quotation marks that some exporters put around names.
inline std::string_view unquoted(std::string_view name) {
  return name.size() > 1 && name.front() == '"' && name.back() == '"'
             ? name.substr(1, name.size() - 2)
             : name;
}

inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  return out;
}

// The whole word as a finite number that also fits a float.
inline bool parse_number(std::string_view word, double& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = parse_double(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(float(value));
}

inline bool parse_integer(std::string_view word, std::int64_t& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

// A coordinate. Whole part and decimals are rounded apart, as hydrodip did from its first version
// on, so that results stay the same bytes; the difference is one float's last bit.
bool parse_coordinate(std::string_view word, float& value);

}  // namespace hydrodip
