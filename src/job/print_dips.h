// The main job for an object that is dipped several times.
#pragma once

#include "job/jobs.h"

namespace hydrodip {

// Whether the configuration asks for more than the one dip that `object` and `dip` describe.
bool asks_for_several_dips(const JobConfig& config);

// Throws InputError for a job of several dips, with why there can be but one.
void require_one_dip(const JobConfig& config, const std::string& why);

// Plans what is not given, divides the surface among the dips, and writes dip-1/print.pdf and so on
// with everything that belongs to each, and one report on the whole. As print_job otherwise.
JobResult print_dips(const JobConfig& config, const RunContext& context);

}  // namespace hydrodip
