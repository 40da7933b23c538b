// Which dip does which part of the object, and how their inks fade into each other.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/context.h"
#include "object/paint.h"
#include "object/surface.h"
#include "plan/nearest_node.h"
#include "plan/surface_nodes.h"
#include "transfer/allotment.h"

namespace hydrodip {

struct SeamTask {
  std::shared_ptr<const SurfaceNodes> nodes;  // in the object's own frame
  std::vector<std::vector<float>> worth;      // per dip, per node: of its film there; 0: none
  const Paint& paint;
  const Surface& surface;  // of the object in that frame
  double scale = 1;        // millimetres over the frame's unit
  double overlap_mm = 2;   // how wide neighbours fade into each other
};

// The object's surface divided among dips. A value; copies share it.
class SharedSurface {
 public:
  // Seams go where they are seen least: where little ink lies, in hollows and hidden places, and
  // short. Film that is stretched much is avoided, and so are the borders of each film. Throws
  // Cancelled.
  SharedSurface(const SeamTask& task, const RunContext& context);

  std::size_t dips() const { return data_->worth.size(); }
  const SurfaceNodes& nodes() const { return *data_->nodes; }
  // Per node.
  const std::vector<std::uint8_t>& dip_of() const { return data_->dip_of; }

  // Which part of its ink a point gets from each dip: they add up to 1 wherever any film lies, and
  // none comes from a dip whose film does not lie there.
  std::vector<float> shares_at(const Vec3& position, const Vec3& normal) const;
  // The same as each dip sees it; `mesh`: the object's, in its own frame.
  std::vector<Allotment> allotments(std::shared_ptr<const TriangleMesh> mesh) const;

  // Nodes in whose ink more than one dip has a part.
  std::vector<std::int32_t> seam_nodes() const;
  // About how long all seams are.
  double seam_mm() const { return data_->seam_mm; }
  // Per dip: of the surface, where it does the most.
  std::vector<double> shares_of_surface() const;

 private:
  struct Data {
    std::shared_ptr<const SurfaceNodes> nodes;
    std::vector<std::vector<float>> worth;
    std::vector<std::vector<float>> inside;  // per dip, per node: 0 at its film's border, 1 well in
    std::vector<std::uint8_t> dip_of;
    NearestNode nearest_of_all;
    std::vector<NearestNode> nearest;   // per dip: of its part
    std::vector<std::uint8_t> at_seam;  // another dip's node is near
    double overlap = 2;                 // in the frame's unit
    double seam_mm = 0;
  };
  // Where a point is: the node nearest to it (-1: none is near), how far, and that one's dip;
  // `alone`: no other dip has a part in its ink.
  struct Place {
    std::int32_t nearest;
    double squared;
    std::size_t dip;
    bool alone;
  };
  class Triangles;
  Place place_of(const Vec3& position, const Vec3& normal) const;
  // Dips whose bit in `near` is not set lie too far away.
  std::vector<float> faded_at(const Place& place, const Vec3& position, const Vec3& normal,
                              std::uint32_t near) const;

  std::shared_ptr<const Data> data_;
};

}  // namespace hydrodip
