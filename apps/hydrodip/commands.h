// The table of sub-commands.
#pragma once

#include <string>
#include <vector>

#include "base/context.h"
#include "job/jobs.h"
#include "request.h"

namespace hydrodip {

struct Command {
  std::string name;
  std::string summary;  // one line
  std::string details;  // shown below the options; may be empty
  void (*declare)(CLI::App& app, Request& request);
  JobResult (*run)(const Request& request, const RunContext& context);
  std::vector<std::string> words = {};  // one of which the first argument has to be; none: any text
  // As a usage line has them: "[MODEL]", "PHOTO JOB_DIR"; "": all that it takes, each needed.
  std::string operands = {};
};

const std::vector<Command>& commands();

}  // namespace hydrodip
