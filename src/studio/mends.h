// What would help: changes of the document that a button makes. docs/studio-api.md, MEND.
#pragma once

#include "settings/config.h"
#include "studio/json.h"

namespace hydrodip {

// For an object that does not fit film or bath: a larger sheet, a smaller object, less depth; no
// shift, if that is all.
Json room_mends(const JobConfig& config, const PosedObject& posed);

// How it does not fit, in one sentence; empty if it does.
std::string misfit(const JobConfig& config, const TriangleMesh& posed);

// Other ways to hold it: a task, and not a change.
Json orient_mend();

// For a job that leaves it to the program how the object is held and how deep it goes: a task, or
// as it stands and whole.
Json auto_mends();

// For film that tears: the depth up to which nothing does, and other ways to hold the object.
Json tear_mends(const JobConfig& config, const DippedFilm& film);

// For air that stays.
Json air_mends(const TrappedAir& air);

// For an object of a size that nobody dips.
Json size_mends();

}  // namespace hydrodip
