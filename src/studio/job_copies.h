// A job's files, copied so that the job file that lies among them finds them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/context.h"
#include "job/jobs.h"

namespace hydrodip {

// A name for a file from what a person calls a job.
std::string file_name_of(const std::string& job_name);

// What the job has in `uploads` is copied into the folder beside its job file: nobody would look
// for it in the studio's own folder, which goes with the job. A file of the same name and other
// content stays; then the copy gets another name. `config` names the copies. Throws InputError,
// Cancelled.
void bring_along(JobConfig& config, const std::filesystem::path& uploads,
                 const std::filesystem::path& folder, const RunContext& context);

// Everything that the job needs, as NAME.zip in the folder, which is made anew. `parameters`: what
// the job file says beside what a document can (machine_values_of). Throws InputError, Cancelled.
std::filesystem::path pack_job(JobConfig config, const std::vector<std::string>& parameters,
                               const std::string& name, const std::filesystem::path& folder,
                               const RunContext& context);

}  // namespace hydrodip
