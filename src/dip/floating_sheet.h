// The film that floats, in the water plane: where it is seen from above (sinking frame), the rest
// shapes and equilibrium of its triangles, and how it slides there.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "dip/foresight.h"
#include "dip/scheme.h"
#include "elastic/film_energy.h"
#include "elastic/relaxation.h"

namespace hydrodip {

class Feet;

// In a step.
enum class When { kBefore, kAfter };

class FloatingSheet {
 public:
  FloatingSheet(const DipSetting& setting, DipState& state);

  bool floats(std::int32_t v) const {
    return state_.state[std::size_t(v)] == VertexState::kUnattached;
  }
  bool attached(std::int32_t v) const {
    return state_.state[std::size_t(v)] == VertexState::kAttached;
  }
  // A vertex seen from above, before and after it slides in this step. Attached vertices: where
  // they touched.
  Vec2 plan(std::int32_t v) const { return plan_.at(place(v)); }
  Vec2 slid(std::int32_t v) const { return slid_.at(place(v)); }

  // Whether a triangle carries load: it is not torn, and some of it floats.
  bool is_usable(std::size_t t) const { return usable_[t] != 0; }
  // Per vertex: floats and has film around it that carries load.
  const std::vector<std::uint8_t>& free_vertices() const { return is_free_; }

  // To be called after a corner of the triangle attached or it tore.
  void update_load(std::size_t t);
  // The triangle pulls no more in this step.
  void unload(std::size_t t) { energy_.set_rest(t, {}); }

  // Flat where it floats; with ghosts for corners at the contact line.
  void set_rest(const Feet& feet);
  // To be called before the film relaxes in the step that ends there.
  void foresee(double end_mm) { foresight_.foresee(end_mm, relaxation_.field()); }
  // From where the film is foreseen, or lay after the last step: it slides on as it did then.
  // Vertices that are not free have their own film coordinates.
  RelaxationResult relax(const std::vector<std::uint8_t>& is_free);
  void put_back(const std::vector<std::uint8_t>& is_free);
  // To be called once relaxed for good.
  void keep_relaxed();
  const VertexVector& relaxed() const { return relaxed_; }
  // Triangles whose largest principal stretch passes the limit in the relaxed film.
  std::vector<std::int32_t> overstretched(double limit) const {
    return energy_.overstretched(relaxation_.field(), limit);
  }
  // Every floating vertex goes where its film coordinate is found in the relaxed film.
  void slide(const Feet& feet);
  // What has slid is where it is now; these have attached meanwhile.
  void settle() { plan_.swap(slid_); }
  void attach_at(std::int32_t v, const Vec2& plan) { plan_.set(place(v), plan); }

  // The gradient du/dX beside an edge before or after sliding, mean over both sides; `otherwise` if
  // neither can say.
  Mat2 gradient_at_edge(std::int32_t a, std::int32_t b, const Mat2& otherwise, const Feet& feet,
                        When when = When::kAfter) const;
  // Whether film on either side of an edge carries load.
  bool is_usable_edge(std::int32_t a, std::int32_t b) const {
    bool usable = false;
    for_triangles_at_edge(a, b, [&](std::size_t t) { usable |= is_usable(t); });
    return usable;
  }
  template <typename Visit>
  void for_triangles_at_edge(std::int32_t a, std::int32_t b, const Visit& visit) const {
    for (auto n = film_.incident_begin[std::size_t(a)];
         n < film_.incident_begin[std::size_t(a) + 1]; ++n) {
      const auto t = std::size_t(film_.incident[std::size_t(n)]);
      const Triangle& v = film_.triangles[t];
      if (v[0] == b || v[1] == b || v[2] == b) visit(t);
    }
  }

 private:
  std::size_t place(std::int32_t v) const { return energy_.grid().place(std::size_t(v)); }
  Vec2 corner(std::size_t t, std::size_t k, const Feet& feet, When when = When::kAfter) const;
  bool carries_load(std::size_t t) const;
  RestTriangle rest_of(std::size_t t, const Feet& feet) const;
  double tolerance_mm() const;
  std::optional<Vec2> look_up(std::size_t v, const Feet& feet);
  void hold_back_folds();
  bool folds(std::size_t t) const;
  bool any_fold();
  Mat2 gradient(std::size_t t, const Feet& feet, When when) const;

  const DipOptions& options_;
  const FilmMesh& film_;
  const DipState& state_;
  FilmEnergy energy_;
  std::unique_ptr<LinearSolver> solver_;
  Relaxation relaxation_;
  // Per triangle: carries load in this step; the least rest area.
  std::vector<std::uint8_t> usable_;
  std::vector<double> smallest_area_;
  std::vector<std::uint8_t> is_free_;
  // Over the film's grid: film coordinates, and vertices seen from above, now and after relaxing.
  GridField film_at_, plan_, slid_;
  Foresight foresight_;
  VertexVector relaxed_;  // per vertex: film coordinates after relaxing
  // Per vertex: the triangle that it was last found in. Over the grid: that one's corners, and
  // whether the vertex still was inside.
  std::vector<std::int32_t> slid_in_, slid_in_corner_[3];
  std::vector<std::int64_t> found_;
  std::vector<std::uint8_t> is_plain_;  // per triangle: usable, and none of its corners attached
};

}  // namespace hydrodip
