#include "film/over_edge.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hydrodip {
namespace {

// Faces that turn by more than this meet at an edge.
const double kOverEdge = std::cos(30 * std::numbers::pi / 180);
// Film that heights count for next to nothing is as if they counted for this.
constexpr double kLeastHeight = 0.1;
// Sine of the least angle between a face and the direction along which film belongs to it.
constexpr double kGrazing = 0.1;
// Sine of the angle up to which two corners are on one face, and how far from where the faces would
// meet the object's edge may be, in sides of the triangle.
constexpr double kOneFace = 0.1, kSharp = 0.1;

// False if either is not known.
bool turns(const Vec3& a, const Vec3& b) {
  return !a.isZero() && !b.isZero() && a.dot(b) < kOverEdge;
}

// The corner that lies on a face alone, if the two others lie on one.
std::optional<std::size_t> single_corner(const std::array<Vec3, 3>& normal) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &next = normal[(k + 1) % 3], &last = normal[(k + 2) % 3];
    if (!turns(next, last) && turns(normal[k], next) && turns(normal[k], last)) return k;
  }
  return std::nullopt;
}

double longest_side(const std::array<Vec3, 3>& position) {
  return std::max({(position[1] - position[0]).norm(), (position[2] - position[1]).norm(),
                   (position[0] - position[2]).norm()});
}

// Where the planes of the corners' faces meet, as near as can be to the triangle.
Vec3 meeting_point(const std::array<Vec3, 3>& position, const std::array<Vec3, 3>& normal,
                   const std::optional<std::size_t>& single) {
  const Eigen::Index planes = single ? 2 : 3;
  Eigen::MatrixX3d normals(planes, 3);
  Eigen::VectorXd heights(planes);
  for (Eigen::Index plane = 0; plane < planes; ++plane) {
    const std::size_t corner = (single.value_or(0) + std::size_t(plane)) % 3;
    normals.row(plane) = normal[corner].transpose();
    heights[plane] = normal[corner].dot(position[corner]);
  }
  const Vec3 middle = (position[0] + position[1] + position[2]) / 3;
  const Eigen::MatrixXd across = normals * normals.transpose();
  return middle + normals.transpose() * across.fullPivLu().solve(heights - normals * middle);
}

// Whether the faces that the corners lie on meet on the object.
bool meets_on_object(const std::array<Vec3, 3>& position, const std::array<Vec3, 3>& normal,
                     const std::optional<std::size_t>& single, const NearObject& is_near_object) {
  if (single) {
    const std::size_t next = (*single + 1) % 3, last = (*single + 2) % 3;
    const Vec3 side = position[last] - position[next];
    const double off = std::max(std::abs(normal[next].dot(side)), std::abs(normal[last].dot(side)));
    if (off > kOneFace * side.norm()) return false;
  }
  const double size = longest_side(position);
  const Vec3 edge = meeting_point(position, normal, single);
  return (edge - position[0]).norm() < 2 * size && is_near_object(edge, kSharp * size);
}

}  // namespace

std::optional<Vec3> direction_over_edge(const std::array<Vec3, 3>& position,
                                        const std::array<Vec3, 3>& normal, const Vec3& up,
                                        double z_stretch, const NearObject& is_near_object) {
  const auto single = single_corner(normal);
  const bool three_faces =
      turns(normal[0], normal[1]) && turns(normal[1], normal[2]) && turns(normal[2], normal[0]);
  if (!single && !three_faces) return std::nullopt;
  if (!meets_on_object(position, normal, single, is_near_object)) return std::nullopt;
  const double stretch = 1 / std::max(z_stretch, kLeastHeight) - 1;
  const auto stretched = [&](const Vec3& v) { return Vec3(v + stretch * up.dot(v) * up); };
  std::array<Vec3, 3> scaled;
  for (std::size_t k = 0; k < 3; ++k) scaled[k] = stretched(normal[k]).stableNormalized();
  Vec3 sum = scaled[0] + scaled[1] + scaled[2];
  if (single) sum = (sum - scaled[*single]).stableNormalized() + scaled[*single];
  if (!(sum.norm() > kGrazing)) return std::nullopt;
  return stretched(sum).normalized();
}

TriangleOnObject triangle_on_object(const DippedFilm& film, const std::vector<Vec3>& normal,
                                    std::size_t triangle) {
  const Triangle& v = film.mesh().triangles[triangle];
  TriangleOnObject on;
  for (std::size_t k = 0; k < 3; ++k) {
    on.position[k] = film.position[std::size_t(v[k])];
    on.normal[k] = normal[std::size_t(v[k])];
  }
  on.up = film.up.empty() ? Vec3::UnitZ() : film.up[std::size_t(v[0])];
  return on;
}

std::optional<std::array<FacePart, 2>> parts_over_edge(const std::array<Vec3, 3>& position,
                                                       const std::array<Vec3, 3>& normal,
                                                       const Vec3& direction) {
  const auto single = single_corner(normal);
  if (!single) return std::nullopt;
  const std::size_t next = (*single + 1) % 3, last = (*single + 2) % 3;
  // The single corner's face, and that of the two others.
  struct Face {
    Vec3 point, normal;
  };
  const std::array<Face, 2> faces = {Face{position[*single], normal[*single]},
                                     Face{0.5 * (position[next] + position[last]),
                                          (normal[next] + normal[last]).stableNormalized()}};
  std::array<FacePart, 2> parts;
  std::array<std::array<double, 3>, 2> way;  // along the direction to each face
  for (std::size_t f = 0; f < 2; ++f) {
    const double across = faces[f].normal.dot(direction);
    if (!(std::abs(across) > kGrazing)) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) {
      way[f][k] = faces[f].normal.dot(faces[f].point - position[k]) / across;
      parts[f].corner[k] = position[k] + way[f][k] * direction;
    }
  }
  // Linear over the triangle, and zero above the edge.
  const auto side = [&](std::size_t k) { return way[0][k] - way[1][k]; };
  const double here = side(*single), to_next = here - side(next), to_last = here - side(last);
  if (!(here * side(next) <= 0 && here * side(last) <= 0 && to_next * to_last > 0))
    return std::nullopt;
  parts[0].share = here * here / (to_next * to_last);
  parts[1].share = 1 - parts[0].share;
  return parts;
}

}  // namespace hydrodip
