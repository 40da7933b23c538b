#include "object/health.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "base/disjoint_sets.h"
#include "object/dropped_faces.h"
#include "object/edges.h"
#include "object/orientation.h"
#include "object/small_holes.h"
#include "object/weld.h"

namespace hydrodip {

namespace {

// Of a surface whose area is more than that in one direction there is no inside.
constexpr double kSheet = 0.9;

void count_edges(const Object& object, const std::vector<TriangleSide>& sides, MeshHealth& health) {
  DisjointSets rims(object.positions.size());
  for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin > 2) ++health.nonmanifold_edges;
    if (end - begin != 1) return;
    ++health.boundary_edges;
    rims.join(sides[begin].low_vertex(), sides[begin].high_vertex());
  });
  for (const std::int32_t vertex : rim_vertices(sides))
    health.holes += rims.is_root(std::size_t(vertex));
}

long count_shells(const Object& object) {
  DisjointSets sets(object.positions.size());
  for (const Triangle& t : object.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[1], t[2]);
  }
  long shells = 0;  // welding left no unused position
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    shells += sets.is_root(i);
  }
  return shells;
}

void measure_mesh(const Object& object, MeshHealth& health) {
  const Box3 box = object.bounds();
  const Vec3 origin = box.center();
  Vec3 directed_mm2 = Vec3::Zero();  // 0 of a closed surface
  for (std::size_t f = 0; f < object.triangles.size(); ++f) {
    const Triangle& t = object.triangles[f];
    const Vec3& a = object.positions[std::size_t(t[0])];
    const Vec3 area =
        0.5 *
        (object.positions[std::size_t(t[1])] - a).cross(object.positions[std::size_t(t[2])] - a);
    directed_mm2 += area;
    health.area_mm2 += area.norm();
    health.volume_mm3 += volume6(object, f, origin) / 6;
  }
  // The volume of what is open depends on the origin: it is sure if all of the box agree.
  if (!health.closed())
    health.inside_out = directed_mm2.norm() < kSheet * health.area_mm2 &&
                        health.volume_mm3 + directed_mm2.cwiseAbs().dot(box.size()) / 6 < 0;
  health.vertices = long(object.positions.size());
  health.triangles = long(object.triangles.size());
}

std::string counted(long count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace

std::vector<std::string> MeshHealth::findings() const {
  std::vector<std::string> out;
  if (degenerate_removed > 0) {
    out.push_back(fmt::format("Removed {} without area.",
                              counted(degenerate_removed, "triangle", "triangles")));
  }
  if (duplicates_removed > 0) {
    out.push_back(
        fmt::format("Removed {} there already.",
                    counted(duplicates_removed, "triangle that was", "triangles that were")));
  }
  if (flipped > 0) {
    out.push_back(fmt::format("Turned over {} that faced the wrong way.",
                              counted(flipped, "triangle", "triangles")));
  }
  if (holes_closed > 0) {
    out.push_back(fmt::format(
        "Closed {} smaller than 0.3 % of the object, so that the film does not tear there.",
        counted(holes_closed, "hole", "holes")));
  }
  if (boundary_edges > 0) {
    out.push_back(fmt::format("The surface has {} ({}); it is dipped as it is, open.",
                              counted(holes, "hole", "holes"),
                              counted(boundary_edges, "open edge", "open edges")));
  }
  if (inside_out) {
    out.push_back(
        fmt::format("The surface is open and {}, so that no film stays on its outside: {}.",
                    kLooksInwards, kTurnNormals));
  }
  if (nonmanifold_edges > 0) {
    out.push_back(
        fmt::format("At {} more than two triangles meet; inner walls are ignored where "
                    "the film cannot reach them.",
                    counted(nonmanifold_edges, "edge", "edges")));
  }
  if (one_sided_edges > 0) {
    out.push_back(
        fmt::format("The surface is one-sided like a Moebius strip at {}, so its outside "
                    "is undefined there.",
                    counted(one_sided_edges, "edge", "edges")));
  }
  if (shells > 1) {
    out.push_back(fmt::format("The model consists of {} separate shells.", shells));
  }
  return out;
}

MeshHealth check_and_repair(Object& object) {
  MeshHealth health;
  weld(object);
  health.degenerate_removed = drop_collapsed(object);
  std::vector<BackToBack> backs;
  health.duplicates_removed = drop_duplicates(object, backs);
  {
    std::vector<TriangleSide> sides = sorted_sides(object);
    if (close_seams(object, sides)) sides = sorted_sides(object);
    health.holes_closed = close_small_holes(object, sides);
    if (health.holes_closed > 0) sides = sorted_sides(object);
    count_edges(object, sides, health);
    const Orientation done = orient_faces(object, sides);
    health.flipped = done.flipped;
    health.one_sided_edges = done.one_sided_edges;
    show_outer(object, backs);
  }
  health.degenerate_removed += drop_slivers(object);
  weld(object);  // positions that only dropped faces used
  health.shells = count_shells(object);
  measure_mesh(object, health);
  return health;
}

}  // namespace hydrodip
