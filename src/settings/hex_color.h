// Colours as files and options have them: sRGB, "#rrggbb".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "image/image.h"

namespace hydrodip {

// Nothing: it is no colour.
std::optional<LinearColor> parse_color(std::string_view text);

std::string hex_of(const LinearColor& color);

}  // namespace hydrodip
