// What a request says. Everything throws ApiError for what is not as docs/studio-api.md has it.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "studio/api_error.h"
#include "studio/http.h"
#include "studio/json.h"

namespace hydrodip {

// The body; throws too-large for more bytes.
std::string read_text(HttpRequest& request, std::uintmax_t most);
// The body, which is an object; nothing is an empty one.
Json read_json(HttpRequest& request);

template <class Value>
Value value_in(const Json& json, const char* key, const Value& otherwise) {
  try {
    return json.value(key, otherwise);
  } catch (const Json::exception&) {
    throw ApiError(400, "bad-request", fmt::format("The request's {} is of the wrong kind.", key));
  }
}

// None: not given. Fractions and what no revision or place can be are refused.
std::optional<long> count_in(const Json& json, const char* key);

// A tab's name.
std::string client_in(const std::string& name);
// The tab that asks, as the query says. None: it says nothing.
std::optional<std::string> asking_client(const HttpRequest& request);

// "/api/jobs/x" -> api, jobs, x
std::vector<std::string> parts_of(const std::string& path);

// A field of a form as a browser sends it, if it is the first; "" else.
std::string form_value(const std::string& form, const std::string& key);

}  // namespace hydrodip
