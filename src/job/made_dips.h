// Several dips of one object with their ink: what the report and the pictures are made of.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/timings.h"
#include "coat/design.h"
#include "coat/finish.h"
#include "ink/printer.h"
#include "job/dip_plan.h"
#include "job/prepare.h"
#include "job/wanted.h"
#include "plan/seams.h"
#include "plan/surface_nodes.h"
#include "plan/trial.h"
#include "settings/config.h"

namespace hydrodip {

struct MadeDip {
  JobConfig config;  // of this dip alone
  Trial trial;
  FirstDip first;  // without ink, or with that which the first division gave it
  PosedObject posed;
  Designed made;       // with its ink; empty until then
  bool blank = false;  // it has no ink
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

// A correction is of one dip. Throws InputError where several would share one.
void require_no_correction(const JobConfig& config);
// Artwork that is laid on the film is of one dip as well. Throws InputError likewise.
void require_no_pattern(const Paint& paint);

// The planned dips, hung up. Throws InputError where one does not fit.
MadeDips hang_up(const JobConfig& config, const PreparedObject& prepared, const DipPlan& plan,
                 const RunContext& context);

// The surface divided by the films as they lie with ink: what tears off with it, another dip may
// do. To find them each is dipped with the ink of a division by the films without.
SharedSurface divide(MadeDips& all, const Printer& printer, Timings& times,
                     const RunContext& context);

// Each dip with its part of the ink, and what comes of all of them.
Finish make_dips(MadeDips& all, const SharedSurface& shared, const Printer& printer, Timings& times,
                 const RunContext& context);

// Of the job's layers of artwork those to which none of the dips brings film.
std::vector<DryLayer> dry_layers_of(const MadeDips& all);

}  // namespace hydrodip
