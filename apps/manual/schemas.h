// JSON Schemas (draft 2020-12) of what is described by records: job files, and the parameters in
// reports.
#pragma once

#include <string>

namespace hydrodip {

// Of job files, configurations and profiles: TOML, read as JSON. Throws std::logic_error where the
// table of artwork's values says something that this does not know how to say.
std::string job_schema();

// Of report.json's "parameters".
std::string parameters_schema();

}  // namespace hydrodip
