// The start of every job: the object, loaded and posed, and whether it fits film and bath.
#pragma once

#include <string>
#include <vector>

#include "base/context.h"
#include "model_io/load.h"
#include "settings/config.h"

namespace hydrodip {

// Loads config.model and brings it to the posed-object frame. Health findings become warnings.
LoadedObject load_posed(const JobConfig& config, RunContext& context);

// Throws InputError saying what is missing, and how to mend it, if the model does not say which
// colour goes where.
void require_appearance(const Object& object, const std::filesystem::path& model);

// config.object.base_color in linear light.
LinearColor base_color(const JobConfig& config);

// The way on which the object will be dipped.
Trajectory trajectory(const Object& object, const JobConfig& config);

// How deep that will take it: dip.depth_mm, or its height if that is less.
double dip_depth_mm(const Object& object, const JobConfig& config);

// Room that the dipped part of a posed object takes and has, per direction.
struct RoomFit {
  std::string what;  // "wide (x)"
  std::string room;  // "free film between the taped rims"
  double needed_mm = 0;
  double available_mm = 0;
  std::string remedy;  // "shrink it with --size 71, ..."
  double excess_mm() const { return needed_mm - available_mm; }
};

// Every direction that the job has to fit, film first. Only the part that gets wet counts.
std::vector<RoomFit> fits(const Object& posed, const JobConfig& config);

// Throws InputError for the first that does not fit, saying by how much and how to mend it. Warns
// about a sheet larger than the bath and about little film around the object.
void require_fit(const Object& posed, const JobConfig& config, RunContext& context);

}  // namespace hydrodip
