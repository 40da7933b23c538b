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

}  // namespace hydrodip
