// Pieces of text.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

namespace hydrodip {

// As ASCII has them, in every locale.
inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

// Without blanks around it; of what `text` is of.
inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

// What stands between the separators, empty parts too: one more than there are separators.
inline std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

// Takes the next blank-separated word off the front; empty at the end.
inline std::string_view take_word(std::string_view& rest) {
  std::size_t begin = 0;
  while (begin < rest.size() && is_blank(rest[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest.size() && !is_blank(rest[end])) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

// Takes the next line off the front, without its line end: LF, CR LF, or CR alone.
inline std::string_view take_line(std::string_view& rest) {
  std::size_t end = 0;  // find_first_of asks a function for every character
  while (end < rest.size() && rest[end] != '\n' && rest[end] != '\r') ++end;
  const std::string_view line = rest.substr(0, end);
  const bool both = rest.substr(end, 2) == "\r\n";
  rest.remove_prefix(std::min(rest.size(), end + (both ? 2 : 1)));
  return line;
}

// Without the byte order mark that some editors put before UTF-8.
inline std::string_view without_bom(std::string_view text) {
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  return text;
}

}  // namespace hydrodip
