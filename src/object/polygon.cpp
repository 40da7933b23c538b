#include "object/polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/run_scope.h"

namespace hydrodip {

namespace {

// Newell's normal: twice the area vector, right for concave polygons too.
Vec3 area_vector(const std::vector<Vec3>& corners) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = corners[i] - corners[0];
    const Vec3 b = corners[(i + 1) % corners.size()] - corners[0];
    sum += a.cross(b);
  }
  return sum;
}

// Drops the coordinate along which the polygon faces most, keeping its turning sense positive.
std::vector<Vec2> flatten(const std::vector<Vec3>& corners) {
  const Vec3 normal = area_vector(corners);
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  std::vector<Vec2> flat;
  flat.reserve(corners.size());
  for (const Vec3& p : corners) {
    flat.push_back(normal[axis] < 0 ? Vec2(p[j], p[i]) : Vec2(p[i], p[j]));
  }
  return flat;
}

// The polygon's corners filed by the cells of a grid, so that few of many are looked at.
class CornerGrid {
 public:
  explicit CornerGrid(const std::vector<Vec2>& points) {
    for (const Vec2& p : points) box_.add(p);
    side_ = std::max(1, int(std::sqrt(double(points.size()))));
    const Vec2 size = box_.max - box_.min;
    scale_ = Vec2(size.x() > 0 ? side_ / size.x() : 0, size.y() > 0 ? side_ / size.y() : 0);
    begin_.assign(std::size_t(side_) * std::size_t(side_) + 1, 0);
    for (const Vec2& p : points) ++begin_[cell(p) + 1];
    for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
    corners_.resize(points.size());
    std::vector<int> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t i = 0; i < points.size(); ++i)
      corners_[std::size_t(next[cell(points[i])]++)] = int(i);
  }

  // Calls visit(corner) for those near the box, until it returns false. Returns how many cells and
  // corners were looked at.
  template <typename Visit>
  long near(const Box2& box, Visit visit) const {
    long looks = 0;
    const int x0 = column(box.min.x(), 0), x1 = column(box.max.x(), 0);
    for (int y = column(box.min.y(), 1); y <= column(box.max.y(), 1); ++y) {
      for (int x = x0; x <= x1; ++x) {
        const std::size_t c = std::size_t(y) * std::size_t(side_) + std::size_t(x);
        ++looks;
        for (int i = begin_[c]; i < begin_[c + 1]; ++i, ++looks)
          if (!visit(corners_[std::size_t(i)])) return looks;
      }
    }
    return looks;
  }

 private:
  int column(double coordinate, int axis) const {
    return int(std::clamp((coordinate - box_.min[axis]) * scale_[axis], 0.0, double(side_ - 1)));
  }
  std::size_t cell(const Vec2& p) const {
    return std::size_t(column(p.y(), 1)) * std::size_t(side_) + std::size_t(column(p.x(), 0));
  }

  Box2 box_;
  int side_ = 1;
  Vec2 scale_ = Vec2::Zero();
  std::vector<int> begin_, corners_;
};

// What is left of a polygon while its ears are cut off: a ring of corners.
class EarClipper {
 public:
  explicit EarClipper(const std::vector<Vec3>& corners)
      : points_(flatten(corners)),
        count_(int(corners.size())),
        before_(corners.size()),
        after_(corners.size()),
        gone_(corners.size(), 0),
        looks_left_((count_ > kFewCorners ? kLooksInGrid : kLooksPerCorner) * count_) {
    for (int i = 0; i < count_; ++i) {
      before_[std::size_t(i)] = i > 0 ? i - 1 : count_ - 1;
      after_[std::size_t(i)] = i + 1 < count_ ? i + 1 : 0;
    }
    if (count_ > kFewCorners) grid_.emplace(points_);
  }

  std::vector<std::array<int, 3>> run() {
    std::vector<std::array<int, 3>> triangles;
    triangles.reserve(std::size_t(count_ - 2));
    // Going on from the last ear, rather than from the start, avoids a fan of slivers.
    int at = 1;
    for (int left = count_; left > 3; --left) {
      const int ear = next_ear(at, left);
      const int before = before_[std::size_t(ear)], after = after_[std::size_t(ear)];
      triangles.push_back({before, ear, after});
      after_[std::size_t(before)] = after;
      before_[std::size_t(after)] = before;
      gone_[std::size_t(ear)] = 1;
      at = after_[std::size_t(after)];
    }
    std::array<int, 3> last{at, after_[std::size_t(at)], before_[std::size_t(at)]};
    std::sort(last.begin(), last.end());
    triangles.push_back(last);
    return triangles;
  }

 private:
  static constexpr long kLooksPerCorner = 5000, kLooksInGrid = 1000;
  static constexpr int kFewCorners = 64;

  int next_ear(int at, int left) {
    int tip = at;
    for (int tried = 0; tried < left && looks_left_ > 0; ++tried) {
      if (is_ear(tip)) return tip;
      tip = after_[std::size_t(tip)];
    }
    return at;
  }

  bool is_ear(int tip) {
    look(1);
    const int before = before_[std::size_t(tip)], after = after_[std::size_t(tip)];
    const Vec2 &a = points_[std::size_t(before)], &b = points_[std::size_t(tip)],
               &c = points_[std::size_t(after)];
    if (!(cross2(b - a, c - b) > 0)) return false;
    bool empty = true;
    const auto visit = [&](int other) {
      const Vec2& p = points_[std::size_t(other)];
      if (gone_[std::size_t(other)] || other == before || other == tip || other == after ||
          p == a || p == b || p == c)
        return true;
      empty =
          !(cross2(b - a, p - a) >= 0 && cross2(c - b, p - b) >= 0 && cross2(a - c, p - c) >= 0);
      return empty;
    };
    if (grid_) {
      Box2 box;
      for (const Vec2& p : {a, b, c}) box.add(p);
      look(grid_->near(box, visit));
    } else {
      look(count_);
      for (int other = 0; other < count_ && visit(other); ++other) {
      }
    }
    return empty;
  }

  void look(long looks) {
    looks_left_ -= looks;
    since_check_ += looks;
    if (since_check_ < 100000) return;
    since_check_ = 0;
    check_cancelled();
  }

  std::vector<Vec2> points_;
  int count_;
  std::vector<int> before_, after_;
  std::vector<char> gone_;
  std::optional<CornerGrid> grid_;
  long looks_left_;
  long since_check_ = 0;
};

}  // namespace

std::vector<std::array<int, 3>> triangulate(const std::vector<Vec3>& corners) {
  if (corners.size() < 3) return {};
  return EarClipper(corners).run();
}

}  // namespace hydrodip
