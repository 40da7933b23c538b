// How a browser gets in: docs/studio-api.md, "Getting in".
#pragma once

#include "studio/guard.h"
#include "studio/http.h"

namespace hydrodip {

// Of "/": the page, for whom the guard knows or who brings this run's token; else what to do about
// it.
HttpAnswer enter(const Guard& guard, const HttpRequest& request);

// Of the form with the password. Throws ApiError; for a wrong password after a while.
HttpAnswer log_in(const Guard& guard, HttpRequest& request);

}  // namespace hydrodip
