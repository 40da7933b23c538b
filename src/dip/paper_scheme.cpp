// The paper's four steps (section 3.2), literally: vertical rays, rest shapes from chords, the
// barycentric mapping of all vertices that are not attached.

#include <algorithm>

#include "base/parallel.h"
#include "dip/scheme.h"
#include "film/locate.h"

namespace hydrodip {

namespace {

constexpr std::size_t kGrain = 1024;

class PaperScheme : public Scheme {
 public:
  PaperScheme(const DipSetting& setting, DipState& state)
      : set_(setting),
        film_(setting.film),
        state_(state),
        energy_(setting.film, setting.options.modulus, setting.options.material.poisson),
        solver_(make_laplacian_solver()),
        attaching_(setting.film.u.size(), 0) {}

  void advance(double level) override {
    collide_and_lower(level);
    const VertexVector u = relaxed();
    map_back(u, level);
    update_labels();
    state_.level = level;
  }

 private:
  bool moves(std::size_t v) const { return state_.state[v] == VertexState::kUnattached; }

  // Steps 1 and 2: seen from the object, unattached vertices rise with the water until they meet
  // it.
  void collide_and_lower(double level) {
    parallel_for(film_.u.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        Vec3& position = state_.position[v];
        if (state_.state[v] == VertexState::kClamped) position.z() = level;
        if (!moves(v)) continue;
        const Vec3 risen(position.x(), position.y(), level);
        const auto contact = first_contact(set_.surface, position, risen);
        attaching_[v] = contact.has_value();
        position = contact ? contact->position : risen;
      }
    });
  }

  // Step 3: minimise over unattached and attaching vertices, in the metric of the film in space.
  VertexVector relaxed() {
    std::vector<RestTriangle> rest(film_.triangles.size());
    std::vector<std::uint8_t> is_free(film_.u.size());
    for (std::size_t v = 0; v < is_free.size(); ++v) is_free[v] = moves(v);
    parallel_for(rest.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const Triangle& v = film_.triangles[t];
        if (!is_free[std::size_t(v[0])] && !is_free[std::size_t(v[1])] &&
            !is_free[std::size_t(v[2])])
          continue;
        rest[t] = rest_triangle(scaled(v[0]), scaled(v[1]), scaled(v[2]));
      }
    });
    energy_.set_rest(std::move(rest));
    VertexVector u = film_.u;
    relax_film(energy_, is_free, *solver_, u, state_.statistics);
    return u;
  }

  Vec3 scaled(std::int32_t v) const {
    const Vec3& p = state_.position[std::size_t(v)];
    return {p.x(), p.y(), p.z() * set_.options.material.z_stretch};
  }

  void map_back(const VertexVector& u, double level) {
    const std::vector<std::uint8_t> everywhere(film_.triangles.size(), 1);
    std::vector<Vec3> mapped = state_.position;
    parallel_for(film_.u.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (!moves(v)) continue;
        const FilmLocation at =
            locate(film_, u, everywhere, static_cast<std::int32_t>(v), film_.u[v]);
        if (at.triangle < 0) continue;
        Vec3 place = Vec3::Zero();
        for (std::size_t k = 0; k < 3; ++k)
          place += at.weight[Eigen::Index(k)] *
                   state_.position[std::size_t(film_.triangles[std::size_t(at.triangle)][k])];
        if (!place.allFinite()) continue;
        // The film floats; an attaching vertex ends on the object, not on a chord of it.
        mapped[v] = attaching_[v] ? on_object(place) : Vec3(place.x(), place.y(), level);
      }
    });
    state_.position.swap(mapped);
  }

  Vec3 on_object(const Vec3& place) const {
    const auto hit = set_.surface.closest_point(place, 1e3);
    return hit ? set_.surface.position(*hit) : place;
  }

  // Step 4.
  void update_labels() {
    for (std::size_t v = 0; v < attaching_.size(); ++v) {
      if (attaching_[v]) state_.state[v] = VertexState::kAttached;
      attaching_[v] = 0;
    }
  }

  const DipSetting set_;
  const FilmMesh& film_;
  DipState& state_;
  FilmEnergy energy_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<std::uint8_t> attaching_;
};

}  // namespace

std::unique_ptr<Scheme> make_paper_scheme(const DipSetting& setting, DipState& state) {
  return std::make_unique<PaperScheme>(setting, state);
}

}  // namespace hydrodip
