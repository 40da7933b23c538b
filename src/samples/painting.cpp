#include "samples/painting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/run_scope.h"

namespace hydrodip {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr int kCurveSegments = 48;

// Signed distance to a capsule whose radius runs from ra to rb (evaluated along the axis, which is
// close enough for segments much longer than the change of radius).
double capsule_distance(const Vec2& p, const Vec2& a, const Vec2& b, double ra, double rb) {
  const Vec2 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).norm() - (ra + t * (rb - ra));
}

}  // namespace

LinearColor rgb(std::uint32_t hex) {
  return {srgb8_to_linear(std::uint8_t(hex >> 16 & 0xff)),
          srgb8_to_linear(std::uint8_t(hex >> 8 & 0xff)), srgb8_to_linear(std::uint8_t(hex & 0xff)),
          1};
}

LinearColor mix(const LinearColor& a, const LinearColor& b, double t) {
  const float s = float(t);
  return {a.r + s * (b.r - a.r), a.g + s * (b.g - a.g), a.b + s * (b.b - a.b),
          a.a + s * (b.a - a.a)};
}

double smooth_step(double from, double to, double value) {
  const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Path bezier(const Vec2& p0, const Vec2& p1, const Vec2& p2, const Vec2& p3) {
  Path path;
  for (int i = 0; i <= kCurveSegments; ++i) {
    const double t = double(i) / kCurveSegments, s = 1 - t;
    path.push_back(s * s * s * p0 + 3 * s * s * t * p1 + 3 * s * t * t * p2 + t * t * t * p3);
  }
  return path;
}

namespace {

void append_catmull_rom(Path& path, const Vec2& before, const Vec2& from, const Vec2& to,
                        const Vec2& after) {
  const Path part = bezier(from, from + (to - before) / 6, to - (after - from) / 6, to);
  path.insert(path.end(), part.begin(), part.end());
}

}  // namespace

Path smooth_curve(const std::vector<Vec2>& points) {
  Path path;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i + 1 < n; ++i)
    append_catmull_rom(path, points[i == 0 ? 0 : i - 1], points[i], points[i + 1],
                       points[std::min(i + 2, n - 1)]);
  return path;
}

Path smooth_loop(const std::vector<Vec2>& points) {
  Path path;
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i)
    append_catmull_rom(path, points[(i + n - 1) % n], points[i], points[(i + 1) % n],
                       points[(i + 2) % n]);
  return path;
}

Path ellipse(const Vec2& center, double radius_x, double radius_y, double turn_deg) {
  constexpr int kSegments = 128;
  const double c = std::cos(turn_deg * kRadians), s = std::sin(turn_deg * kRadians);
  Path path;
  for (int i = 0; i < kSegments; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSegments;
    const double x = radius_x * std::cos(angle), y = radius_y * std::sin(angle);
    path.push_back(center + Vec2(c * x - s * y, s * x + c * y));
  }
  return path;
}

Path arc(const Vec2& center, double radius, double from_deg, double to_deg) {
  Path path;
  for (int i = 0; i <= kCurveSegments; ++i) {
    const double angle = (from_deg + (to_deg - from_deg) * i / kCurveSegments) * kRadians;
    path.push_back(center + radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return path;
}

Path spiral(const Vec2& center, double radius, double end_deg, double turns) {
  const int segments = std::max(kCurveSegments, int(std::ceil(std::abs(turns) * 64)));
  Path path;
  for (int i = 0; i <= segments; ++i) {
    const double t = double(i) / segments;
    const double angle = (end_deg - 360 * turns * (1 - t)) * kRadians;
    path.push_back(center + radius * t * Vec2(std::cos(angle), std::sin(angle)));
  }
  return path;
}

Path join(const std::vector<Path>& parts) {
  Path path;
  for (const Path& part : parts) path.insert(path.end(), part.begin(), part.end());
  return path;
}

Path reversed(Path path) {
  std::reverse(path.begin(), path.end());
  return path;
}

Path mirrored(Path path) {
  for (Vec2& p : path) p.x() = -p.x();
  return path;
}

Canvas::Canvas(double width_mm, double height_mm, double px_per_mm)
    : width_px_(int(std::lround(width_mm * px_per_mm))),
      height_px_(int(std::lround(height_mm * px_per_mm))),
      px_per_mm_(px_per_mm),
      rgb_(std::size_t(3) * std::size_t(width_px_) * std::size_t(height_px_), 0.0f) {}

Vec2 Canvas::to_px(const Vec2& mm) const {
  return {width_px_ / 2.0 + mm.x() * px_per_mm_, height_px_ / 2.0 - mm.y() * px_per_mm_};
}

Vec2 Canvas::to_mm(int x, int y) const {
  return {(x + 0.5 - width_px_ / 2.0) / px_per_mm_, (height_px_ / 2.0 - y - 0.5) / px_per_mm_};
}

Canvas::Pixels Canvas::clamp_to_canvas(const Box2& box_px) const {
  if (box_px.empty()) return {0, 0, 0, 0};
  const auto limit = [](double value, int size) {
    return int(std::clamp(value, 0.0, double(size)));
  };
  return {limit(std::floor(box_px.min.x()) - 1, width_px_),
          limit(std::floor(box_px.min.y()) - 1, height_px_),
          limit(std::ceil(box_px.max.x()) + 1, width_px_),
          limit(std::ceil(box_px.max.y()) + 1, height_px_)};
}

void Canvas::blend(int x, int y, double coverage, const LinearColor& color) {
  const std::size_t index = std::size_t(y) * std::size_t(width_px_) + std::size_t(x);
  double alpha = coverage * color.a;
  if (!clip_.empty()) alpha *= clip_[index];
  if (alpha <= 0) return;
  const float a = float(std::min(alpha, 1.0));
  float* pixel = rgb_.data() + 3 * index;
  pixel[0] += a * (color.r - pixel[0]);
  pixel[1] += a * (color.g - pixel[1]);
  pixel[2] += a * (color.b - pixel[2]);
}

void Canvas::fill_all(const Paint& paint) {
  for (int y = 0; y < height_px_; ++y) {
    check_cancelled();
    for (int x = 0; x < width_px_; ++x) blend(x, y, 1.0, paint(to_mm(x, y)));
  }
}

// Exact horizontal coverage on a few sub-scanlines per pixel row.
std::vector<float> Canvas::coverage_of_fill(const Path& path, Pixels& pixels) const {
  constexpr int kSubScanlines = 8;
  Path px;
  Box2 box;
  for (const Vec2& p : path) {
    px.push_back(to_px(p));
    box.add(px.back());
  }
  pixels = clamp_to_canvas(box);
  std::vector<float> coverage(std::size_t(pixels.width()) * std::size_t(pixels.y1 - pixels.y0),
                              0.0f);
  std::vector<double> crossings;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    check_cancelled();
    float* row = coverage.data() + std::size_t(y - pixels.y0) * std::size_t(pixels.width());
    for (int sub = 0; sub < kSubScanlines; ++sub) {
      const double line = y + (sub + 0.5) / kSubScanlines;
      crossings.clear();
      for (std::size_t i = 0; i < px.size(); ++i) {
        const Vec2 &a = px[i], &b = px[(i + 1) % px.size()];
        if ((a.y() <= line) != (b.y() <= line))
          crossings.push_back(a.x() + (line - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
      }
      std::sort(crossings.begin(), crossings.end());
      for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
        const double from = std::clamp(crossings[i], double(pixels.x0), double(pixels.x1));
        const double to = std::clamp(crossings[i + 1], double(pixels.x0), double(pixels.x1));
        for (int x = int(from); x < std::min(int(std::ceil(to)), pixels.x1); ++x) {
          const double covered = std::min(to, x + 1.0) - std::max(from, double(x));
          row[x - pixels.x0] += float(std::max(covered, 0.0) / kSubScanlines);
        }
      }
    }
  }
  return coverage;
}

void Canvas::fill(const Path& path, const Paint& paint) {
  check_cancelled();
  Pixels pixels{};
  const std::vector<float> coverage = coverage_of_fill(path, pixels);
  std::size_t i = 0;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    check_cancelled();
    for (int x = pixels.x0; x < pixels.x1; ++x, ++i)
      if (coverage[i] > 0) blend(x, y, coverage[i], paint(to_mm(x, y)));
  }
}

void Canvas::fill(const Path& path, const LinearColor& color) {
  fill(path, [&](const Vec2&) { return color; });
}

void Canvas::stroke(const Path& path, const Radius& radius_mm, const LinearColor& color) {
  check_cancelled();
  if (path.empty()) return;
  std::vector<double> along(path.size(), 0.0);
  for (std::size_t i = 1; i < path.size(); ++i)
    along[i] = along[i - 1] + (path[i] - path[i - 1]).norm();
  const double length = std::max(along.back(), 1e-9);

  std::vector<Vec2> px;
  std::vector<double> radius_px;
  Box2 box;
  for (std::size_t i = 0; i < path.size(); ++i) {
    px.push_back(to_px(path[i]));
    radius_px.push_back(radius_mm(along[i] / length) * px_per_mm_);
    box.add(px[i] - Vec2::Constant(radius_px[i] + 1));
    box.add(px[i] + Vec2::Constant(radius_px[i] + 1));
  }
  const Pixels pixels = clamp_to_canvas(box);

  // The union of the segments' coverages, so that a translucent line does not darken at its joints.
  std::vector<float> coverage(std::size_t(pixels.width()) * std::size_t(pixels.y1 - pixels.y0),
                              0.0f);
  for (std::size_t i = 0; i < px.size(); ++i) {
    check_cancelled();
    const std::size_t j = std::min(i + 1, px.size() - 1);
    Box2 segment;
    const double reach = std::max(radius_px[i], radius_px[j]) + 1;
    for (const Vec2& p : {px[i], px[j]}) {
      segment.add(p - Vec2::Constant(reach));
      segment.add(p + Vec2::Constant(reach));
    }
    const Pixels part = clamp_to_canvas(segment);
    for (int y = std::max(part.y0, pixels.y0); y < std::min(part.y1, pixels.y1); ++y)
      for (int x = std::max(part.x0, pixels.x0); x < std::min(part.x1, pixels.x1); ++x) {
        const double distance =
            capsule_distance(Vec2(x + 0.5, y + 0.5), px[i], px[j], radius_px[i], radius_px[j]);
        float& cell = coverage[std::size_t(y - pixels.y0) * std::size_t(pixels.width()) +
                               std::size_t(x - pixels.x0)];
        cell = std::max(cell, float(std::clamp(0.5 - distance, 0.0, 1.0)));
      }
  }
  std::size_t i = 0;
  for (int y = pixels.y0; y < pixels.y1; ++y)
    for (int x = pixels.x0; x < pixels.x1; ++x, ++i)
      if (coverage[i] > 0) blend(x, y, coverage[i], color);
}

void Canvas::stroke(const Path& path, double width_mm, const LinearColor& color) {
  stroke(
      path, [&](double) { return width_mm / 2; }, color);
}

void Canvas::tapering_stroke(const Path& path, double width_mm, const LinearColor& color) {
  stroke(
      path, [&](double t) { return width_mm / 2 * (1 - t); }, color);
}

void Canvas::dot(const Vec2& center, double radius_mm, const LinearColor& color) {
  stroke(Path{center}, 2 * radius_mm, color);
}

void Canvas::glow(const Vec2& center, double radius_x, double radius_y, double turn_deg,
                  const LinearColor& color, double strength) {
  const double c = std::cos(turn_deg * kRadians), s = std::sin(turn_deg * kRadians);
  const double reach = 3.2 * std::max(radius_x, radius_y) * px_per_mm_;
  Box2 box;
  box.add(to_px(center) - Vec2::Constant(reach));
  box.add(to_px(center) + Vec2::Constant(reach));
  const Pixels pixels = clamp_to_canvas(box);
  for (int y = pixels.y0; y < pixels.y1; ++y)
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      const Vec2 d = to_mm(x, y) - center;
      const double u = (c * d.x() + s * d.y()) / radius_x, v = (-s * d.x() + c * d.y()) / radius_y;
      blend(x, y, strength * std::exp(-0.5 * (u * u + v * v)), color);
    }
}

void Canvas::clip(const Path& path) {
  clip_.clear();
  if (path.empty()) return;
  Pixels pixels{};
  const std::vector<float> coverage = coverage_of_fill(path, pixels);
  clip_.assign(std::size_t(width_px_) * std::size_t(height_px_), 0.0f);
  std::size_t i = 0;
  for (int y = pixels.y0; y < pixels.y1; ++y)
    for (int x = pixels.x0; x < pixels.x1; ++x, ++i)
      clip_[std::size_t(y) * std::size_t(width_px_) + std::size_t(x)] = coverage[i];
}

Image Canvas::image() const {
  Image image(width_px_, height_px_);
  CheckEvery check(1 << 14);
  for (std::size_t i = 0; 3 * i < rgb_.size(); ++i) {
    check();
    for (std::size_t c = 0; c < 3; ++c) image.rgba[4 * i + c] = linear_to_srgb8(rgb_[3 * i + c]);
    image.rgba[4 * i + 3] = 255;
  }
  return image;
}

}  // namespace hydrodip
