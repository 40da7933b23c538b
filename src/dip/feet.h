// All feet: how they climb the object, what film they lay down behind them, and where their ghosts
// are for the film that floats.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "dip/floating_sheet.h"
#include "dip/foot.h"
#include "dip/line_search.h"

namespace hydrodip {

// A vertex that attaches in this step.
struct Touch {
  std::int32_t vertex;
  Contact contact;
};

class Feet {
 public:
  Feet(const DipSetting& setting, DipState& state)
      : set_(setting),
        film_(setting.film),
        state_(state),
        feet_of_corner_(3 * setting.film.triangles.size(), {-1, -1}),
        touches_(setting.film.u.size(), 0) {}

  // Each foot goes on to the contact line of the new moment and lays film down at the strain that
  // is to be expected.
  void climb(const FloatingSheet& sheet, const Waterline& line, const Moment& to);
  // Trapezoidal rule: the film laid in this step has the mean of the strain before and after.
  void correct(const FloatingSheet& sheet);
  // One for every edge from a vertex that attaches now to one that goes on floating, in the order
  // of the touches. To be called before anything is attached.
  std::vector<Foot> created_for(const std::vector<Touch>& touches, const FloatingSheet& sheet,
                                const Waterline& line, const Moment& to);
  // Once all have attached: feet whose edges float no more go.
  void replace(const std::vector<Foot>& created, const FloatingSheet& sheet);

  // Where a corner of a triangle is for the film that floats, at the start or end of the step, if
  // its vertex is attached and has edges there to floating ones.
  std::optional<Vec2> ghost(std::size_t t, std::size_t k, When when = When::kAfter) const {
    const auto& feet = feet_of_corner_[3 * t + k];
    if (feet[0] < 0) return std::nullopt;
    const auto ghost = when == When::kBefore ? &Foot::ghost_before : &Foot::ghost;
    const Vec2& first = feet_[std::size_t(feet[0])].*ghost;
    return feet[1] < 0 ? first : Vec2(0.5 * (first + feet_[std::size_t(feet[1])].*ghost));
  }
  // With attached and floating corners, ascending.
  const std::vector<std::size_t>& line_triangles() const { return line_triangles_; }
  // Of the object at the contact line, over outward run, the gentlest few left aside; of walls if
  // there is no line.
  double gentlest_rise() const;
  // How far film laid in the last step would lie elsewhere at the strain that was expected of it,
  // the worst few feet left aside; mm. What strain does besides changing evenly.
  double unforeseen_mm() const;

 private:
  // Calls work(foot) for each, side by side.
  template <class Work>
  void for_feet(const Work& work) {
    constexpr std::size_t kFeetPerTask = 32;
    parallel_for(feet_.size(), kFeetPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) work(feet_[f]);
    });
  }
  std::size_t number(const Foot& foot) const { return std::size_t(&foot - feet_.data()); }
  double z_stretch() const { return set_.options.material.z_stretch; }

  Waterline::Point next_of(const Foot& foot, const Vec3& start, const Vec2& floating,
                           const LineSearch& search, const Moment& to) const;
  bool is_reached(const Vec2& place, const Moment& to) const;
  void create(const Touch& touch, const FloatingSheet& sheet, const Waterline& line,
              const Moment& to, std::vector<Foot>& created) const;
  void index(const FloatingSheet& sheet);

  const DipSetting set_;
  const FilmMesh& film_;
  const DipState& state_;
  double last_travel_ = 0;
  std::vector<Foot> feet_;
  std::vector<double> unforeseen_mm_;  // per foot that climbed in the last step
  // Per triangle corner, if its vertex is attached: the feet of its edges to floating corners.
  std::vector<std::array<std::int32_t, 2>> feet_of_corner_;
  std::vector<std::size_t> indexed_corners_;
  std::vector<std::size_t> line_triangles_;
  std::vector<std::uint8_t> touches_;  // per vertex: attaches in this step
};

}  // namespace hydrodip
