#include "settings/hex_color.h"

#include <fmt/format.h>

#include <charconv>

namespace hydrodip {

std::optional<LinearColor> parse_color(std::string_view text) {
  if (text.size() != 7 || text[0] != '#' ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != text.npos)
    return {};
  const auto channel = [&](std::size_t at) {
    std::uint8_t value = 0;
    std::from_chars(text.data() + at, text.data() + at + 2, value, 16);
    return srgb8_to_linear(value);
  };
  return LinearColor{channel(1), channel(3), channel(5), 1};
}

std::string hex_of(const LinearColor& color) {
  return fmt::format("#{:02x}{:02x}{:02x}", linear_to_srgb8(color.r), linear_to_srgb8(color.g),
                     linear_to_srgb8(color.b));
}

}  // namespace hydrodip
