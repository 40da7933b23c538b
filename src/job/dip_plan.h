// Several dips of one object: how each is held and how deep it goes.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "coat/dipped_object.h"
#include "job/prepare.h"
#include "plan/surface_nodes.h"
#include "plan/trial.h"
#include "settings/config.h"

namespace hydrodip {

struct PlannedDip {
  Trial trial;         // judged by the job's own dip, without its film
  DippedObject blank;  // that dip, without ink
};

struct DipPlan {
  std::vector<PlannedDip> dips;  // in the order in which they are made
  std::size_t trial_dips = 0;    // made to find them; 0: none had to be found
};

// As many dips as the job says (plan.dips, or one for each of config.dips). Those of config.dips
// that give a rotation keep it; with `again`, only those that are locked. What is not given is
// chosen, together. Throws InputError if one of the given does not fit, or none is found.
DipPlan plan_dips(const JobConfig& config, const PreparedObject& prepared, const Targets& targets,
                  bool again, const RunContext& context);

// How a dip of the job is held, if it says so; of what it leaves open, the object's own.
std::optional<PoseOptions> told_pose(const DipEntry& entry, const PoseOptions& base);
// Its way in, if it says how deep that goes.
std::optional<TrajectoryOptions> told_way(const DipEntry& entry, const TrajectoryOptions& base);

// The points at which a print of several dips divides and counts the surface.
std::shared_ptr<const SurfaceNodes> make_nodes(const PreparedObject& prepared, double overlap_mm);

// The sheet of a planned dip, with the correction of the job's dip that is held so. Throws
// InputError if the file is none.
FilmOptions film_of(const JobConfig& config, const Trial& trial);
// That correction's file; empty: none.
std::filesystem::path correction_of(const JobConfig& config, const Trial& trial);

// Of the job's dips the one that says that it is held like that, or is locked so; its place among
// them. What is its own, a lock and a correction, stays a planned dip's of that pose.
std::optional<std::size_t> dip_held_so(const JobConfig& config, const PoseOptions& pose);

// The plan's dips as the job's, everything given.
std::vector<DipEntry> entries_of(const DipPlan& plan, const JobConfig& config);

}  // namespace hydrodip
