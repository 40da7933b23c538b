// One dip of an object, and what everybody asks of it afterwards.
#pragma once

#include <memory>

#include "air/air.h"
#include "base/context.h"
#include "base/timings.h"
#include "dip/dip.h"
#include "dip/dip_history.h"
#include "object/dip_angles.h"
#include "object/posed_object.h"
#include "transfer/coverage.h"
#include "transfer/film_map.h"

namespace hydrodip {

// A value: copies share what is large, and none of it changes.
struct DippedObject {
  PosedObject posed;
  std::shared_ptr<const DippedFilm> film = {};
  DipStatistics statistics = {};
  std::shared_ptr<const DipHistory> history = {};
  std::shared_ptr<const FilmMap> map = {};
  Coverage coverage = {};
  DipAngles angles = {};
  DippingDirection direction_at = straight_down_to(0);
  std::shared_ptr<const TrappedAir> air = {};  // never null after a dip
};

// Trapped air: how it is looked for, or what an earlier dip of the object on the same way found.
struct AirSearch {
  AirOptions options = {};
  std::shared_ptr<const TrappedAir> found = {};
};

// Where film may tear and may hold, by its material.
DoubtfulStretch doubtful_stretch(const FilmMaterial& material);

// Simulates the dip of an object on film that it fits, and where it tears asks what moves then;
// `observe` sees every step. No film gets where air stays. Throws as dip().
DippedObject dip_object(const PosedObject& posed, const SharedFilmMesh& film,
                        const Trajectory& trajectory, const DipOptions& options, Timings& timings,
                        const RunContext& context, const DipObserver& observe = {},
                        const AirSearch& air = {});

// What a dip that did not ask would have found: how far its film lies elsewhere if torn film falls
// another way, per vertex, for what lay on the object at the end of this way (which may be
// shorter).
std::vector<double> moved_by_tears(const DippedFilm& dipped, const PosedObject& posed,
                                   const TrappedAir& air, const Trajectory& trajectory,
                                   const DipOptions& options, const RunContext& context);

}  // namespace hydrodip
