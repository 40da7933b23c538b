// What the page is shown of one dip, or of all together: computed.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hydrodip/workspace.h"
#include "job/dips_together.h"
#include "job/wanted.h"
#include "settings/config.h"
#include "studio/json.h"
#include "studio/look_quality.h"

namespace hydrodip {

// A dip that cannot be shown, and what would help.
struct Problem {
  std::string code;  // "input"
  std::string text;
  Json mends = Json::array();
};

// Throws where there is a reason in it.
struct ProblemFound : std::runtime_error {
  explicit ProblemFound(Problem found)
      : std::runtime_error(found.text), problem(std::move(found)) {}
  Problem problem;
};

// The job as its dip of that number (from 0) is made.
JobConfig config_of_dip(const JobConfig& config, std::size_t dip);

struct Look {
  JobConfig config;  // of this dip
  std::size_t dip = 0, dips = 1;
  LookQuality quality = LookQuality::kDraft;
  std::shared_ptr<const Model> model;
  std::shared_ptr<const Paint> paint;
  std::vector<LaidLayer> artwork;  // each layer as it was laid
  std::vector<DryLayer> dry;       // of these; of several dips another one may bring film to them
  std::shared_ptr<const Designed> made;
  std::vector<std::string> warnings;
};

// Throws ProblemFound, Cancelled. `known`: warnings of reading the model, which is done once.
Look look_at_dip(Workspace& workspace, const JobConfig& job, std::size_t dip, LookQuality quality,
                 const std::vector<std::string>& known, const RunContext& context);

// All dips of the job together, as drafts. Throws ProblemFound, Cancelled.
DipsTogether look_at_dips(Workspace& workspace, const JobConfig& job, int texture_px,
                          const RunContext& context);

}  // namespace hydrodip
