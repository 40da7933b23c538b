// Models that studios are given.
#pragma once

#include <string>

namespace hydrodip {

// An STL of 40 x 40 x 20 mm.
inline const std::string kTetrahedron =
    "solid a\n"
    "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 40 0\nvertex 40 0 "
    "0\nendloop\nendfacet\n"
    "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 40 0 0\nvertex 0 0 "
    "20\nendloop\nendfacet\n"
    "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 20\nvertex 0 40 "
    "0\nendloop\nendfacet\n"
    "facet normal 1 1 1\nouter loop\nvertex 40 0 0\nvertex 0 40 0\nvertex 0 0 "
    "20\nendloop\nendfacet\n"
    "endsolid\n";

// An OBJ of 30 x 30 x 30 mm, red by its toy.mtl: there is something to print of it.
inline const std::string kRedToy =
    "mtllib toy.mtl\nv 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 30\nusemtl red\n"
    "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
inline const std::string kRed = "newmtl red\nKd 1 0 0\n";

}  // namespace hydrodip
