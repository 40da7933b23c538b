// What all discretisations of the dip share: the state they advance and their interface.
#pragma once

#include <memory>
#include <vector>

#include "base/context.h"
#include "dip/dip.h"
#include "elastic/relaxation.h"

namespace hydrodip {

// Everything a scheme reads; outlives it.
struct DipSetting {
  const FilmMesh& film;
  const std::vector<Vec3>& positions;  // the object's
  const std::vector<Triangle>& triangles;
  const Surface& surface;
  const DipOptions& options;
  RunContext& context;
};

// The film during the dip. The object stands still, the water rises. Floating vertices have
// position.z() == level, once Scheme::write_positions() was called.
struct DipState {
  double level = 0;
  std::vector<Vec3> position;
  std::vector<VertexState> state;
  std::vector<std::uint8_t> torn;  // per triangle
  std::vector<double> tear_level;  // per triangle: when it tore; infinity: not yet
  DipStatistics statistics;
};

class Scheme {
 public:
  virtual ~Scheme() = default;
  // Raises the water to the level and brings the film to rest there.
  virtual void advance(double level) = 0;
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

}  // namespace hydrodip
