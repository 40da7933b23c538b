// The film in space as a sheet over the object, and the two ways between it and film coordinates
// that the paper's scheme and the simpler methods share.
#pragma once

#include <cstdint>
#include <vector>

#include "dip/scheme.h"

namespace hydrodip {

// Raises the water to the level. Seen from the object, every vertex that floats goes straight up
// with it until it meets the object; the clamped rim stays at the water. Returns for each vertex
// whether it met the object now; states are left as they are.
std::vector<std::uint8_t> rise_to(double level, const DipSetting& setting, DipState& state);

// Rest shapes of the film's triangles where they are in space, their height scaled by z_stretch
// (paper section 3.2, step 3). Triangles without any free vertex are left out.
std::vector<RestTriangle> rest_in_space(const FilmMesh& film, const std::vector<Vec3>& position,
                                        const std::vector<std::uint8_t>& is_free, double z_stretch);

// Where on the film in space, with its vertices at film coordinates u, the film coordinate of every
// free vertex is found: linear within triangles. Other vertices stay at their position.
std::vector<Vec3> mapped_back(const FilmMesh& film, const std::vector<Vec3>& position,
                              const std::vector<std::uint8_t>& is_free, const VertexVector& u);

}  // namespace hydrodip
