// Characters beyond ASCII in bytes: UTF-8 is what all texts are read as.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace hydrodip {

// A character below 0x110000, behind a text of bytes or letters.
template <class Text>
void append_utf8(std::uint32_t code, Text& out) {
  constexpr std::uint32_t kLead[] = {0, 0xc0, 0xe0, 0xf0};
  const auto append = [&](std::uint32_t byte) { out.push_back(typename Text::value_type(byte)); };
  const unsigned more = code < 0x80 ? 0 : code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
  append(kLead[more] | code >> (6 * more));
  for (unsigned left = more; left-- > 0;) append(0x80 | (code >> (6 * left) & 0x3f));
}

// A text in UTF-16 with its byte order mark, as Windows' editors and shells save it, brought to
// UTF-8; other bytes stay as they are.
std::vector<std::uint8_t> in_utf8(std::vector<std::uint8_t> bytes);

// At most so many bytes of a text, without half a character at its end.
std::string cut_utf8(std::string text, std::size_t most_bytes);

}  // namespace hydrodip
