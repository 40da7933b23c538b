#include "render/lit_pixels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.h"

namespace hydrodip {
namespace {

// Each pixel of a 4 x 4 block casts its own few rays of one common set; the filter afterwards
// gathers the whole set at every pixel.
constexpr int kPhases = 16;
constexpr int kSkyRays = 5;
constexpr int kLampRays = 2;
constexpr double kLampRadius = 0.22;  // at distance 1: how soft the shadows are

constexpr int kGroundScale = 4;  // ground shadows are soft: computed on a coarser raster
constexpr int kGroundRays = 10;

double radical_inverse(unsigned i) {
  double result = 0;
  for (double digit = 0.5; i > 0; i /= 2, digit /= 2) result += digit * (i & 1u);
  return result;
}

// The phase of a pixel: neighbours get phases that lie far apart.
int phase_of(int x, int y) {
  static constexpr std::array<int, 16> kOrder = {0, 8,  2, 10, 12, 4, 14, 6,
                                                 3, 11, 1, 9,  15, 7, 13, 5};
  return kOrder[std::size_t((y & 3) * 4 + (x & 3))];
}

// Two unit vectors that complete a unit vector to a right-handed frame.
std::array<Vec3, 2> frame_around(const Vec3& n) {
  const Vec3 helper = std::abs(n.x()) < 0.6 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 a = helper.cross(n).normalized();
  return {a, n.cross(a)};
}

// Directions over the hemisphere around z, denser where they count more, and in a disc's cone.
std::vector<Vec3> hemisphere_rays(int count) {
  std::vector<Vec3> rays;
  for (int i = 0; i < count; ++i) {
    const double u = (i + 0.5) / count;
    const double angle = 2 * std::numbers::pi * radical_inverse(unsigned(i));
    rays.emplace_back(std::sqrt(u) * std::cos(angle), std::sqrt(u) * std::sin(angle),
                      std::sqrt(1 - u));
  }
  return rays;
}

std::vector<Vec3> cone_rays(int count, double radius) {
  std::vector<Vec3> rays = hemisphere_rays(count);
  for (Vec3& d : rays) d = Vec3(radius * d.x(), radius * d.y(), 1).normalized();
  return rays;
}

std::vector<Vec3> turned_to(const Vec3& axis, std::vector<Vec3> rays) {
  const auto [a, b] = frame_around(axis);
  for (Vec3& d : rays) d = (d.x() * a + d.y() * b + d.z() * axis).eval();
  return rays;
}

}  // namespace

Vec3 smooth_normal(const std::vector<CornerNormals>& normals, const SeenPoint& s) {
  const Vec3 n = normal_between(normals[std::size_t(s.triangle)], double(s.u), double(s.v));
  if (n.isZero()) return s.flat();
  return n.dot(s.flat()) < 0 ? Vec3(-n) : n;
}

LitPixels::LitPixels(const LitObject& object, const Camera& camera, int width_px, int height_px,
                     const RunContext& context)
    : object_(object), camera_(camera), width_(width_px), height_(height_px), context_(context) {
  const Box3 box = object.mesh.bounds();
  extent_ = box.empty() ? 1 : std::max(1e-9, box.size().norm());
  place_ground();
  lamp_ = (-0.5 * camera.right + 0.8 * camera.up + 0.75 * camera.back).normalized();
  sky_rays_ = hemisphere_rays(kPhases * kSkyRays);
  lamp_rays_ = turned_to(lamp_, cone_rays(kPhases * kLampRays, kLampRadius));
  ground_sky_rays_ = turned_to(ground_normal_, hemisphere_rays(kPhases * kGroundRays));
  ground_lamp_rays_ = turned_to(lamp_, cone_rays(kPhases * kGroundRays, kLampRadius));
  trace_centres();
  cast_light_rays();
  smooth_light();
  shadow_ground();
}

void LitPixels::for_rows(const std::function<void(int y)>& row) const {
  parallel_for(std::size_t(height_), 8, [&](std::size_t begin, std::size_t end) {
    context_.check_cancelled();
    for (std::size_t y = begin; y < end; ++y) row(int(y));
  });
}

SeenPoint LitPixels::trace(double x_px, double y_px) const {
  const Vec3 along = ray(x_px, y_px);
  const auto hit = object_.surface.first_hit(camera_.eye, along, 0, 1e6 * extent_);
  if (!hit) return {};
  // Turned to the eye: inside and outside of an open surface look alike.
  const Vec3 n = face_normal(object_.mesh, hit->triangle);
  return {hit->triangle, float(hit->u), float(hit->v), float(hit->t),
          (n.dot(along) > 0 ? Vec3(-n) : n).cast<float>()};
}

Vec3 LitPixels::position(const SeenPoint& s) const { return position_at(object_.mesh, s.point()); }

Light LitPixels::light_near(const SeenPoint& s, int x, int y) const {
  Light best;
  double nearest = 1e300;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (x + dx < 0 || y + dy < 0 || x + dx >= width_ || y + dy >= height_) continue;
      const SeenPoint& other = centre_[at(x + dx, y + dy)];
      if (other.triangle < 0) continue;
      const double apart =
          std::abs(double(other.depth - s.depth)) + 1e-5 * extent_ * (dx * dx + dy * dy);
      if (apart < nearest) {
        nearest = apart;
        best = light_[at(x + dx, y + dy)];
      }
    }
  }
  return best;
}

Light LitPixels::ground_at(double x_px, double y_px) const {
  const double x = x_px / kGroundScale;
  const double y = y_px / kGroundScale;
  const int x0 = std::clamp(int(x), 0, coarse_width_ - 2);
  const int y0 = std::clamp(int(y), 0, coarse_height_ - 2);
  const double fx = x - x0;
  const double fy = y - y0;
  const Light* row = ground_.data() + std::size_t(y0) * std::size_t(coarse_width_) + x0;
  const Light* next = row + coarse_width_;
  const auto mix = [&](double Light::*part) {
    return (1 - fy) * ((1 - fx) * row[0].*part + fx * row[1].*part) +
           fy * ((1 - fx) * next[0].*part + fx * next[1].*part);
  };
  return {mix(&Light::sky), mix(&Light::lamp)};
}

// The ground tilts a little towards the eye, so that it shows, and touches the object.
void LitPixels::place_ground() {
  constexpr double kTilt = 14 * std::numbers::pi / 180;
  ground_normal_ = std::cos(kTilt) * camera_.up + std::sin(kTilt) * camera_.back;
  ground_height_ = 1e300;
  for (const Vec3& p : object_.mesh.positions) {
    ground_height_ = std::min(ground_height_, p.dot(ground_normal_));
  }
}

Vec3 LitPixels::ray(double x_px, double y_px) const {
  return camera_.ray(2 * x_px / width_ - 1, 1 - 2 * y_px / height_).normalized();
}

bool LitPixels::blocked(const Vec3& origin, const Vec3& direction) const {
  return object_.surface.is_hit(origin, direction, 0, 2 * extent_);
}

void LitPixels::trace_centres() {
  centre_.resize(count());
  for_rows([&](int y) {
    for (int x = 0; x < width_; ++x) centre_[at(x, y)] = trace(x + 0.5, y + 0.5);
  });
}

void LitPixels::cast_light_rays() {
  light_.resize(count());
  for_rows([&](int y) {
    for (int x = 0; x < width_; ++x) {
      const SeenPoint& s = centre_[at(x, y)];
      if (s.triangle < 0) continue;
      light_[at(x, y)] = cast_from(s, phase_of(x, y));
    }
  });
}

Light LitPixels::cast_from(const SeenPoint& s, int phase) const {
  const Vec3 flat = s.flat().normalized();
  const Vec3 origin = rounded_position(s) + 2e-4 * extent_ * flat;
  const auto frame = frame_around(flat);
  Light light{0, 0};
  for (int k = 0; k < kSkyRays; ++k) {
    const Vec3& d = sky_rays_[std::size_t(phase + kPhases * k)];
    if (!blocked(origin, d.x() * frame[0] + d.y() * frame[1] + d.z() * flat)) {
      light.sky += 1.0 / kSkyRays;
    }
  }
  if (smooth_normal(object_.normals, s).dot(lamp_) < -kLampRadius)
    return light;  // turned away: no shadow to know
  for (int k = 0; k < kLampRays; ++k) {
    const Vec3& d = lamp_rays_[std::size_t(phase + kPhases * k)];
    if (!blocked(origin, d)) light.lamp += 1.0 / kLampRays;
  }
  return light;
}

// A point on the curved surface that the triangles stand for: shadow rays from there do not
// show where the triangles' edges are.
Vec3 LitPixels::rounded_position(const SeenPoint& s) const {
  const Vec3 p = position(s);
  const CornerNormals& normal = object_.normals[std::size_t(s.triangle)];
  const Triangle& triangle = object_.mesh.triangles[std::size_t(s.triangle)];
  const SurfacePoint at = s.point();
  const std::array<double, 3> weight = {1 - at.u - at.v, at.u, at.v};
  Vec3 lifted = p;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 n = normal[k].dot(s.flat()) < 0 ? Vec3(-normal[k]) : normal[k];
    const Vec3& corner = object_.mesh.positions[std::size_t(triangle[k])];
    lifted += weight[k] * std::max(0.0, (corner - p).dot(n)) * n;
  }
  return lifted;
}

// Gathers the 4 x 4 phases (a 5 x 5 window with half weight on its rim) among pixels that show
// the same piece of surface.
void LitPixels::smooth_light() {
  const std::vector<PixelLight> raw = light_;
  for_rows([&](int y) {
    for (int x = 0; x < width_; ++x) {
      if (centre_[at(x, y)].triangle >= 0) light_[at(x, y)] = gathered(raw, x, y);
    }
  });
}

Light LitPixels::gathered(const std::vector<PixelLight>& raw, int x, int y) const {
  const SeenPoint& self = centre_[at(x, y)];
  const double pixel = 2 * camera_.half_width * double(self.depth) / width_;
  Light sum{0, 0};
  double total = 0;
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      if (x + dx < 0 || y + dy < 0 || x + dx >= width_ || y + dy >= height_) continue;
      const SeenPoint& other = centre_[at(x + dx, y + dy)];
      if (other.triangle < 0 || std::abs(double(other.depth - self.depth)) > 12 * pixel) continue;
      const double weight = (std::abs(dx) == 2 ? 0.5 : 1) * (std::abs(dy) == 2 ? 0.5 : 1);
      if (self.normal.dot(other.normal) < 0.5F) continue;  // round a corner
      const Light light = raw[at(x + dx, y + dy)];
      sum.sky += weight * light.sky;
      sum.lamp += weight * light.lamp;
      total += weight;
    }
  }
  return {sum.sky / total, sum.lamp / total};
}

// How dark the object makes the ground, on a coarse raster over the whole picture.
void LitPixels::shadow_ground() {
  coarse_width_ = width_ / kGroundScale + 2;
  coarse_height_ = height_ / kGroundScale + 2;
  const auto cells = std::size_t(coarse_width_) * std::size_t(coarse_height_);
  std::vector<Light> raw(cells);
  for_coarse([&](int x, int y) {
    raw[coarse_at(x, y)] = ground_light(x * kGroundScale, y * kGroundScale, phase_of(x, y));
  });
  ground_.resize(cells);
  for_coarse([&](int x, int y) { ground_[coarse_at(x, y)] = gathered_ground(raw, x, y); });
}

Light LitPixels::ground_light(double x_px, double y_px, int phase) const {
  const Vec3 d = ray(x_px, y_px);
  const double fall = d.dot(ground_normal_);
  if (fall > -1e-6) return {};
  const double t = (ground_height_ - camera_.eye.dot(ground_normal_)) / fall;
  const Vec3 origin = camera_.eye + t * d + 1e-4 * extent_ * ground_normal_;
  Light light{0, 0};
  for (int k = 0; k < kGroundRays; ++k) {
    const auto i = std::size_t(phase + kPhases * k);
    if (!blocked(origin, ground_sky_rays_[i])) light.sky += 1;
    if (!blocked(origin, ground_lamp_rays_[i])) light.lamp += 1;
  }
  return {light.sky / kGroundRays, light.lamp / kGroundRays};
}

Light LitPixels::gathered_ground(const std::vector<Light>& raw, int x, int y) const {
  Light sum{0, 0};
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const double weight = (std::abs(dx) == 2 ? 0.125 : 0.25) * (std::abs(dy) == 2 ? 0.125 : 0.25);
      const Light& light = raw[coarse_at(std::clamp(x + dx, 0, coarse_width_ - 1),
                                         std::clamp(y + dy, 0, coarse_height_ - 1))];
      sum.sky += weight * light.sky;
      sum.lamp += weight * light.lamp;
    }
  }
  return sum;
}

void LitPixels::for_coarse(const std::function<void(int x, int y)>& cell) const {
  parallel_for(std::size_t(coarse_height_), 4, [&](std::size_t begin, std::size_t end) {
    context_.check_cancelled();
    for (std::size_t y = begin; y < end; ++y) {
      for (int x = 0; x < coarse_width_; ++x) cell(x, int(y));
    }
  });
}

std::size_t LitPixels::coarse_at(int x, int y) const {
  return std::size_t(y) * std::size_t(coarse_width_) + std::size_t(x);
}

}  // namespace hydrodip
