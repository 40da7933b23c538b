// How finely a dip is looked at.
#pragma once

#include <string>

#include "hydrodip/workspace.h"
#include "settings/config.h"

namespace hydrodip {

// A sketch is for what follows a hand: on coarser film than a draft, in longer steps, and without
// the question what depends on how torn film falls.
enum class LookQuality { kSketch, kDraft, kNormal };
// "sketch", "draft", "normal"
std::string quality_name(LookQuality quality);

// Of what the workspace makes.
Quality quality_of(LookQuality quality);
// The job as the workspace takes it; the picture of what is not normal is coarser too.
Project project_of(const JobConfig& config, LookQuality quality);
// At how many points is asked what becomes of what shall be printed.
int points_of(LookQuality quality);

}  // namespace hydrodip
