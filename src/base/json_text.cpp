#include "base/json_text.h"

#include <nlohmann/json.hpp>

namespace hydrodip {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kAnswerSchemaVersion = 1;

std::string dump(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string json_text(const Json& json) { return dump(json, 2) + "\n"; }

std::string json_line(const Json& json) { return dump(json, -1); }

std::string json_answer(const std::string& command, const Json& members) {
  Json answer = {{"schema_version", kAnswerSchemaVersion}, {"command", command}};
  answer.update(members);
  return json_text(answer);
}

}  // namespace hydrodip
