// The paper's four steps (section 3.2), literally: vertical rays, rest shapes from chords, the
// barycentric mapping of all vertices that are not attached. What the paper leaves open: film that
// slides into the object attaches where it enters.

#include "base/parallel.h"
#include "dip/draped_film.h"

namespace hydrodip {

namespace {

class PaperScheme : public Scheme {
 public:
  PaperScheme(const DipSetting& setting, DipState& state)
      : set_(setting),
        film_(setting.film),
        state_(state),
        energy_(setting.film, setting.options.modulus, setting.options.material.poisson,
                setting.options.material.law),
        solver_(setting.options.make_solver(setting.film)),
        relaxation_(energy_, *solver_) {}

  void advance(const Moment& to) override {
    const double level = to.level_mm;
    // Steps 1 and 2, collide and lower.
    attaching_ = rise_to(level, set_, state_);
    const std::vector<std::uint8_t> is_free = not_glued();
    const VertexVector u = relaxed(is_free);
    slide(mapped_back(film_, state_.position, is_free, u), level);
    update_labels();
    state_.moment = to;
  }

 private:
  std::vector<std::uint8_t> not_glued() const {
    std::vector<std::uint8_t> is_free(film_.u.size());
    for (std::size_t v = 0; v < is_free.size(); ++v)
      is_free[v] = state_.state[v] == VertexState::kUnattached;
    return is_free;
  }

  // Step 3: minimise over unattached and attaching vertices, in the metric of the film in space.
  VertexVector relaxed(const std::vector<std::uint8_t>& is_free) {
    energy_.set_rest(
        rest_in_space(film_, state_.position, is_free, set_.options.material.z_stretch));
    VertexVector u = film_.u;
    relax_film(relaxation_, is_free, u, state_.statistics);
    return u;
  }

  // An attaching vertex ends on the object, not on a chord of it. The film floats, and where its
  // way through this step enters the object it attaches: on walls nothing else makes it meet it.
  void slide(const std::vector<Vec3>& mapped, double level) {
    parallel_for(mapped.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (state_.state[v] != VertexState::kUnattached) continue;
        Vec3& position = state_.position[v];
        if (attaching_[v]) {
          position = on_object(mapped[v]);
          continue;
        }
        const Vec3 before(position.x(), position.y(), state_.moment.level_mm);
        const Vec3 afloat(mapped[v].x(), mapped[v].y(), level);
        const auto contact = first_contact(set_.surface, before, afloat);
        attaching_[v] = contact.has_value();
        position = contact ? contact->position : afloat;
      }
    });
  }

  Vec3 on_object(const Vec3& place) const {
    const auto hit = set_.surface.closest_point(place, 1e3);
    return hit ? set_.surface.position(*hit) : place;
  }

  // Step 4.
  void update_labels() {
    for (std::size_t v = 0; v < attaching_.size(); ++v)
      if (attaching_[v]) state_.state[v] = VertexState::kAttached;
  }

  const DipSetting set_;
  const FilmMesh& film_;
  DipState& state_;
  FilmEnergy energy_;
  std::unique_ptr<LinearSolver> solver_;
  Relaxation relaxation_;
  std::vector<std::uint8_t> attaching_;
};

}  // namespace

std::unique_ptr<Scheme> make_paper_scheme(const DipSetting& setting, DipState& state) {
  return std::make_unique<PaperScheme>(setting, state);
}

}  // namespace hydrodip
