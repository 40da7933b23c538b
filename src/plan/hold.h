// Ways to hold an object over the bath: which direction of it points down, and how it is turned
// about the vertical.
#pragma once

#include <string>
#include <vector>

#include "film/film.h"
#include "object/pose.h"

namespace hydrodip {

// The pose, in whole degrees, in which `down` (of the object's frame after `base.down`, not zero)
// points down and the object is turned by turn_deg about the vertical; the rest as in `base`.
PoseOptions hold(const PoseOptions& base, const Vec3& down, double turn_deg);

// The direction that points down in a pose, as `hold` takes it; unit.
Vec3 down_of(const PoseOptions& pose);

// How to turn an object with these vertices about the vertical so that it takes the least part of
// the free film, degrees in [0, 180).
double roomiest_turn_deg(const std::vector<Vec3>& positions, const PoseOptions& pose,
                         const FilmOptions& film);

// Evenly spread unit directions: the six axes first, then what lies between them, then the others.
std::vector<Vec3> spread_directions(int count);

// `down` and its neighbours at that angle, all around it.
std::vector<Vec3> directions_around(const Vec3& down, double angle_deg, int count);

// "standing as it does", "upside down", "lying on its -x side, tilted by 20 degrees towards +z",
// where `up` is the way up of a model that stands.
std::string describe_hold(const PoseOptions& pose, ModelSide up);

// "--down -y --rotate 30,0,90": what brings it about on the command line.
std::string hold_options(const PoseOptions& pose);

}  // namespace hydrodip
