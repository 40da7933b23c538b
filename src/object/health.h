// Mesh health: what is wrong with a mesh, repaired where harmless, reported always.
#pragma once

#include <string>
#include <vector>

#include "object/object.h"

namespace hydrodip {

// What is told of a mesh that is inside out, and what mends it.
inline constexpr const char* kLooksInwards = "its faces look inwards";
inline constexpr const char* kTurnNormals = "turn their normals round in the program that made it";

struct MeshHealth {
  long vertices = 0;
  long triangles = 0;           // after repair
  long degenerate_removed = 0;  // zero area or repeated vertex
  long duplicates_removed = 0;  // same three positions as an earlier face
  long flipped = 0;             // faces turned to agree with their neighbours / to face outward
  long holes_closed = 0;        // holes too small for the film to notice, filled
  long boundary_edges = 0;      // edges with one face: holes
  long holes = 0;               // closed loops of boundary edges
  long nonmanifold_edges = 0;   // edges with more than two faces
  long one_sided_edges = 0;     // where a Moebius-like surface cannot be oriented
  long shells = 0;              // connected components (by shared positions)
  bool closed() const { return boundary_edges == 0 && nonmanifold_edges == 0; }
  double volume_mm3 = 0;  // signed volume after orientation
  double area_mm2 = 0;
  // An open shell, not a mere sheet, whose faces look inwards as a whole, wherever its holes are.
  bool inside_out = false;

  // One sentence per finding, empty for a clean mesh.
  std::vector<std::string> findings() const;
};

// Welds vertices at equal positions (attributes live at the corners, so seams stay sharp) and drops
// unused ones, removes degenerate and duplicate faces (the same three positions in any order: the
// first one stays), fills holes smaller than 0.3 % of the object (the film would bridge them, but
// the contact line would tear a whole cell there), makes orientation consistent across manifold
// edges within each shell, and turns each closed shell outward (a shell nested in another one keeps
// the sense that makes it a cavity). Open shells keep the majority orientation of the file.
// Deterministic, O(n log n). Throws Cancelled (run_scope.h).
MeshHealth check_and_repair(Object& object);

}  // namespace hydrodip
