#include "studio/request_values.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "base/json_nesting.h"

namespace hydrodip {
namespace {

constexpr std::uintmax_t kMostJson = std::uintmax_t(2) << 20U;

}  // namespace

std::string read_text(HttpRequest& request, std::uintmax_t most) {
  std::string text;
  const auto too_large = [] {
    return ApiError(413, "too-large", "That is more than the studio takes.");
  };
  if (request.body_bytes.value_or(0) > most) throw too_large();
  bool fits = true;
  const bool whole = request.read_body([&](const char* data, std::size_t size) {
    fits = text.size() + size <= most;
    if (fits) text.append(data, size);
    return fits;
  });
  if (!fits) throw too_large();
  if (!whole) throw ApiError(400, "bad-request", "The request did not come whole.");
  return text;
}

Json read_json(HttpRequest& request) {
  const std::string text = read_text(request, kMostJson);
  if (nests_too_deeply(text))
    throw ApiError(400, "bad-request", "The request is nested too deeply.");
  Json json = text.empty() ? Json::object() : Json::parse(text, nullptr, false);
  if (!json.is_object()) throw ApiError(400, "bad-request", "The request is no JSON object.");
  return json;
}

std::optional<long> count_in(const Json& json, const char* key) {
  if (!json.contains(key)) return std::nullopt;
  const Json& value = json[key];
  constexpr std::int64_t kMost = std::int64_t(1) << 52U;
  const bool fine = value.is_number_integer() &&
                    (!value.is_number_unsigned() || value.get<std::uint64_t>() <= kMost) &&
                    value.get<std::int64_t>() >= 0;
  if (!fine)
    throw ApiError(400, "bad-request",
                   fmt::format("The request's {} is no whole number from 0.", key));
  return long(value.get<std::int64_t>());
}

std::string client_in(const std::string& name) {
  const bool fine =
      !name.empty() && name.size() <= 40 && std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '-';
      });
  if (!fine) throw ApiError(400, "bad-request", "A tab's name is letters and digits, at most 40.");
  return name;
}

std::optional<std::string> asking_client(const HttpRequest& request) {
  const auto given = request.query.find("client");
  if (given == request.query.end()) return std::nullopt;
  return client_in(given->second);
}

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t begin = 1; begin < path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    parts.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string form_value(const std::string& form, const std::string& key) {
  const std::size_t at = form.find(key + "=");
  if (at != 0) return "";
  std::string value;
  for (std::size_t i = key.size() + 1; i < form.size() && form[i] != '&'; ++i) {
    if (form[i] == '+') {
      value += ' ';
    } else if (form[i] == '%' && i + 2 < form.size()) {
      value += char(std::strtol(form.substr(i + 1, 2).c_str(), nullptr, 16));
      i += 2;
    } else {
      value += form[i];
    }
  }
  return value;
}

}  // namespace hydrodip
