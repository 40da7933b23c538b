// What print and simulate compute, before any of it is written: for their pipelines, and for who
// goes on computing with it (python/).
#pragma once

#include "base/timings.h"
#include "coat/design.h"
#include "coat/finish.h"
#include "ink/printer.h"
#include "job/prepare.h"
#include "settings/config.h"

namespace hydrodip {

// An object that fits film and bath, and everything that its dip depends on.
struct ReadyJob {
  JobConfig config;  // with what it left to be found in place
  PreparedObject prepared;
  Trajectory trajectory;
  Printer printer;
};

// To be dipped for itself, or (`to_print`) for the colours that it has then to have. Of a single
// dip. Throws InputError.
ReadyJob make_ready(const JobConfig& config, bool to_print, Timings& times,
                    const RunContext& context);

// Forward: the dip of film that carries config.film_image, or a checkerboard that shows the stretch
// and stiffens nothing.
struct SimulatedJob {
  DippedObject dipped;
  Finish finish;  // with that image on it
};
SimulatedJob simulated(const ReadyJob& job, const SharedFilmMesh& film, Timings& times,
                       const RunContext& context);

// What to print, and its dip. Of the film image that is kept which is asked for; of what comes out
// on the object the finish has the only copy. Throws InputError if nothing would be printed.
struct DesignedJob {
  Designed designed;
  Finish finish;
};
DesignedJob designed(const ReadyJob& job, const KeptImages& kept, Timings& times,
                     const RunContext& context);

}  // namespace hydrodip
