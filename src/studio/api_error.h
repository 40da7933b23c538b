// What the studio's interface says no to: docs/studio-api.md.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace hydrodip {

struct ApiError : std::runtime_error {
  ApiError(int http_status, std::string name, const std::string& sentence,
           std::string value_name = "")
      : std::runtime_error(sentence),
        status(http_status),
        code(std::move(name)),
        field(std::move(value_name)) {}

  int status;
  std::string code;   // "no-token"
  std::string field;  // "object.size_mm", where a value of the document is at fault
};

inline ApiError not_found() { return {404, "not-found", "There is nothing of that name here."}; }

inline ApiError no_such_job() {
  return {404, "not-found", "There is no such job any more; begin a new one."};
}

}  // namespace hydrodip
