// The mask's shape: a height field over a face-shaped outline, closed by a flat back.
#include <cmath>
#include <numbers>

#include "samples/painting.h"
#include "samples/parts.h"

namespace hydrodip {
namespace {

constexpr double kHalfWidthMm = 50;
constexpr double kHalfHeightMm = 65;
constexpr double kRimRadiusMm = 3;  // rounding of the edge
constexpr double kEdgeMm = 1;       // thickness at the very edge
constexpr double kDomeMm = 16;
constexpr int kRings = 74;    // in front; ring i has 6 i vertices
constexpr int kRimRings = 6;  // around the rounded edge

// Where the rounded edge begins, as a fraction of the outline.
constexpr double kRimStart = 1 - kRimRadiusMm / kHalfWidthMm;

// Half-width of the face at y / kHalfHeightMm: broad at the temples, narrow at the chin.
double half_width_mm(double y_fraction) {
  return kHalfWidthMm * (1 - 0.16 * (y_fraction - 0.25) * (y_fraction - 0.25));
}

// The outline is a superellipse, |x|^2.5 + |y|^2.5 = 1: a little squarer than an ellipse.
double outline_norm(double x, double y) {
  const auto power = [](double v) { return v * v * std::sqrt(std::abs(v)); };
  return std::pow(power(x) + power(y), 1 / 2.5);
}

// Smooth bump of the given height; radii are those of a Gaussian.
double bump(const Vec2& p, double x, double y, double radius_x, double radius_y, double height,
            double turn_deg = 0) {
  const double turn = turn_deg * std::numbers::pi / 180;
  const double c = std::cos(turn), s = std::sin(turn);
  const double dx = p.x() - x, dy = p.y() - y;
  const double u = (c * dx + s * dy) / radius_x, v = (-s * dx + c * dy) / radius_y;
  return height * std::exp(-0.5 * (u * u + v * v));
}

double nose_mm(const Vec2& p) {
  // Along the ridge: from the brow down to the tip, then back under it to the lip.
  const double y = p.y();
  const double bridge = 2.0 * smooth_step(34, 16, y);
  const double ridge = (bridge + 7.4 * smooth_step(20, -13, y)) * smooth_step(-29.5, -12.5, y);
  const double radius = 4.2 + 3.0 * smooth_step(16, -14, y);
  const double u = p.x() / radius;
  return ridge * std::exp(-0.5 * u * u);
}

double lips_mm(const Vec2& p) {
  const double x = std::abs(p.x());
  const double mouth_y = -38.0 + 0.0022 * x * x;
  double h = bump(p, 0, -38, 19, 13, 2.6);
  h += bump(p, 4.2, -34.9, 5.2, 2.6, 1.5) + bump(p, -4.2, -34.9, 5.2, 2.6, 1.5);
  h += bump(p, 0, -42.0, 7.6, 3.0, 2.4);
  h -= bump(Vec2(p.x(), p.y() - mouth_y), 0, 0, 10.5, 1.25, 1.35);
  h -= bump(p, 0, -48.2, 9, 2.8, 1.0);
  return h;
}

double eye_mm(const Vec2& right) {
  double h = bump(right, 21, 25, 13.5, 5.0, 2.9, 8);  // brow ridge
  h -= bump(right, 20, 10, 11.5, 7.5, 4.6, 4);        // socket
  h += bump(right, 20.5, 9.2, 7.8, 4.6, 3.6, 5);      // eyeball under its lids
  h += bump(right, 29, -6, 12, 9.5, 3.6, -20);        // cheekbone
  h += bump(right, 8.2, -18.2, 3.9, 4.2, 2.0);        // nostril wing
  return h;
}

// Height of the front over the back, mm, at a point inside the outline.
double height_mm(const Vec2& p) {
  const double r = mask_radius(p);
  double h = kDomeMm * (1 - r * r);
  h += eye_mm(p) + eye_mm(Vec2(-p.x(), p.y()));
  h += nose_mm(p) + lips_mm(p);
  h += bump(p, 0, 42, 26, 15, 2.2);    // forehead
  h += bump(p, 0, -54, 10, 6.5, 2.8);  // chin
  h *= smooth_step(1.25, 0.75, r);     // features fade into the edge
  // The edge is a quarter circle.
  const double d = std::min((1 - r) / (1 - kRimStart), 1.0);
  return kEdgeMm + h + kRimRadiusMm * std::sqrt(std::max(0.0, 1 - (1 - d) * (1 - d)));
}

double ring_radius(int ring) {
  if (ring <= kRings) return kRimStart * ring / kRings;
  const double turn = std::numbers::pi / 2 * (ring - kRings) / kRimRings;
  return 1 - (1 - kRimStart) * (1 - std::sin(turn));
}

// Ring i < kRings has 6 i vertices (one in the middle), later ones keep the last count.
int ring_size(int ring) { return 6 * std::min(ring, kRings); }

// Triangles between ring i - 1 (vertices from inner) and ring i (from outer), where the outer ring
// has one vertex more in each of six sectors.
void add_growing_ring(Object& object, int ring, int inner, int outer) {
  const int inner_count = std::max(1, ring_size(ring - 1)), outer_count = ring_size(ring);
  for (int sector = 0; sector < 6; ++sector)
    for (int k = 0; k < ring; ++k) {
      const int o0 = outer + (sector * ring + k) % outer_count;
      const int o1 = outer + (sector * ring + k + 1) % outer_count;
      const int i0 = inner + (sector * (ring - 1) + k) % inner_count;
      object.triangles.push_back({i0, o0, o1});
      if (k + 1 == ring) continue;
      const int i1 = inner + (sector * (ring - 1) + k + 1) % inner_count;
      object.triangles.push_back({i0, o1, i1});
    }
}

void add_band(Object& object, int count, int inner, int outer) {
  for (int k = 0; k < count; ++k) {
    const int next = (k + 1) % count;
    object.triangles.push_back({inner + k, outer + k, outer + next});
    object.triangles.push_back({inner + k, outer + next, inner + next});
  }
}

}  // namespace

double mask_radius(const Vec2& p) {
  const double y = p.y() / kHalfHeightMm;
  return outline_norm(p.x() / half_width_mm(y), y);
}

Vec2 mask_point(double radius, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double scale = radius / outline_norm(c, s);
  const double y = scale * s;
  return {scale * c * half_width_mm(y), y * kHalfHeightMm};
}

Object make_mask() {
  Object object;
  std::vector<int> first;  // vertex of each ring
  const int rings = kRings + kRimRings;
  for (int ring = 0; ring <= rings; ++ring) {
    first.push_back(int(object.positions.size()));
    const int count = std::max(1, ring_size(ring));
    for (int k = 0; k < count; ++k) {
      const Vec2 p = mask_point(ring_radius(ring), 2 * std::numbers::pi * k / count);
      object.positions.push_back(posed(p.x(), p.y(), height_mm(p)));
    }
    if (ring == 0) continue;
    const int inner = first[std::size_t(ring - 1)], outer = first[std::size_t(ring)];
    if (ring <= kRings)
      add_growing_ring(object, ring, inner, outer);
    else
      add_band(object, count, inner, outer);
  }
  // The wall down to the back, and the back as a fan.
  const int count = ring_size(rings), edge = first.back(), back = int(object.positions.size());
  for (int k = 0; k < count; ++k) {
    const Vec2 p = mask_point(1, 2 * std::numbers::pi * k / count);
    object.positions.push_back(posed(p.x(), p.y(), 0));
  }
  add_band(object, count, edge, back);
  const int middle = int(object.positions.size());
  object.positions.push_back(posed(0, 0, 0));
  for (int k = 0; k < count; ++k)
    object.triangles.push_back({back + k, middle, back + (k + 1) % count});

  set_planar_uvs(object, kMaskTextureWidthMm, kMaskTextureHeightMm);
  set_texture(object, "mask", paint_mask());
  rest_on_zero(object);
  return object;
}

}  // namespace hydrodip
