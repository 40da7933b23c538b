#include "calibrate/rounded_pyramid.h"

#include <array>
#include <cmath>
#include <utility>

namespace hydrodip {
namespace {

constexpr int kAcross = 24;   // parts of an edge's arc
constexpr int kFromTip = 24;  // rings of the tip's cap
constexpr int kAlong = 32;    // parts of a face's rim

// From a to b, both of length 1, by the angle's share.
Vec3 turned(const Vec3& a, const Vec3& b, double share) {
  const double angle = std::acos(a.dot(b));
  return (std::sin((1 - share) * angle) * a + std::sin(share * angle) * b) / std::sin(angle);
}

Vec3 quarter_turned(Vec3 v, int times) {
  for (int i = 0; i < times; ++i) v = Vec3(-v.y(), v.x(), v.z());
  return v;
}

class Builder {
 public:
  Builder(double width_mm, double height_mm, double radius_mm)
      : radius_(radius_mm),
        slope_(2 * height_mm / width_mm),
        center_(0, 0, radius_mm),
        rim_z_(height_mm - radius_mm * (std::hypot(1, slope_) - 1)) {}

  RoundedPyramid build() {
    add_cap();
    for (int edge = 0; edge < 4; ++edge) add_edge(edge);
    for (int face = 0; face < 4; ++face) add_face(face);
    return std::move(result_);
  }

 private:
  // Of a face, the first of which looks towards +x.
  Vec3 normal(int face) const { return quarter_turned(Vec3(slope_, 0, -1).normalized(), face % 4); }
  // Across the edge behind a face.
  Vec3 normal(int edge, int across) const {
    return turned(normal(edge), normal(edge + 1), double(across) / kAcross);
  }

  std::int32_t add(const Vec3& position) {
    result_.side.positions.push_back(position);
    return std::int32_t(result_.side.positions.size()) - 1;
  }
  void add(std::int32_t a, std::int32_t b, std::int32_t c) {
    result_.side.triangles.push_back({a, b, c});
  }
  void add(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    add(a, b, c);
    add(a, c, d);
  }

  // The ball at the tip, as far as the edges' normals.
  void add_cap() {
    constexpr int kAround = 4 * kAcross;
    const std::int32_t tip = add(Vec3::Zero());
    for (int ring = 1; ring <= kFromTip; ++ring)
      for (int i = 0; i < kAround; ++i)
        cap_rim_.push_back(
            add(center_ + radius_ * turned(-Vec3::UnitZ(), normal(i / kAcross, i % kAcross),
                                           double(ring) / kFromTip)));
    const auto at = [&](int ring, int i) {
      return cap_rim_[std::size_t(ring * kAround + i % kAround)];
    };
    for (int i = 0; i < kAround; ++i) add(tip, at(0, i + 1), at(0, i));
    for (int ring = 1; ring < kFromTip; ++ring)
      for (int i = 0; i < kAround; ++i)
        add(at(ring - 1, i), at(ring - 1, i + 1), at(ring, i + 1), at(ring, i));
    cap_rim_.erase(cap_rim_.begin(), cap_rim_.end() - kAround);
  }

  std::int32_t at_cap(int edge, int across) const {
    return cap_rim_[std::size_t((edge * kAcross + across) % (4 * kAcross))];
  }

  // The part of a cylinder between the cap and the rim.
  void add_edge(int edge) {
    const Vec3 way = quarter_turned(Vec3(1, 1, slope_), edge);
    for (int i = 0; i <= kAcross; ++i) {
      const Vec3 start = center_ + radius_ * normal(edge, i);
      edge_rim_[std::size_t(edge)][std::size_t(i)] =
          add(start + (rim_z_ - start.z()) / slope_ * way);
    }
    const auto& rim = edge_rim_[std::size_t(edge)];
    for (int i = 0; i < kAcross; ++i)
      add(at_cap(edge, i), at_cap(edge, i + 1), rim[std::size_t(i) + 1], rim[std::size_t(i)]);
  }

  void add_face(int face) {
    const std::int32_t top = at_cap(face, 0);
    const std::int32_t first = edge_rim_[std::size_t((face + 3) % 4)].back();
    const auto& next = edge_rim_[std::size_t(face)];
    const Vec3 from = result_.side.positions[std::size_t(first)];
    const Vec3 to = result_.side.positions[std::size_t(next.front())];
    std::int32_t last = first;
    for (int i = 1; i <= kAlong; ++i) {
      const std::int32_t here =
          i < kAlong ? add(from + double(i) / kAlong * (to - from)) : next.front();
      add(top, here, last);
      result_.rim.push_back(last);
      last = here;
    }
    result_.rim.insert(result_.rim.end(), next.begin(), next.end() - 1);
  }

  double radius_, slope_;
  Vec3 center_;  // of the ball at the tip
  double rim_z_;
  std::vector<std::int32_t> cap_rim_;
  std::array<std::array<std::int32_t, kAcross + 1>, 4> edge_rim_{};
  RoundedPyramid result_;
};

}  // namespace

TriangleMesh RoundedPyramid::closed() const {
  TriangleMesh mesh = side;
  const auto middle = std::int32_t(mesh.positions.size());
  mesh.positions.push_back({0, 0, mesh.positions[std::size_t(rim.front())].z()});
  for (std::size_t i = 0; i < rim.size(); ++i)
    mesh.triangles.push_back({rim[i], rim[(i + 1) % rim.size()], middle});
  return mesh;
}

RoundedPyramid rounded_pyramid(double width_mm, double height_mm, double radius_mm) {
  return Builder(width_mm, height_mm, radius_mm).build();
}

}  // namespace hydrodip
