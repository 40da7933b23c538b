// Follows a dip: when each triangle of the film came to lie on the object, and when it tore. Film
// that has touched stays, so that a dip knows what every shallower one would have come to.
#pragma once

#include <limits>
#include <vector>

#include "dip/dip.h"
#include "film/film.h"

namespace hydrodip {

// Thrown through a dip that is not worth going on with.
struct TooMuchTorn {};

class DipWatch {
 public:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  // Gives up when more than `hopeless` times the flat area that lies on the object has torn.
  // Refers to the film.
  DipWatch(const SharedFilmMesh& film, double tear_stretch, double hopeless);

  // As a DipObserver. Throws TooMuchTorn if it may stop.
  void see(const Moment& moment, const std::vector<Vec3>& position,
           const std::vector<VertexState>& state, bool may_stop);
  // What the whole dip says in the end is better known than what was seen on its way.
  void take(const DippedFilm& film);
  // The film at the moment when the watch was given up.
  DippedFilm stopped_film() const;

  // The part of a dip's film that lay on the object when it had travelled that far.
  DippedFilm film_at(double travelled_mm, DippedFilm film) const;

  // Per triangle: how far the object had travelled; kNever.
  const std::vector<double>& landed_at() const { return landed_at_; }
  const std::vector<double>& torn_at() const { return torn_at_; }
  const std::vector<double>& stretch() const { return stretch_; }  // largest principal, when landed
  // Of those that landed: which share is torn all the same, or not promised.
  const std::vector<double>& torn_share() const { return torn_share_; }
  const std::vector<double>& flat_mm2() const { return flat_mm2_; }

 private:
  double stretch_of(std::size_t triangle, const std::vector<Vec3>& position) const;

  struct Stopped {
    std::vector<Vec3> position;
    std::vector<VertexState> state;
    double depth_mm = 0;
  };

  SharedFilmMesh film_;
  double limit_, hopeless_;
  std::vector<double> attached_at_;  // per vertex
  std::vector<double> landed_at_, torn_at_, stretch_, torn_share_, flat_mm2_;
  double landed_mm2_ = 0, torn_mm2_ = 0;
  Stopped stopped_;
};

}  // namespace hydrodip
