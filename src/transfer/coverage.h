// What a dip amounts to, in a few numbers.
#pragma once

#include "film/film.h"
#include "object/dip_angles.h"
#include "object/object.h"
#include "object/surface.h"

namespace hydrodip {

struct Coverage {
  double object_mm2 = 0;            // the object's whole surface
  double downward_mm2 = 0;          // of it: below the dipping depth and facing down
  double covered_mm2 = 0;           // of the object: whole film lies on it
  double covered_downward_mm2 = 0;  // of downward_mm2: whole film lies on it
  // Of the object, whole or not: film that lies there may tear, or lie elsewhere if film that tears
  // falls another way. Some of it is covered, too.
  double doubtful_mm2 = 0;
  double film_on_object_mm2 = 0;  // of the flat film: lies on the object
  double torn_mm2 = 0;            // of the flat film: torn, or its place is not known
  double wrinkled_mm2 = 0;        // of the object: film lies there pressed together
  double lifted_mm2 = 0;          // of the object: film on it came out of the water again
  Vec3 lifted_at = Vec3::Zero();  // the middle of that, posed-object frame
  // Of whole film that lies on the object; means are weighted by flat area.
  double stretch_mean = 1;  // largest principal stretch
  double stretch_max = 1;
  double area_ratio_mean = 1;  // deformed over flat area
  double area_ratio_max = 1;

  double covered_share() const { return share(covered_mm2, object_mm2); }
  double covered_downward_share() const { return share(covered_downward_mm2, downward_mm2); }
  double doubtful_share() const { return share(doubtful_mm2, object_mm2); }
  // Of the film that met the object.
  double torn_share() const { return share(torn_mm2, torn_mm2 + film_on_object_mm2); }

  static double share(double part, double whole) { return whole > 0 ? part / whole : 0; }
};

// From where on to where film is doubtful: largest principal stretches. Nothing is where the second
// is 0.
struct DoubtfulStretch {
  double from = 0, to = 0;

  // 0: the film holds, and where it lies is known; 1: nothing is left of it, or nobody knows where.
  double of(double stretch, double moved_mm) const;
};

// covered_mm2 is the area of the film as it lies on the object, on both faces of an edge that it is
// laid over, which is the object's to the accuracy of the film's mesh; which way it faces there,
// the object says. Never NaN.
Coverage measure_coverage(const TriangleMesh& object, const Surface& surface,
                          const DippedFilm& film);  // straight down
Coverage measure_coverage(const TriangleMesh& object, const Surface& surface,
                          const DippedFilm& film, const DippingDirection& direction_at,
                          const DoubtfulStretch& doubtful = {});

}  // namespace hydrodip
