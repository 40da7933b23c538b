// Several dips of one object with their ink: what the report and the pictures are made of.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "coat/design.h"
#include "job/prepare.h"
#include "plan/surface_nodes.h"
#include "plan/trial.h"
#include "settings/config.h"

namespace hydrodip {

struct MadeDip {
  JobConfig config;  // of this dip alone
  Trial trial;
  PosedObject posed;
  Designed made;       // with its ink; empty until then
  std::string folder;  // "dip-1"
  int number = 1;
};

// Everything that the report and the pictures are made of. The coats are those of `dips`.
struct MadeDips {
  const JobConfig& config;
  const PreparedObject& prepared;
  std::vector<MadeDip> dips;
  std::shared_ptr<const SurfaceNodes> nodes;
  std::vector<std::vector<float>> worth;  // of the films as they were dipped with their ink
};

}  // namespace hydrodip
