// Pages of the documentation's site, in Markdown.
#pragma once

#include <string>
#include <vector>

#include "describe.h"

namespace hydrodip {

std::string commands_page(const std::vector<CommandText>& commands);
std::string parameters_reference();

}  // namespace hydrodip
