// Which parts of a surface a projector meets, and which lie in the shadow of others.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "artwork/overhang.h"
#include "artwork/picture.h"
#include "artwork/projector.h"
#include "object/posed_object.h"

namespace hydrodip {

// Immutable once built; keeps references to both.
class Shadow {
 public:
  // Of what a frame's picture reaches. `closed`: the surface has an inside, so that what faces away
  // is never met; of an open one that side counts which is mostly met. Nor is what can be seen
  // through holes only. `through`: nothing throws a shadow.
  Shadow(const PosedObject& posed, const Projector& projector, const PictureFrame& frame,
         bool closed, bool through);

  // Whether the picture cannot reach a triangle at all.
  bool is_dark(int triangle) const { return state_of(triangle) == State::kDark; }
  // Whether it meets this point of it, at `position`.
  bool is_lit(const SurfacePoint& point, const Vec3& position) const;

 private:
  // kAsk: nothing is known yet; of small triangles all of whose corners are lit or dark, nothing
  // has to be asked, nor of those over which nothing hangs. kAskRays: every point has to be.
  enum class State : std::uint8_t { kDark, kLit, kAsk, kAskRays };

  State state_of(int triangle) const;
  State settled(int triangle) const;
  void settle_together(int triangle) const;
  State reach_of(std::size_t triangle) const;
  bool faces(double cosine) const;
  bool is_met(const Vec3& position, const Vec3& back, double cosine) const;
  int side_met() const;
  void settle_small_triangles();
  void darken_what_shows_through_holes();
  void look_for_overhangs();

  const PosedObject& posed_;
  const Projector& projector_;
  PictureFrame frame_;
  bool through_;
  double far_mm_;
  int side_ = 0;  // 1: only what faces the projector is met; -1: only what faces away; 0: both
  // Settled when first asked about; by whomever, the answer is the same.
  mutable std::vector<State> states_;
  std::optional<Overhang> overhang_;
};

// How squarely a surface faces the projector, rounded where its edges are blunt.
class Slope {
 public:
  explicit Slope(const TriangleMesh& mesh);
  Vec3 normal(const SurfacePoint& point) const;

 private:
  std::vector<std::array<Eigen::Vector3f, 3>> corners_;
};

}  // namespace hydrodip
