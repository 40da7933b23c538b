// What orient and plan have in common: an object and what matters on it, and a folder for the
// answer as JSON and as a picture.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/output_folder.h"
#include "job/jobs.h"
#include "job/prepare.h"
#include "plan/targets.h"

namespace hydrodip {

// Refers to configuration and context.
class SearchOutput {
 public:
  // Loads the object, and announces NAME.json, NAME.png (unless pictures are off) and `others`.
  // Throws as prepare_object, require_size, job_targets and OutputFolder::announce.
  SearchOutput(const JobConfig& config, const std::string& name,
               const std::vector<std::string>& others, const RunContext& context);

  const PreparedObject& prepared() const { return prepared_; }
  const Targets& targets() const { return targets_; }
  const JobConfig& config() const { return config_; }
  // For one of the others.
  std::filesystem::path path(const std::string& file) { return folder_.path(file); }
  const std::filesystem::path& folder() const { return folder_.folder(); }

  // Writes them, and gives everything its final name. `words`: the answer, before the warnings.
  JobResult finish(std::string json, const std::string& words, const std::function<Image()>& draw);

 private:
  const JobConfig& config_;
  const RunContext& context_;
  const std::string name_;
  OutputFolder folder_;
  const PreparedObject prepared_;
  const Targets targets_;
  std::vector<std::string> files_;
};

}  // namespace hydrodip
