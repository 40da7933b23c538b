#include "render/view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "base/parallel.h"
#include "object/dip_angles.h"

namespace hydrodip {
namespace {

constexpr std::size_t kMostSamples = 1200;

// Keeps every n-th patch so that few remain; patches come in mesh order, which spreads them.
std::vector<SurfacePatch> thinned(const std::vector<SurfacePatch>& patches) {
  const std::size_t stride = (patches.size() + kMostSamples - 1) / kMostSamples;
  if (stride <= 1) return patches;
  std::vector<SurfacePatch> kept;
  // An odd stride does not fall in step with the rows of a regular film grid as easily.
  for (std::size_t i = 0; i < patches.size(); i += stride | 1) kept.push_back(patches[i]);
  return kept;
}

// Film lies with its underside out: outward is against the film's own normal.
std::vector<SurfacePatch> film_patches(const DippedFilm& film) {
  std::vector<Vec3> outward(film.position.size(), Vec3::Zero());
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    const Vec3 area = area_vector(film.position, film.mesh().triangles[t]);
    for (const std::int32_t v : film.mesh().triangles[t]) outward[std::size_t(v)] -= area / 3;
  }
  std::vector<SurfacePatch> patches;
  for (std::size_t v = 0; v < outward.size(); ++v) {
    const double area = outward[v].norm();
    if (area > 0) patches.push_back({film.position[v], outward[v] / area, area});
  }
  return patches;
}

std::vector<SurfacePatch> object_patches(const TriangleMesh& object) {
  std::vector<SurfacePatch> patches;
  for (const Triangle& triangle : object.triangles) {
    const Vec3 area = area_vector(object.positions, triangle);
    if (!(area.norm() > 0)) continue;
    const Vec3 sum = object.positions[std::size_t(triangle[0])] +
                     object.positions[std::size_t(triangle[1])] +
                     object.positions[std::size_t(triangle[2])];
    patches.push_back({sum / 3, area.normalized(), area.norm()});
  }
  return patches;
}

// Those that face down, or all if none does.
std::vector<SurfacePatch> facing_down(const std::vector<SurfacePatch>& patches) {
  std::vector<SurfacePatch> down;
  std::copy_if(patches.begin(), patches.end(), std::back_inserter(down),
               [](const SurfacePatch& patch) { return faces_down(dip_angle_deg(patch.normal)); });
  return down.empty() ? patches : down;
}

struct Candidate {
  Vec3 direction;
  double liking;  // 1: a view that people find natural; a little less: odd
};

Vec3 turntable(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kDegree;
  const double e = elevation_deg * kDegree;
  return {std::sin(a) * std::cos(e), std::sin(e), -std::cos(a) * std::cos(e)};
}

// Turns y up and -z front into what stands.
Mat3 turn_of(const Standing& standing) {
  Mat3 turn;
  turn.col(0) = standing.front.cross(standing.up);
  turn.col(1) = standing.up;
  turn.col(2) = -standing.front;
  return turn;
}

std::vector<Candidate> candidates(const Standing& standing) {
  const Mat3 placed = turn_of(standing);
  std::vector<Candidate> result;
  for (const double elevation : {12.0, 30.0, -15.0, 50.0, -40.0, 72.0, -68.0}) {
    for (int turn = 0; turn < 24; ++turn) {
      const double azimuth = turn <= 12 ? 15.0 * turn : 15.0 * turn - 360;
      // Views from under the chin or onto the crown are odd; so, a little, is the back.
      const double tilt = elevation < 0 ? 0.10 - elevation / 150 : std::abs(elevation - 12) / 180;
      const double oddness = tilt + 0.1 * std::abs(azimuth) / 180;
      result.push_back({placed * turntable(azimuth, elevation), 1 - oddness});
    }
  }
  return result;
}

// How well each patch shows from each direction: 0 hidden, 1 seen nearly face on.
std::vector<std::vector<float>> clarity(const std::vector<SurfacePatch>& patches,
                                        const std::vector<Candidate>& views, const Surface& surface,
                                        double extent) {
  std::vector<std::vector<float>> result(views.size(), std::vector<float>(patches.size(), 0));
  parallel_for(views.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < patches.size(); ++k) {
        const double cosine = patches[k].normal.dot(views[i].direction);
        if (cosine <= 0.05) continue;
        const Vec3 origin = patches[k].position + 0.004 * extent * patches[k].normal;
        if (surface.is_hit(origin, views[i].direction, 0, 4 * extent)) continue;
        result[i][k] = float(std::min(1.0, cosine / 0.7));
      }
    }
  });
  return result;
}

std::size_t best_view(const std::vector<Candidate>& views,
                      const std::vector<std::vector<float>>& clear,
                      const std::vector<SurfacePatch>& patches, const std::vector<float>& already) {
  std::size_t best = 0;
  double best_score = -1;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].liking <= 0) continue;
    double score = 0;
    for (std::size_t k = 0; k < patches.size(); ++k) {
      // A little for what shows anyway: a view of nothing but the last hidden corner tells nothing.
      const float news = std::max(0.0f, clear[i][k] - already[k]);
      score += patches[k].area * (news + 0.15 * clear[i][k]);
    }
    score *= views[i].liking;
    if (score > best_score * (1 + 1e-9)) {
      best_score = score;
      best = i;
    }
  }
  return best;
}

double extent_of(const TriangleMesh& object) {
  const Box3 box = object.bounds();
  return box.empty() ? 1 : std::max(1e-9, box.size().norm());
}

std::array<Vec3, 2> most_telling(const std::vector<SurfacePatch>& all, const Surface& surface,
                                 double extent, const Standing& standing) {
  const std::vector<SurfacePatch> patches = thinned(all);
  const std::vector<Candidate> views = candidates(standing);
  const auto clear = clarity(patches, views, surface, extent);
  const std::vector<float> nothing(patches.size(), 0);
  const std::size_t first = best_view(views, clear, patches, nothing);
  std::vector<Candidate> others = views;
  for (Candidate& view : others) {  // two pictures of nearly the same side would teach nothing
    if (view.direction.dot(views[first].direction) > std::cos(35 * kDegree)) view.liking = 0;
  }
  const std::size_t second = best_view(others, clear, patches, clear[first]);
  return {views[first].direction, others[second].direction};
}

// Axes of the screen for a direction of view.
void aim(Camera& camera, const Vec3& direction, const Standing& standing) {
  camera.back = direction.normalized();
  const double above = camera.back.dot(standing.up);
  Vec3 up = standing.up - above * camera.back;
  // Straight from above or below the front stays on the near side.
  if (up.norm() < 1e-3) up = above > 0 ? Vec3(-standing.front) : standing.front;
  camera.up = (up - up.dot(camera.back) * camera.back).normalized();
  camera.right = camera.up.cross(camera.back);
}

Box3 in_camera(const TriangleMesh& object, const Camera& camera) {
  Box3 box;
  for (const Vec3& p : object.positions) {
    box.add({p.dot(camera.right), p.dot(camera.up), p.dot(camera.back)});
  }
  return box;
}

}  // namespace

Standing standing_of(const PosedObject& posed, ModelSide up) {
  const auto direction = [&](int axis, double sign) {
    return Vec3(sign * posed.matrix().col(axis).head<3>().normalized());
  };
  const int axis = int(up) / 2;
  return {direction(axis, int(up) % 2 == 0 ? -1 : 1), direction(axis == 1 ? 2 : 1, -1)};
}

std::array<Vec3, 2> telling_directions(const TriangleMesh& object, const Surface& surface,
                                       const DippedFilm& film, const Standing& standing) {
  std::vector<SurfacePatch> patches = film_patches(film);
  if (patches.empty()) patches = facing_down(object_patches(object));
  return most_telling(patches, surface, extent_of(object), standing);
}

std::array<Vec3, 2> telling_directions(const TriangleMesh& object, const Surface& surface,
                                       const std::vector<SurfacePatch>& patches,
                                       const Standing& standing) {
  return most_telling(patches, surface, extent_of(object), standing);
}

Vec3 Camera::ray(double x, double y) const {
  return x * half_width * right + (y * half_height + shift_y) * up - back;
}

double projected_aspect(const TriangleMesh& object, const Vec3& direction,
                        const Standing& standing) {
  Camera camera;
  aim(camera, direction, standing);
  const Vec3 size = in_camera(object, camera).size();
  return std::clamp(size.x() / std::max(size.y(), 1e-9), 1e-3, 1e3);
}

Camera frame_object(const TriangleMesh& object, const Vec3& direction, double aspect, double fill,
                    const Standing& standing) {
  constexpr double kHalfFieldDeg = 9;
  Camera camera;
  aim(camera, direction, standing);
  const double half = std::tan(kHalfFieldDeg * kDegree);
  camera.half_width = aspect >= 1 ? half : half * aspect;
  camera.half_height = camera.half_width / aspect;

  const Vec3 center = in_camera(object, camera).center();
  double distance = 1e-6;
  for (const Vec3& p : object.positions) {
    const Vec3 q = Vec3(p.dot(camera.right), p.dot(camera.up), p.dot(camera.back)) - center;
    distance = std::max({distance, std::abs(q.x()) / (fill * camera.half_width) + q.z(),
                         std::abs(q.y()) / (fill * camera.half_height) + q.z()});
  }
  camera.eye =
      center.x() * camera.right + center.y() * camera.up + (center.z() + distance) * camera.back;
  return camera;
}

}  // namespace hydrodip
