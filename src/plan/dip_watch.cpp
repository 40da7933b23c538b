#include "plan/dip_watch.h"

#include <algorithm>
#include <cmath>

#include "dip/principal_stretch.h"

namespace hydrodip {
namespace {

// Nothing is given up before the first touch is well over.
constexpr double kFirstTouch_mm = 2;

}  // namespace

DipWatch::DipWatch(const SharedFilmMesh& film, double tear_stretch, double hopeless)
    : film_(film),
      limit_(tear_stretch),
      hopeless_(hopeless),
      attached_at_(film->u.size(), kNever),
      landed_at_(film->triangles.size(), kNever),
      torn_at_(film->triangles.size(), kNever),
      stretch_(film->triangles.size(), 1),
      torn_share_(film->triangles.size(), 0),
      flat_mm2_(film->triangles.size(), 0) {
  for (std::size_t t = 0; t < film->triangles.size(); ++t) {
    const Triangle& v = film->triangles[t];
    const Vec2& a = film->u[std::size_t(v[0])];
    flat_mm2_[t] =
        0.5 * std::abs(cross2(film->u[std::size_t(v[1])] - a, film->u[std::size_t(v[2])] - a));
  }
}

void DipWatch::see(const Moment& moment, const std::vector<Vec3>& position,
                   const std::vector<VertexState>& state, bool may_stop) {
  for (std::size_t v = 0; v < state.size(); ++v)
    if (state[v] == VertexState::kAttached)
      attached_at_[v] = std::min(attached_at_[v], moment.travelled_mm);
  for (std::size_t t = 0; t < landed_at_.size(); ++t) {
    if (landed_at_[t] < kNever || torn_at_[t] < kNever) continue;
    int attached = 0;
    for (const std::int32_t v : film_->triangles[t])
      attached += state[std::size_t(v)] == VertexState::kAttached ? 1 : 0;
    if (attached == 0) continue;
    stretch_[t] = stretch_of(t, position);
    if (limit_ > 0 && stretch_[t] > limit_) {
      torn_at_[t] = moment.travelled_mm;
      torn_mm2_ += flat_mm2_[t];
    } else if (attached == 3) {
      landed_at_[t] = moment.travelled_mm;
      landed_mm2_ += flat_mm2_[t];
    }
  }
  if (may_stop && torn_mm2_ > hopeless_ * landed_mm2_ && moment.travelled_mm > kFirstTouch_mm) {
    stopped_ = {position, state, moment.travelled_mm};
    throw TooMuchTorn();
  }
}

void DipWatch::take(const DippedFilm& film) {
  for (std::size_t v = 0; v < attached_at_.size(); ++v)
    attached_at_[v] =
        film.state[v] == VertexState::kAttached ? std::min(attached_at_[v], film.depth_mm) : kNever;
  for (std::size_t t = 0; t < landed_at_.size(); ++t) {
    double laid_at = 0;  // all of it; kNever: it is not
    for (const std::int32_t v : film_->triangles[t])
      laid_at = std::max(laid_at, attached_at_[std::size_t(v)]);
    // What was laid stretched too far is found torn when the dip ends, and was so from then on.
    torn_at_[t] = film.torn[t] ? std::min({film.torn_at_mm[t], film.depth_mm, laid_at}) : kNever;
    landed_at_[t] = film.lies_on_object(t) ? laid_at : kNever;
    torn_share_[t] = 0;
    if (!(landed_at_[t] < kNever)) continue;
    stretch_[t] = stretch_of(t, film.position);
    torn_share_[t] = 1 - film.whole_part(t).share;
  }
}

DippedFilm DipWatch::stopped_film() const {
  DippedFilm film;
  film.shared_mesh = film_;
  film.position = stopped_.position;
  film.state = stopped_.state;
  film.area_ratio.assign(film.position.size(), 1);
  film.stretch.assign(film.position.size(), 1);
  film.torn_at_mm = torn_at_;
  for (const double at : torn_at_) film.torn.push_back(at < kNever);
  film.wrinkled.assign(torn_at_.size(), 0);
  film.lifted.assign(film.position.size(), 0);
  film.depth_mm = stopped_.depth_mm;
  return film;
}

DippedFilm DipWatch::film_at(double travelled_mm, DippedFilm film) const {
  for (std::size_t v = 0; v < film.state.size(); ++v)
    if (film.state[v] == VertexState::kAttached && attached_at_[v] > travelled_mm)
      film.state[v] = VertexState::kUnattached;
  for (std::size_t t = 0; t < film.torn.size(); ++t) {
    if (torn_at_[t] <= travelled_mm) continue;
    film.torn[t] = 0;
    film.torn_at_mm[t] = kNever;
  }
  film.depth_mm = std::min(film.depth_mm, travelled_mm);
  return film;
}

double DipWatch::stretch_of(std::size_t triangle, const std::vector<Vec3>& position) const {
  const Triangle& t = film_->triangles[triangle];
  const auto u = [&](std::size_t k) { return film_->u[std::size_t(t[k])]; };
  const auto x = [&](std::size_t k) { return position[std::size_t(t[k])]; };
  return principal_stretches({u(0), u(1), u(2)}, {x(0), x(1), x(2)}).largest;
}

}  // namespace hydrodip
