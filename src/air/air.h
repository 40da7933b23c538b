// Air that an object takes with it into the water: in the water's way up into a hollow that is open
// below alone. docs/model.md, "Trapped air".
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "air/section.h"
#include "base/context.h"
#include "dip/trajectory.h"
#include "object/object.h"
#include "object/surface.h"

namespace hydrodip {

inline constexpr int kLeastForAdvice = 100000;

struct AirOptions {
  // Cubes into which the space around the object is cut; 0: air is not looked for. With fewer than
  // kLeastForAdvice nobody looks for a tilt that lets the air out, which takes several times as
  // long as finding it.
  int cells = 600000;
};

// A tilt that begins with the object as it is posed; its top goes towards the direction from +x to
// +y.
struct Tilt {
  double tilt_deg = 0, toward_deg = 0;
};

// All in the posed-object frame.
struct AirPocket {
  double area_mm2 = 0;      // of the surface that water would reach but for the air
  double volume_mm3 = 0;    // of the air, when it is closed in
  double closed_at_mm = 0;  // how far the object had travelled by then (straight down: its depth)
  Plane water;              // up to which the water comes in it
  Vec3 top = Vec3::Zero();  // its highest point on the surface: where a vent lets all of it out
  // Share of the volume that gets out again while the object turns further on its way.
  double escapes_share = 0;
  // The smallest; none: no tilt up to 85 degrees does, or it was not looked for.
  std::optional<Tilt> lets_out;
};

// A small hole in the surface through which air gets out.
struct AirVent {
  Vec3 at = Vec3::Zero();
  double width_mm = 0;
  double area_mm2 = 0;  // of the surface that stays dry if the real object has no hole there
};

struct TrappedAir {
  std::vector<AirPocket> pockets;  // largest area first
  std::vector<AirVent> vents;      // likewise
  double cell_mm = 0;              // passages that are narrower may be overlooked
  // What keeps the water out: plane pieces over the pockets' mouths, as if the air were solid.
  TriangleMesh lids;
  std::vector<std::int32_t> pocket_of;  // per triangle of the object: in which it is, or -1

  double area_mm2() const;
  double volume_mm3() const;
  // Whether a point of the surface lies in trapped air.
  bool holds(int triangle, const Vec3& point) const;
};

// Along a way into the water that can be travelled (see Travel). The water's level in a pocket is
// that at which the pocket closed, in the object's frame: air is taken as incompressible, and what
// remains of it while the object turns on is taken to stay where it is. Throws Cancelled.
TrappedAir find_air(const TriangleMesh& object, const Surface& surface,
                    const Trajectory& trajectory, const AirOptions& options,
                    const RunContext& context);

}  // namespace hydrodip
