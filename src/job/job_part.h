// A part of a job that has a name.
#pragma once

#include <functional>
#include <string>

#include "base/context.h"

namespace hydrodip {

// The part's progress and log are the job's, and what it warns of is told under its name: "dip 2:
// ..." Throws what `work` throws.
void do_part(const std::string& name, const RunContext& context,
             const std::function<void(const RunContext&)>& work);

}  // namespace hydrodip
