// Dipped in one go, a baseline of the paper's figure 9: the film is draped over the object at once
// and slides freely on it to its energy minimum; nothing is glued before that.

#include <fmt/format.h>

#include "dip/draped_film.h"

namespace hydrodip {

namespace {

// The film is far from its minimum here, unlike between two steps of the full simulation.
constexpr int kMaxIterations = 250;
constexpr int kMaxRounds = 10;
// Share of its flat area at which a triangle is about to turn over.
constexpr double kFolding = 1e-3;

class SingleStep : public Scheme {
 public:
  SingleStep(const DipSetting& setting, DipState& state)
      : set_(setting),
        film_(setting.film),
        state_(state),
        energy_(setting.film, setting.options.modulus, setting.options.material.poisson,
                setting.options.material.law) {}

  void advance(const Moment& to) override {
    rise_to(to.level_mm, set_, state_);
    const std::vector<std::uint8_t> is_free = all_but_the_rim();
    const VertexVector u = relaxed(is_free);
    lay_down(mapped_back(film_, state_.position, is_free, u), to.level_mm);
    state_.moment = to;
  }

 private:
  std::vector<std::uint8_t> all_but_the_rim() const {
    std::vector<std::uint8_t> is_free(film_.u.size());
    for (std::size_t v = 0; v < is_free.size(); ++v)
      is_free[v] = state_.state[v] != VertexState::kClamped;
    return is_free;
  }

  // On steep objects the film would rather fold over. Where it is about to, it is held, and the
  // rest goes on to its minimum.
  VertexVector relaxed(std::vector<std::uint8_t> is_free) {
    energy_.set_rest(
        rest_in_space(film_, state_.position, is_free, set_.options.material.z_stretch));
    VertexVector u = film_.u;
    RelaxationOptions options;
    options.max_iterations = kMaxIterations;
    options.context = &set_.context;
    int held = 0;
    for (int round = 0; round < kMaxRounds; ++round) {
      state_.statistics.unconverged_steps = state_.statistics.failed_steps = 0;
      state_.statistics.largest_residual_mm = 0;
      const auto solver = set_.options.make_solver(film_);
      Relaxation relaxation(energy_, *solver);
      relax_film(relaxation, is_free, u, state_.statistics, options);
      if (state_.statistics.unconverged_steps == 0) break;
      const int folds = hold_folds(u, is_free);
      if (folds == 0) break;
      held += folds;
    }
    if (held > 0)
      set_.context.warn(fmt::format(
          "draped at once, the film folds on this object: {} of its {} vertices were held there",
          held, film_.u.size()));
    return u;
  }

  // Returns how many vertices are held from now on.
  int hold_folds(const VertexVector& u, std::vector<std::uint8_t>& is_free) const {
    int held = 0;
    for (const Triangle& t : film_.triangles) {
      const auto area = [&](const VertexVector& x) {
        const Vec2& a = x[std::size_t(t[0])];
        return cross2(x[std::size_t(t[1])] - a, x[std::size_t(t[2])] - a);
      };
      if (area(u) >= kFolding * area(film_.u)) continue;
      for (std::int32_t v : t) {
        held += is_free[std::size_t(v)];
        is_free[std::size_t(v)] = 0;
      }
    }
    return held;
  }

  // The draped film lies straight above the flat one, first on the object and else on the water.
  // So does the film that has slid on it.
  void lay_down(std::vector<Vec3> slid, double level) {
    for (Vec3& p : slid) p.z() = 0;
    state_.position.swap(slid);
    const std::vector<std::uint8_t> meets = rise_to(level, set_, state_);
    for (std::size_t v = 0; v < meets.size(); ++v)
      if (meets[v]) state_.state[v] = VertexState::kAttached;
  }

  const DipSetting set_;
  const FilmMesh& film_;
  DipState& state_;
  FilmEnergy energy_;
};

}  // namespace

std::unique_ptr<Scheme> make_single_step(const DipSetting& setting, DipState& state) {
  return std::make_unique<SingleStep>(setting, state);
}

}  // namespace hydrodip
