// A job as the page has it: the job file as JSON. docs/studio-api.md.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "settings/config.h"
#include "studio/job_files.h"
#include "studio/json.h"

namespace hydrodip {

inline constexpr std::size_t kLargestDocument = std::size_t(1) << 20U;
inline constexpr std::size_t kLongestName = 200;  // of a job, in bytes

// The configuration that a document stands for, checked as a job file is. Throws ApiError
// bad-value, with the field.
JobConfig config_of(const Json& document, const JobFiles& files);

// What of a configuration differs from the defaults. Files that it names become the job's. Throws
// InputError for what the studio has no room for (several parts).
Json document_of(const JobConfig& config, JobFiles& files);

// Values of these parameters in groups, as a patch. Files that they name become the job's.
Json values_of(const JobConfig& config, const std::vector<std::string>& names, JobFiles& files);

// Whether a parameter is of the run or the machine (run, stage, output), and not of the job.
bool is_of_the_machine(const std::string& name);

// What of a configuration belongs to the machine and not to the document (stage, run, output), by
// parameter: kept beside the document, so that the job's file says it again.
Json machine_values_of(const JobConfig& config);
// Throws ApiError bad-value.
void apply_machine_values(const Json& values, JobConfig& config);

// Shows every file that a job names besides its model: it may be named otherwise.
void each_side_file(JobConfig& config, const std::function<void(std::filesystem::path&)>& visit);

// The document's name, or else that of its model.
std::string name_of_job(const Json& document);

}  // namespace hydrodip
