#include "air/section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "base/run_scope.h"

namespace hydrodip {

namespace {

// The first of two unit vectors along the plane.
Vec3 along(const Vec3& up) {
  const Vec3 other = std::abs(up.x()) < 0.8 ? Vec3::UnitX() : Vec3::UnitY();
  return up.cross(other).normalized();
}

// Where the plane cuts an edge of the mesh, and the one or two neighbours along the section.
struct Cut {
  Vec2 at;
  std::vector<std::int32_t> next;
};

class Cutter {
 public:
  Cutter(const TriangleMesh& mesh, const Plane& plane) : mesh_(mesh), plane_(plane) {
    CheckEvery check(1 << 14);
    for (const Triangle& triangle : mesh.triangles) {
      check();
      cut(triangle);
    }
  }

  std::vector<Loop> loops(double max_gap_mm) {
    std::vector<Loop> closed;
    std::vector<Loop> open;
    // Open ones first, from end to end: what is left then is closed.
    for (std::size_t c = 0; c < cuts_.size(); ++c)
      if (cuts_[c].next.size() == 1) open.push_back(follow(std::int32_t(c)));
    for (std::size_t c = 0; c < cuts_.size(); ++c)
      if (!cuts_[c].next.empty()) closed.push_back(follow(std::int32_t(c)));
    join(open, max_gap_mm, closed);
    std::erase_if(closed, [](const Loop& loop) { return loop.size() < 3; });
    return closed;
  }

 private:
  void cut(const Triangle& triangle) {
    std::array<std::int32_t, 2> ends{};
    int found = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = triangle[k], b = triangle[(k + 1) % 3];
      if (is_above(a) == is_above(b)) continue;
      if (found < 2) ends[std::size_t(found)] = cut_of(a, b);
      ++found;
    }
    if (found != 2 || ends[0] == ends[1]) return;
    cuts_[std::size_t(ends[0])].next.push_back(ends[1]);
    cuts_[std::size_t(ends[1])].next.push_back(ends[0]);
  }

  bool is_above(std::int32_t v) const {
    return plane_.height(mesh_.positions[std::size_t(v)]) >= 0;
  }

  std::int32_t cut_of(std::int32_t a, std::int32_t b) {
    if (a > b) std::swap(a, b);
    const auto key = (std::uint64_t(std::uint32_t(a)) << 32) | std::uint32_t(b);
    const auto [known, is_new] = cut_of_edge_.try_emplace(key, std::int32_t(cuts_.size()));
    if (is_new) {
      const Vec3 &p = mesh_.positions[std::size_t(a)], &q = mesh_.positions[std::size_t(b)];
      const double hp = plane_.height(p), hq = plane_.height(q);
      cuts_.push_back({plane_.flat(p + hp / (hp - hq) * (q - p)), {}});
    }
    return known->second;
  }

  // Takes away what it goes along.
  Loop follow(std::int32_t at) {
    Loop loop = {cuts_[std::size_t(at)].at};
    const std::int32_t start = at;
    while (!cuts_[std::size_t(at)].next.empty()) {
      const std::int32_t next = cuts_[std::size_t(at)].next.back();
      cuts_[std::size_t(at)].next.pop_back();
      auto& back = cuts_[std::size_t(next)].next;
      back.erase(std::find(back.begin(), back.end(), at));
      at = next;
      if (at == start) break;
      loop.push_back(cuts_[std::size_t(at)].at);
    }
    return loop;
  }

  // Ends to the nearest ends.
  static void join(std::vector<Loop>& open, double max_gap_mm, std::vector<Loop>& closed) {
    while (!open.empty()) {
      Loop loop = std::move(open.back());
      open.pop_back();
      while (true) {
        double nearest = (loop.front() - loop.back()).norm();
        std::size_t with = open.size();
        bool turned = false;
        for (std::size_t k = 0; k < open.size(); ++k)
          for (const bool turn : {false, true}) {
            const double gap = ((turn ? open[k].back() : open[k].front()) - loop.back()).norm();
            if (gap < nearest) {
              nearest = gap;
              with = k;
              turned = turn;
            }
          }
        if (nearest > max_gap_mm) break;
        if (with == open.size()) {
          closed.push_back(std::move(loop));
          break;
        }
        if (turned) std::reverse(open[with].begin(), open[with].end());
        loop.insert(loop.end(), open[with].begin(), open[with].end());
        open.erase(open.begin() + std::ptrdiff_t(with));
      }
    }
  }

  const TriangleMesh& mesh_;
  const Plane& plane_;
  std::vector<Cut> cuts_;
  std::unordered_map<std::uint64_t, std::int32_t> cut_of_edge_;
};

}  // namespace

Vec2 Plane::flat(const Vec3& point) const {
  const Vec3 x = along(up);
  return {x.dot(point), up.cross(x).dot(point)};
}

Vec3 Plane::lifted(const Vec2& flat) const {
  const Vec3 x = along(up);
  return offset * up + flat.x() * x + flat.y() * up.cross(x);
}

std::vector<Loop> section(const TriangleMesh& mesh, const Plane& plane, double max_gap_mm) {
  return Cutter(mesh, plane).loops(max_gap_mm);
}

bool encloses(const Loop& loop, const Vec2& point) {
  bool inside = false;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
    const Vec2 &a = loop[i], &b = loop[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      inside = !inside;
  }
  return inside;
}

double area(const Loop& loop) {
  double twice = 0;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++)
    twice += cross2(loop[j], loop[i]);
  return 0.5 * twice;
}

}  // namespace hydrodip
