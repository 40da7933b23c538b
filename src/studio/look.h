// What the page is shown of one dip: computed, and packed. docs/studio-api.md, "A result".
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hydrodip/workspace.h"
#include "job/dips_together.h"
#include "job/wanted.h"
#include "settings/config.h"
#include "studio/json.h"

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

// How finely a dip is looked at. A sketch is for what follows a hand: on coarser film than a draft,
// in longer steps, and without the question what depends on how torn film falls.
enum class LookQuality { kSketch, kDraft, kNormal };
// "sketch", "draft", "normal"
std::string quality_name(LookQuality quality);

// As the workspace takes it; the picture of what is not normal is coarser too.
Project project_of(const JobConfig& config, LookQuality quality);

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
// What is shown, packed; `head`: what only the job knows; files in `uploads` are called by their
// names alone.
std::vector<std::uint8_t> finish_bundle(const DipsTogether& look, Json head,
                                        const std::filesystem::path& uploads);
std::vector<std::uint8_t> result_bundle(const Look& look, Json head,
                                        const std::filesystem::path& uploads,
                                        const RunContext& context);
// Its way into the water.
std::vector<std::uint8_t> dip_bundle(const DippedObject& dipped);

}  // namespace hydrodip
