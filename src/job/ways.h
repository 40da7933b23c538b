// How the pipelines look for ways to dip their object.
#pragma once

#include <optional>
#include <string>

#include "job/prepare.h"
#include "plan/search.h"
#include "report/report.h"
#include "settings/config.h"

namespace hydrodip {

// The object's surface, weighed by what matters: by plan.importance, else by the paint. Throws
// InputError for a picture that cannot be read, or a model without UVs to lay it on.
Targets job_targets(const JobConfig& config, const PreparedObject& prepared,
                    const RunContext& context);

// Trials at the job's own quality, in its way in, and at its depth unless that is looked for.
// Refers to the targets.
TrialTask job_trials(const JobConfig& config, const PreparedObject& prepared,
                     const Targets& targets);

// The best ways to hold it, dipped as finely as the job, with their films. Tells the best so far as
// progress. Throws as search_holds.
SearchResult find_holds(const JobConfig& config, const PreparedObject& prepared,
                        const Targets& targets, const RunContext& context);

// The way up of the model as it stands: object.up, or what its format says.
ModelSide way_up(const JobConfig& config);

// Puts in place what the job leaves to be found (object.rotate_deg and dip.depth_mm = auto), in the
// configuration and on the object.
void find_what_is_asked(JobConfig& config, PreparedObject& prepared, const RunContext& context);

// Whether that was the best way to hold it, as deep as is best.
bool is_best_found(const JobConfig& config);

// "lying on its -x side, 16 mm deep: 24 % of the surface covered, nothing torn"
std::string describe_trial(const Trial& trial, ModelSide up);
// "--rotate 0,90,0 --depth 16"
std::string trial_options(const Trial& trial);
// What else has to be said so that artwork stays where it is when the object is held otherwise:
// " --art-toward 0,0,1". Options say it of the topmost layer; a warning tells of others.
std::string artwork_options(const JobConfig& config, const PreparedObject& prepared,
                            const RunContext& context);

// A line for each layer that was told no place: where it lies, and what lays it elsewhere.
std::string told_places(const std::vector<LaidLayer>& layers);

// The best way that a short search finds, in words with its options, beside the figures of the dip
// that was made; empty if it is no better. `wanted`: that dip's.
std::string better_way(const JobConfig& config, const PreparedObject& prepared,
                       const DippedObject& dipped, const std::optional<ReportWanted>& wanted,
                       const RunContext& context);

}  // namespace hydrodip
