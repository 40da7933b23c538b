// What all discretisations of the dip share: the state they advance and their interface.
#pragma once

#include <memory>
#include <vector>

#include "base/context.h"
#include "dip/dip.h"
#include "dip/travel.h"
#include "elastic/relaxation.h"

namespace hydrodip {

// Everything a scheme reads; outlives it.
struct DipSetting {
  const FilmMesh& film;
  const std::vector<Vec3>& positions;  // the object's
  const std::vector<Triangle>& triangles;
  const Surface& surface;
  const DipOptions& options;
  const Travel& travel;
  const RunContext& context;
};

// The film during the dip, in the posed-object frame: the object stands still, a plane of water
// moves through it. Floating vertices are in that plane once Scheme::write_positions() was called;
// the clamped rim's have their film coordinates, wherever the water is.
struct DipState {
  Moment moment;
  std::vector<Vec3> position;
  std::vector<VertexState> state;
  std::vector<std::uint8_t> torn;  // per triangle
  std::vector<std::uint8_t>
      lifted;                      // per vertex: attached, and out of the water again at some time
  std::vector<double> torn_at_mm;  // per triangle: travelled when it tore; infinity: not yet
  std::vector<Vec3> up;            // per vertex: upwards when it attached; empty: along z, all
  DipStatistics statistics;
};

class Scheme {
 public:
  virtual ~Scheme() = default;
  // Brings object and water to the moment, and the film to rest there.
  virtual void advance(const Moment& to) = 0;
  // To be called before anyone looks: advance() may leave floating vertices' positions behind.
  virtual void write_positions() {}
};

std::unique_ptr<Scheme> make_contact_line_scheme(const DipSetting& setting, DipState& state);
std::unique_ptr<Scheme> make_paper_scheme(const DipSetting& setting, DipState& state);
// Baselines: made for one advance() from the flat film to the final level.
std::unique_ptr<Scheme> make_projection(const DipSetting& setting, DipState& state);
std::unique_ptr<Scheme> make_single_step(const DipSetting& setting, DipState& state);

// Relaxes, and adds to the statistics.
void relax_film(Relaxation& relaxation, const std::vector<std::uint8_t>& is_free, VertexVector& u,
                DipStatistics& statistics, const RelaxationOptions& options = {});
// The second part of that.
void count(const RelaxationResult& result, const VertexVector& u, DipStatistics& statistics);

// First contact of a point moving straight from one place to another, both ends included.
struct Contact {
  Vec3 position;
  Vec3 normal;  // of the object there, unit
};
std::optional<Contact> first_contact(const Surface& surface, const Vec3& from, const Vec3& to);

// What the water has reached by a moment lies further than this below its level, for contact and
// waterline alike: flat faces often lie at exactly the level of a step, and one that counts as
// touched while no waterline goes around it, or the other way round, lays film astray. So near
// below a level none lies by chance.
inline constexpr double kReached_mm = 1.37e-5;

// Where a floating point, seen from above, first touches the object between two moments, unless it
// is something flat that the water has not reached by the second: then it does so right afterwards.
std::optional<Contact> first_touch(const Surface& surface, const Vec2& start, const Moment& from,
                                   const Vec2& end, const Moment& to);

}  // namespace hydrodip
