#include "studio/json_answers.h"

namespace hydrodip {

HttpAnswer json_answer(const Json& json, int status) {
  HttpAnswer answer;
  answer.status = status;
  answer.type = "application/json; charset=utf-8";
  answer.headers = {{"Cache-Control", "no-store"}};
  answer.body = text_of(json);
  return answer;
}

HttpAnswer error_answer(const ApiError& error) {
  Json inner = {{"code", error.code}, {"text", error.what()}};
  if (!error.field.empty()) inner["field"] = error.field;
  Json json;
  json["error"] = inner;
  return json_answer(json, error.status);
}

}  // namespace hydrodip
