// JSON as the studio speaks it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace hydrodip {

using Json = nlohmann::ordered_json;

// In one line; bytes that are no UTF-8 are replaced.
inline std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace hydrodip
