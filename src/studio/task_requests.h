// What a request for long work stands for: docs/studio-api.md, "Tasks".
#pragma once

#include <string>

#include "studio/job_document.h"
#include "studio/json.h"
#include "studio/tasks.h"

namespace hydrodip {

// "print", "orient", "plan". Throws ApiError bad-request.
std::string kind_of_task(const Json& request);

// Of that task what follows from the document; of print its job file is written and its folder
// chosen. With the document's owner's lock, and when none of that kind is running. Throws ApiError
// bad-value, bad-request, no-model; InputError if the job file finds no room.
void prepare_task(TaskRequest& task, const Json& request, const JobDocument& document);

}  // namespace hydrodip
