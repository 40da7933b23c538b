// JSON as the studio speaks it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/json_text.h"

namespace hydrodip {

using Json = nlohmann::ordered_json;

// In one line; bytes that are no UTF-8 are replaced.
inline std::string text_of(const Json& json) { return json_line(json); }

}  // namespace hydrodip
