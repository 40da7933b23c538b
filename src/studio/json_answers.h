// Answers in JSON, and errors as docs/studio-api.md has them.
#pragma once

#include "studio/api_error.h"
#include "studio/http.h"
#include "studio/json.h"

namespace hydrodip {

HttpAnswer json_answer(const Json& json, int status = 200);
HttpAnswer error_answer(const ApiError& error);

}  // namespace hydrodip
