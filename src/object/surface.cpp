#include "object/surface.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <thread>
#include <type_traits>

#include "base/begun.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/run_scope.h"
#include "base/thread_supply.h"

namespace hydrodip {

namespace {

struct Closest {
  double u, v, distance_squared;
};

// Closest point of triangle (a, b, c) to p, as barycentrics of b and c: the regions of Ericson,
// "Real-Time Collision Detection", section 5.1.5.
Closest closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const auto at = [&](double u, double v) {
    return Closest{u, v, (a + u * ab + v * ac - p).squaredNorm()};
  };
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return at(0, 0);
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return at(1, 0);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(d1 / (d1 - d3), 0);
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return at(0, 1);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(0, d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return at(1 - w, w);
  }
  const double scale = 1.0 / (va + vb + vc);
  return at(vb * scale, vc * scale);
}

// One device for all surfaces of the process: it holds Embree's settings and is never changed.
// Begun by whoever comes first; never ended, for a surface may live as long as the process.
RTCDevice device() {
  static const RTCDevice shared = [] {
    threads_in_supply();
    // More threads of its user's than there are: none of its own ever helps.
    RTCDevice made = rtcNewDevice("set_affinity=0,user_threads=65536");
    if (!made && rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (!made) throw std::runtime_error("Embree cannot run on this processor");
    return made;
  }();
  return shared;
}

void add_triangles(RTCScene scene, const std::vector<Vec3>& positions,
                   const std::vector<Triangle>& triangles) {
  RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), positions.size()));
  auto* indices = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), triangles.size()));
  if (!vertices || !indices) {
    rtcReleaseGeometry(geometry);
    throw std::bad_alloc();
  }
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (int k = 0; k < 3; ++k) vertices[3 * i + std::size_t(k)] = float(positions[i][k]);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) indices[3 * i + k] = unsigned(triangles[i][k]);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

// Embree's parallel build may order triangles differently from run to run, and with it the choice
// among triangles hit exactly on their common edge. So every thread builds alone: all places in
// Embree's arena are kept for those who join (see device()), and one joins at a time.
void build(RTCScene scene) {
  static std::mutex one_at_a_time;
  std::unique_lock lock(one_at_a_time, std::defer_lock);
  while (!lock.try_lock()) {
    check_cancelled();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  bool stopped = false;
  const auto go_on = [](void* stopped, double) {
    try {
      check_cancelled();
    } catch (const Cancelled&) {
      *static_cast<bool*>(stopped) = true;
    }
    return !*static_cast<bool*>(stopped);
  };
  rtcSetSceneProgressMonitorFunction(scene, go_on, &stopped);
  rtcJoinCommitScene(scene);
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  if (stopped) throw Cancelled();
  if (rtcGetDeviceError(device()) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
}

struct Release {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release>;

Scene built_scene(const TriangleMesh& mesh) {
  Scene scene(rtcNewScene(device()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  if (!mesh.triangles.empty()) add_triangles(scene.get(), mesh.positions, mesh.triangles);
  build(scene.get());
  return scene;
}

// A tree for so many triangles takes a millisecond.
constexpr std::size_t kWorthAThread = 4000;

RTCRay ray_of(const Vec3& origin, const Vec3& direction, double t_min, double t_max) {
  RTCRay ray{};
  // Embree wants t >= 0: start at t_min and shift.
  const Vec3 start = origin + t_min * direction;
  ray.org_x = float(start.x());
  ray.org_y = float(start.y());
  ray.org_z = float(start.z());
  ray.dir_x = float(direction.x());
  ray.dir_y = float(direction.y());
  ray.dir_z = float(direction.z());
  ray.tnear = 0;
  ray.tfar = float(t_max - t_min);
  ray.mask = ~0u;
  return ray;
}

// Embree ends the process at others.
bool can_be_traced(const RTCRay& ray) {
  constexpr float kFarthest = 1e18F;
  for (const float x : {ray.org_x, ray.org_y, ray.org_z, ray.dir_x, ray.dir_y, ray.dir_z})
    if (!(std::abs(x) < kFarthest)) return false;
  return true;
}

// Half a micron of slack: the sphere is tested in single precision.
float with_slack(double radius) { return float(radius) * 1.0001f + 5e-4f; }

RTCPointQuery query_around(const Vec3& point, double max_distance) {
  RTCPointQuery query;
  query.x = float(point.x());
  query.y = float(point.y());
  query.z = float(point.z());
  query.time = 0;
  query.radius = with_slack(max_distance);
  return query;
}

}  // namespace

struct Surface::Impl {
  std::shared_ptr<const TriangleMesh> mesh;
  mutable std::optional<Begun<Scene>> building;
  mutable std::once_flag is_built;
  mutable Scene built;

  // Waits for it. What has failed may have been cancelled with the job that made the surface:
  // others may ask it later.
  RTCScene scene() const {
    std::call_once(is_built, [&] {
      if (building) building->wait();
      built = building && !building->has_failed() ? building->take() : built_scene(*mesh);
    });
    return built.get();
  }

  const Vec3& corner(int triangle, int k) const {
    return mesh->positions[static_cast<std::size_t>(
        mesh->triangles[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(k)])];
  }
};

Surface::Surface(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles)
    : Surface(std::make_shared<const TriangleMesh>(TriangleMesh{positions, triangles})) {}

Surface::Surface(std::shared_ptr<const TriangleMesh> mesh) : impl_(std::make_unique<Impl>()) {
  impl_->mesh = std::move(mesh);
  if (impl_->mesh->triangles.size() >= kWorthAThread)
    impl_->building.emplace([mesh = impl_->mesh.get()] { return built_scene(*mesh); });
  if (!impl_->building || !impl_->building->has_begun()) impl_->scene();
}

Surface::~Surface() = default;
Surface::Surface(Surface&&) noexcept = default;
Surface& Surface::operator=(Surface&&) noexcept = default;

std::optional<SurfaceHit> Surface::first_hit(const Vec3& origin, const Vec3& direction,
                                             double t_min, double t_max) const {
  RTCRayHit ray{};
  ray.ray = ray_of(origin, direction, t_min, t_max);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  if (!can_be_traced(ray.ray)) return std::nullopt;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->scene(), &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  SurfaceHit hit;
  hit.triangle = static_cast<int>(ray.hit.primID);
  const Vec3& a = impl_->corner(hit.triangle, 0);
  const Vec3 e1 = impl_->corner(hit.triangle, 1) - a;
  const Vec3 e2 = impl_->corner(hit.triangle, 2) - a;
  // Moeller-Trumbore in double precision; Embree's own values where the ray grazes the plane.
  const Vec3 p = direction.cross(e2);
  const double determinant = e1.dot(p);
  if (std::abs(determinant) > 1e-9 * e1.norm() * e2.norm() * direction.norm()) {
    const Vec3 s = origin - a;
    const Vec3 q = s.cross(e1);
    hit.u = s.dot(p) / determinant;
    hit.v = direction.dot(q) / determinant;
    hit.t = e2.dot(q) / determinant;
  } else {
    hit.u = ray.hit.u;
    hit.v = ray.hit.v;
    hit.t = t_min + ray.ray.tfar;
  }
  hit.u = std::clamp(hit.u, 0.0, 1.0);
  hit.v = std::clamp(hit.v, 0.0, 1.0 - hit.u);
  return hit;
}

bool Surface::is_hit(const Vec3& origin, const Vec3& direction, double t_min, double t_max) const {
  RTCRay ray = ray_of(origin, direction, t_min, t_max);
  if (!can_be_traced(ray)) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(impl_->scene(), &context, &ray);
  return ray.tfar < 0;  // how Embree says so
}

std::optional<SurfaceHit> Surface::closest_point(const Vec3& point, double max_distance) const {
  struct Search {
    const Impl* impl;
    Vec3 point;
    double best_squared;
    SurfaceHit hit;
  } search{impl_.get(), point, max_distance * max_distance, {}};

  RTCPointQuery query = query_around(point, max_distance);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const auto visit = [](RTCPointQueryFunctionArguments* args) {
    auto& s = *static_cast<Search*>(args->userPtr);
    const int triangle = static_cast<int>(args->primID);
    const Closest c = closest_on_triangle(s.point, s.impl->corner(triangle, 0),
                                          s.impl->corner(triangle, 1), s.impl->corner(triangle, 2));
    // Of equally near triangles the one with the smallest index wins, in whatever order they come.
    const bool nearer =
        c.distance_squared < s.best_squared ||
        (c.distance_squared == s.best_squared && (s.hit.triangle < 0 || triangle < s.hit.triangle));
    if (!nearer) return false;
    s.best_squared = c.distance_squared;
    s.hit = {triangle, c.u, c.v, std::sqrt(c.distance_squared)};
    args->query->radius = with_slack(s.hit.t);
    return true;
  };
  rtcPointQuery(impl_->scene(), &query, &context, visit, &search);
  if (search.hit.triangle < 0) return std::nullopt;
  return search.hit;
}

void Surface::triangles_near(const Vec3& point, double max_distance,
                             std::vector<int>& triangles) const {
  triangles.clear();
  RTCPointQuery query = query_around(point, max_distance);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  const auto visit = [](RTCPointQueryFunctionArguments* args) {
    static_cast<std::vector<int>*>(args->userPtr)->push_back(static_cast<int>(args->primID));
    return false;
  };
  rtcPointQuery(impl_->scene(), &query, &context, visit, &triangles);
}

Vec3 Surface::position(const SurfaceHit& hit) const {
  return (1 - hit.u - hit.v) * impl_->corner(hit.triangle, 0) +
         hit.u * impl_->corner(hit.triangle, 1) + hit.v * impl_->corner(hit.triangle, 2);
}

Vec3 Surface::normal(const SurfaceHit& hit) const {
  const Vec3& a = impl_->corner(hit.triangle, 0);
  return (impl_->corner(hit.triangle, 1) - a)
      .cross(impl_->corner(hit.triangle, 2) - a)
      .normalized();
}

std::vector<Vec3> normals_near(const Surface& surface, const std::vector<Vec3>& points,
                               const std::vector<std::uint8_t>& wanted) {
  constexpr double kNear_mm = 1;
  std::vector<Vec3> normals(points.size(), Vec3::Zero());
  parallel_for(normals.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (!wanted[v]) continue;
      if (const auto nearest = surface.closest_point(points[v], kNear_mm))
        normals[v] = surface.normal(*nearest);
    }
  });
  return normals;
}

}  // namespace hydrodip
