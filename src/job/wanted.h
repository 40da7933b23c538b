// What shall be printed, and what of it a dip brings.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "artwork/laid_layer.h"
#include "base/context.h"
#include "coat/dipped_object.h"
#include "object/paint.h"
#include "plan/targets.h"
#include "report/report.h"
#include "transfer/coverage.h"
#include "transfer/film_map.h"

namespace hydrodip {

inline constexpr int kWantedPoints = 20000;

// Looked at in about so many points of the surface. Nothing where the paint says nothing, goes by
// the film (what has no film shows nothing of it), or wants colour all over the object: coverage
// says it then. `doubtful`: of the film's material.
std::optional<ReportWanted> wanted_coverage(const DippedObject& dipped, const Paint& paint,
                                            const DoubtfulStretch& doubtful,
                                            int points = kWantedPoints);

// 1 where something shall be printed. Empty where the paint says nothing of it, or wants colour all
// over the object.
std::vector<std::uint8_t> wanted_at(const Targets& targets, const Paint& paint);
// A layer of artwork that gets no film, or hardly any.
struct DryLayer {
  std::size_t layer;
  std::string told;
};
// As far as that many places tell.
std::vector<DryLayer> dry_layers(const std::vector<LaidLayer>& layers, const Targets& targets,
                                 const std::function<bool(const Target&)>& gets_film);
// Of one dip.
std::vector<DryLayer> dry_layers(const std::vector<LaidLayer>& layers, const DippedObject& dipped,
                                 int points = kWantedPoints);
void warn_of(const std::vector<DryLayer>& layers, const RunContext& context);
// Whether film lies there of which nobody knows whether it holds, or where.
bool is_in_doubt(const std::optional<FilmMap::Hold>& hold, const DoubtfulStretch& doubtful);
// Whether a place comes into the water and faces down: a dip gets there then, whether or not film
// comes to lie. In the posed-object frame.
bool faces_film(const DippedObject& dipped, const Target& at);
// Whether a dip gets to a place of the object, in its own frame: film lies there, or it faces film.
bool is_reached(const DippedObject& dipped, const Target& node);

}  // namespace hydrodip
