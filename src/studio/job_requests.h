// What is asked of one job over HTTP: docs/studio-api.md, from "A job" on.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "studio/http.h"
#include "studio/open_job.h"

namespace hydrodip {

struct JobRequest {
  HttpRequest& http;
  std::vector<std::string> parts;         // of the path, behind the job's ID
  const std::shared_ptr<OpenJob>& job;    // which a line of events keeps
  const std::filesystem::path& profiles;  // the person's own, a folder that need not be there

  // The parts from that one on, as one name.
  std::string name_from(std::size_t part) const;
};

// Throws ApiError, InputError, Cancelled.
HttpAnswer answer_job(const JobRequest& asked);

}  // namespace hydrodip
