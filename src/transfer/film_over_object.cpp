#include "transfer/film_over_object.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace hydrodip {
namespace {

// Of the object: what is kept of more takes too much memory, and each is seen in a few pixels.
constexpr std::size_t kMostTriangles = 250000;
// Of film over one: rays are as fast.
constexpr std::size_t kMostOver = 24;
// So flat against its triangle no line meets film.
constexpr double kFlattest = 1e-6;
// What floats leave out at sides, in shares of a triangle.
constexpr float kSlack = 1e-5F;

}  // namespace

float FilmOverObject::Linear::least() const { return first + std::min({0.0F, by_u, by_v}); }
float FilmOverObject::Linear::most() const { return first + std::max({0.0F, by_u, by_v}); }

FilmOverObject::FilmOverObject(const TriangleMesh& object, const TriangleMesh& film,
                               const Surface& sheet, double reach_mm)
    : object_(object),
      film_(film),
      sheet_(sheet),
      reach_mm_(reach_mm),
      found_(object.triangles.size() <= kMostTriangles ? object.triangles.size() : 0) {}

FilmOverObject::~FilmOverObject() {
  for (const auto& overs : found_) delete overs.load();
}

FilmOverObject::Nearest FilmOverObject::nearest(const SurfacePoint& point) const {
  if (found_.empty()) return {};
  const Overs& overs = over(point.triangle);
  if (overs.size() > kMostOver) return {};
  const auto u = float(point.u), v = float(point.v);
  const float far = float(reach_mm_);
  struct Side {
    const Over* over = nullptr;
    float distance_mm, u = 0, v = 0;
  };
  std::array<Side, 2> sides = {Side{nullptr, far}, Side{nullptr, far}};  // behind, ahead
  for (const Over& film : overs) {
    const float film_u = film.u.at(u, v), film_v = film.v.at(u, v);
    if (!(film_u >= -kSlack && film_v >= -kSlack && film_u + film_v <= 1 + kSlack)) continue;
    const float way_mm = film.way_mm.at(u, v), distance_mm = std::abs(way_mm);
    Side& side = sides[way_mm > 0 ? 1 : 0];
    if (distance_mm < side.distance_mm) side = {&film, distance_mm, film_u, film_v};
  }
  // Film that is met first hides what lies behind it, also where it is of no use.
  const Side* best = nullptr;
  for (const Side& side : sides)
    if (side.over && side.over->is_against && (!best || side.distance_mm < best->distance_mm))
      best = &side;
  if (!best) return {true, std::nullopt};
  const double hit_u = std::clamp(double(best->u), 0.0, 1.0);
  const double hit_v = std::clamp(double(best->v), 0.0, 1 - hit_u);
  return {true, SurfaceHit{best->over->triangle, hit_u, hit_v, double(best->distance_mm)}};
}

// Several threads may look for the same: all find the same, and the first one's stays.
const FilmOverObject::Overs& FilmOverObject::over(int object_triangle) const {
  std::atomic<const Overs*>& kept = found_[std::size_t(object_triangle)];
  if (const Overs* overs = kept.load(std::memory_order_acquire)) return *overs;
  std::unique_ptr<const Overs> found = find(object_triangle);
  const Overs* other = nullptr;
  if (kept.compare_exchange_strong(other, found.get(), std::memory_order_acq_rel))
    return *found.release();
  return *other;
}

std::unique_ptr<const FilmOverObject::Overs> FilmOverObject::find(int object_triangle) const {
  auto overs = std::make_unique<Overs>();
  const Triangle& t = object_.triangles[std::size_t(object_triangle)];
  const std::array<Vec3, 3> corner = {object_.positions[std::size_t(t[0])],
                                      object_.positions[std::size_t(t[1])],
                                      object_.positions[std::size_t(t[2])]};
  const Vec3 normal = face_normal(object_, object_triangle);
  if (normal.isZero()) return overs;
  const Vec3 middle = (corner[0] + corner[1] + corner[2]) / 3;
  double radius_mm = 0;
  for (const Vec3& c : corner) radius_mm = std::max(radius_mm, (c - middle).norm());
  std::vector<int> near;
  sheet_.triangles_near(middle, radius_mm + reach_mm_, near);
  // Of those that are equally near the first counts.
  std::sort(near.begin(), near.end());
  for (const int triangle : near) {
    const Triangle& film = film_.triangles[std::size_t(triangle)];
    const Vec3& a = film_.positions[std::size_t(film[0])];
    const Vec3 ab = film_.positions[std::size_t(film[1])] - a;
    const Vec3 ac = film_.positions[std::size_t(film[2])] - a;
    const Vec3 upwards = ab.cross(ac);
    const double squared = upwards.squaredNorm(), slope = normal.dot(upwards);
    if (!(std::abs(slope) > kFlattest * std::sqrt(squared))) continue;
    const auto linear = [](const std::array<double, 3>& at) {
      return Linear{float(at[0]), float(at[1] - at[0]), float(at[2] - at[0])};
    };
    std::array<double, 3> way_mm, u, v;
    for (std::size_t k = 0; k < 3; ++k) way_mm[k] = (a - corner[k]).dot(upwards) / slope;
    Over over{triangle, slope < 0, {}, {}, linear(way_mm)};
    if (over.way_mm.least() > float(reach_mm_) || over.way_mm.most() < -float(reach_mm_)) continue;
    const Vec3 to_u = ac.cross(upwards) / squared, to_v = upwards.cross(ab) / squared;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 met = corner[k] + way_mm[k] * normal - a;
      u[k] = met.dot(to_u);
      v[k] = met.dot(to_v);
    }
    over.u = linear(u);
    over.v = linear(v);
    const Linear rest = linear({1 - u[0] - v[0], 1 - u[1] - v[1], 1 - u[2] - v[2]});
    if (over.u.most() < -kSlack || over.v.most() < -kSlack || rest.most() < -kSlack) continue;
    overs->push_back(over);
    if (overs->size() > kMostOver) break;
  }
  overs->shrink_to_fit();
  return overs;
}

}  // namespace hydrodip
