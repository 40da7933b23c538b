// `hydrodip studio`: a window to work in, served to the browser of this machine.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/context.h"
#include "job/jobs.h"

namespace hydrodip {

struct StudioOptions {
  std::filesystem::path file;           // a model or a job's file; empty: none
  std::string address = "127.0.0.1";    // others need a password
  int port = 0;                         // 0: the usual one, or the next that is free
  std::filesystem::path password_file;  // its first line
  std::filesystem::path profiles;       // the person's own; empty: none
  bool browser = true;                  // opens one
  std::function<void(const std::string& address)> announce;  // when it serves
};

// Serves until the context is cancelled, or the page ends it. Throws InputError.
JobResult studio_job(const StudioOptions& options, const RunContext& context);

}  // namespace hydrodip
