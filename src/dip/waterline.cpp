#include "dip/waterline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/parallel.h"

namespace hydrodip {

namespace {

// Share of its length by which a segment reaches beyond its ends, so that nothing slips out between
// two segments.
constexpr double kEndSlack = 1e-6;
// The line's direction at a point is the mean over what lies this near, in grid cells: what the
// film does must not jump where a way slips round an edge of the object.
constexpr double kBlurred = 0.1;
// Cosine of directions that belong to the other side of a wall.
constexpr double kOtherSide = -0.5;
// What lies this little above the water counts as reached by it.
constexpr double kNearSlack_mm = 0.01;
// What is below the water by rounding only is not below it.
constexpr double kRounding_mm = 1e-6;
// Triangles near the water are gathered for so many moves like the last one.
constexpr double kNearMoves = 16;
// Nothing is known of what was below the water before the first moment.
constexpr double kEverBelow = 1e300;
// Ways that pass what lies between two moments further off than this do not touch it.
constexpr double kTouchSlack_mm = 0.01;
// Triangles that follow each other in a mesh lie together, mostly: runs of so many are left out at
// once.
constexpr std::size_t kRun = 32;
// Along each side of the grid over the whole object, however large that is.
constexpr double kMostCells = 2000;

double bottom(const std::vector<Vec3>& p, const Triangle& t) {
  return std::min({p[std::size_t(t[0])].z(), p[std::size_t(t[1])].z(), p[std::size_t(t[2])].z()});
}
double top(const std::vector<Vec3>& p, const Triangle& t) {
  return std::max({p[std::size_t(t[0])].z(), p[std::size_t(t[1])].z(), p[std::size_t(t[2])].z()});
}

std::array<Vec3, 8> corners_of_box(const Box3& box) {
  std::array<Vec3, 8> corners;
  for (std::size_t k = 0; k < 8; ++k)
    corners[k] = Vec3((k & 1 ? box.max : box.min).x(), (k & 2 ? box.max : box.min).y(),
                      (k & 4 ? box.max : box.min).z());
  return corners;
}

// Lowest and highest that anything in the box can be, in the sinking frame.
std::pair<double, double> heights_of(const Box3& box, const Moment& moment) {
  const double middle = moment.sinking_z(box.center());
  const double half = 0.5 * moment.turn.row(2).cwiseAbs().dot(box.size());
  return {middle - half - kRounding_mm, middle + half + kRounding_mm};
}

// Of the part of a segment in a circle.
double length_within(const Vec2& a, const Vec2& b, const Vec2& centre, double radius) {
  const double length = (b - a).norm();
  if (!(length > 0)) return 0;
  const Vec2 along = (b - a) / length;
  const double foot = (centre - a).dot(along), beside = cross2(along, centre - a);
  const double half2 = radius * radius - beside * beside;
  if (!(half2 > 0)) return 0;
  const double half = std::sqrt(half2);
  return std::max(0.0, std::min(length, foot + half) - std::max(0.0, foot - half));
}

}  // namespace

Waterline::Waterline(const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                     double cell_mm)
    : positions_(positions), triangles_(triangles), cell_(cell_mm) {
  runs_.resize((triangles.size() + kRun - 1) / kRun);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::int32_t v : triangles[t]) runs_[t / kRun].add(positions[std::size_t(v)]);
  for (const Box3& run : runs_) {
    box_.add(run.min);
    box_.add(run.max);
  }
}

void Waterline::move_to(const Moment& to) {
  segments_.clear();
  swept_ = {};
  ++moves_;
  if (triangles_.empty()) return;
  if (to.moved)
    pass(to);
  else
    rise_to(to.level_mm);
  build_grid();
}

void Waterline::cover(const Box2& plan) {
  whole_ = Cells(plan, std::max(cell_, (plan.max - plan.min).maxCoeff() / kMostCells));
  reached_.assign(whole_.count(), 0);
}

void Waterline::sort_by_bottom() {
  std::vector<double> bottoms;
  for (const Triangle& t : triangles_) bottoms.push_back(bottom(positions_, t));
  by_bottom_.resize(triangles_.size());
  std::iota(by_bottom_.begin(), by_bottom_.end(), 0);
  std::stable_sort(by_bottom_.begin(), by_bottom_.end(), [&](std::int32_t a, std::int32_t b) {
    return bottoms[std::size_t(a)] < bottoms[std::size_t(b)];
  });
  Box2 plan;
  plan.add(box_.min.head<2>());
  plan.add(box_.max.head<2>());
  cover(plan);
}

void Waterline::rise_to(double level) {
  if (by_bottom_.empty()) sort_by_bottom();
  const auto reach_of = [&](std::int32_t triangle) {
    Box2 box;
    for (std::int32_t v : triangles_[std::size_t(triangle)])
      box.add(positions_[std::size_t(v)].head<2>());
    return Reach{triangle, box, whole_.around(box.min, box.max)};
  };
  while (next_ < by_bottom_.size() &&
         bottom(positions_, triangles_[std::size_t(by_bottom_[next_])]) < level)
    active_.push_back(reach_of(by_bottom_[next_++]));
  for (const Reach& reach : active_) mark(reach);
  for (std::size_t n = next_; n < by_bottom_.size(); ++n) {
    if (bottom(positions_, triangles_[std::size_t(by_bottom_[n])]) > level + kNearSlack_mm) break;
    mark(reach_of(by_bottom_[n]));
  }
  std::erase_if(active_, [&](const Reach& reach) {
    return top(positions_, triangles_[std::size_t(reach.triangle)]) < level;
  });
  for (const Reach& reach : active_) {
    const Triangle& t = triangles_[std::size_t(reach.triangle)];
    cut({&positions_[std::size_t(t[0])], &positions_[std::size_t(t[1])],
         &positions_[std::size_t(t[2])]},
        level);
  }
}

void Waterline::pass(const Moment& to) {
  Change before = change_;
  if (gathered_) change_ = change_since_gathered(to);
  if (!gathered_ || change_.least < -margin_ || change_.most > margin_) {
    gather(to);
    before = now_ ? change_since_gathered(*now_) : Change{0, kEverBelow};
    change_ = {};
  }
  const double low = gathered_->level_mm - kRounding_mm - std::max(before.most, change_.most);
  const double high = gathered_->level_mm + kNearSlack_mm - std::min(before.least, change_.least);
  for (const Near& near : near_) {
    if (near.bottom > high || near.top < low) continue;
    const Corners corners = corners_of(near.triangle, to);
    Box2 box;
    for (const Vec3& corner : corners) box.add(corner.head<2>());
    if (now_)
      for (const Vec3& corner : corners_of(near.triangle, *now_)) box.add(corner.head<2>());
    mark({near.triangle, box, whole_.around(box.min, box.max)});
    cut({&corners[0], &corners[1], &corners[2]}, to.level_mm);
  }
  now_ = to;
}

// The height of a point over the water is linear in the point: the box's corners bound its change.
Waterline::Change Waterline::change_since_gathered(const Moment& to) const {
  Change total{1e300, -1e300};
  for (const Vec3& corner : corners_of_box(box_)) {
    const double change = to.height(corner) - gathered_->height(corner);
    total.least = std::min(total.least, change);
    total.most = std::max(total.most, change);
  }
  return total;
}

// Everything that may be at the water until the next time, and that has been since the last moment.
void Waterline::gather(const Moment& to) {
  gathered_ = to;
  const Change since = now_ ? change_since_gathered(*now_) : Change{0, kEverBelow};
  const double last = now_ ? std::max(-since.least, since.most) : cell_ / kNearMoves;
  margin_ = kNearMoves * last;
  // Of the object's whole height, what can be near: in the sinking frame.
  const double low = to.level_mm - std::max(margin_, since.most) - kRounding_mm;
  const double high = to.level_mm + margin_ + kNearSlack_mm;
  constexpr std::size_t kRunsPerTask = 256;
  std::vector<std::vector<Near>> found((runs_.size() + kRunsPerTask - 1) / kRunsPerTask);
  parallel_for(runs_.size(), kRunsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t run = begin; run < end; ++run) {
      const auto [bottom, top] = heights_of(runs_[run], to);
      if (bottom > high || top < low) continue;
      const std::size_t last = std::min((run + 1) * kRun, triangles_.size());
      for (std::size_t t = run * kRun; t < last; ++t) {
        const auto z = [&](std::size_t k) {
          return to.sinking_z(positions_[std::size_t(triangles_[t][k])]);
        };
        const double a = z(0), b = z(1), c = z(2);
        const Near near{std::int32_t(t), std::min({a, b, c}), std::max({a, b, c})};
        if (near.bottom <= high && near.top >= low) found[begin / kRunsPerTask].push_back(near);
      }
    }
  });
  near_.clear();
  for (const std::vector<Near>& part : found) near_.insert(near_.end(), part.begin(), part.end());
  Box2 plan;
  for (const Vec3& corner : corners_of_box(box_)) plan.add(to.to_sinking(corner).head<2>());
  cover(plan);
}

Waterline::Corners Waterline::corners_of(std::int32_t triangle, const Moment& moment) const {
  const Triangle& t = triangles_[std::size_t(triangle)];
  return {moment.to_sinking(positions_[std::size_t(t[0])]),
          moment.to_sinking(positions_[std::size_t(t[1])]),
          moment.to_sinking(positions_[std::size_t(t[2])])};
}

void Waterline::mark(const Reach& reach) {
  swept_.add(reach.box.min);
  swept_.add(reach.box.max);
  for (int y = reach.cells.y0; y <= reach.cells.y1; ++y)
    for (int x = reach.cells.x0; x <= reach.cells.x1; ++x) reached_[whole_.number(x, y)] = moves_;
}

bool Waterline::may_touch(const Vec2& a, const Vec2& b) const {
  const Vec2 slack(kTouchSlack_mm, kTouchSlack_mm);
  const Vec2 min = a.cwiseMin(b) - slack, max = a.cwiseMax(b) + slack;
  if ((min - swept_.max).maxCoeff() > 0 || (swept_.min - max).maxCoeff() > 0) return false;
  const CellRange cells = whole_.around(min, max);
  for (int y = cells.y0; y <= cells.y1; ++y)
    for (int x = cells.x0; x <= cells.x1; ++x)
      if (reached_[whole_.number(x, y)] == moves_) return true;
  return false;
}

// A corner at exactly the level counts as above it, so every triangle is cut in 0 or 2 edges.
void Waterline::cut(const std::array<const Vec3*, 3>& p, double level) {
  Vec2 ends[2];
  int found = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 *a = p[k], *b = p[(k + 1) % 3];
    if ((a->z() >= level) == (b->z() >= level)) continue;
    // From the lower end, so that both triangles of an edge cut it at the same point.
    if (a->z() > b->z()) std::swap(a, b);
    const double s = (level - a->z()) / (b->z() - a->z());
    if (found < 2) ends[found++] = a->head<2>() + s * (b->head<2>() - a->head<2>());
  }
  if (found < 2) return;
  const Vec3 n = (*p[1] - *p[0]).cross(*p[2] - *p[0]);
  const double horizontal = n.head<2>().norm();
  if (!(horizontal > 0)) return;
  Segment segment;
  segment.a = ends[0];
  segment.b = ends[1];
  segment.outward = n.head<2>() / horizontal;
  // On the surface n . (run * outward, dz) = 0.
  segment.steepness = std::abs(n.z()) * kWall > horizontal ? -horizontal / n.z() : kWall;
  segments_.push_back(segment);
}

void Waterline::build_grid() {
  Box2 box;
  for (const Segment& s : segments_) {
    box.add(s.a);
    box.add(s.b);
  }
  grid_ = {};
  if (segments_.empty()) return;
  grid_ = Cells(box, cell_);
  for (Segment& s : segments_) s.cells = grid_.around(s.a.cwiseMin(s.b), s.a.cwiseMax(s.b));
  const auto for_cells = [&](const Segment& s, const auto& visit) {
    for (int y = s.cells.y0; y <= s.cells.y1; ++y)
      for (int x = s.cells.x0; x <= s.cells.x1; ++x) visit(grid_.number(x, y));
  };
  grid_begin_.assign(grid_.count() + 1, 0);
  for (const Segment& s : segments_) for_cells(s, [&](std::size_t c) { ++grid_begin_[c + 1]; });
  for (std::size_t c = 1; c < grid_begin_.size(); ++c) grid_begin_[c] += grid_begin_[c - 1];
  grid_items_.resize(std::size_t(grid_begin_.back()));
  std::vector<std::int32_t> fill(grid_begin_.begin(), grid_begin_.end() - 1);
  for (std::size_t i = 0; i < segments_.size(); ++i)
    for_cells(segments_[i], [&](std::size_t c) {
      grid_items_[std::size_t(fill[c]++)] = static_cast<std::int32_t>(i);
    });
}

std::optional<Waterline::Point> Waterline::exit(const Vec2& from, const Vec2& to) const {
  if (segments_.empty()) return std::nullopt;
  const Vec2 way = to - from;
  double best = 2;
  const Segment* found = nullptr;
  const CellRange cells = grid_.around(from.cwiseMin(to), from.cwiseMax(to));
  for (int y = cells.y0; y <= cells.y1; ++y)
    for (int x = cells.x0; x <= cells.x1; ++x) {
      const std::size_t c = grid_.number(x, y);
      for (auto n = grid_begin_[c]; n < grid_begin_[c + 1]; ++n) {
        const Segment& s = segments_[std::size_t(grid_items_[std::size_t(n)])];
        if (way.dot(s.outward) <= 0) continue;
        const Vec2 edge = s.b - s.a;
        const double det = cross2(way, edge);
        if (det == 0) continue;
        const double along = cross2(s.a - from, edge) / det;
        const double across = cross2(s.a - from, way) / det;
        if (along < 0 || along > 1 || along >= best) continue;
        if (across < -kEndSlack || across > 1 + kEndSlack) continue;
        best = along;
        found = &s;
      }
    }
  if (!found) return std::nullopt;
  return blurred({from + best * way, found->outward, found->steepness},
                 [&](const Segment& s) { return std::max(0.0, way.dot(s.outward)); });
}

// With the direction that the line around the point has on average, its parts weighed.
template <class Weight>
Waterline::Point Waterline::blurred(const Point& point, const Weight& weight_of) const {
  const double radius = kBlurred * cell_;
  Vec2 outward = Vec2::Zero();
  double steepness = 0, weights = 0;
  const Vec2 reach(radius, radius);
  const CellRange cells = grid_.around(point.position - reach, point.position + reach);
  for (int y = cells.y0; y <= cells.y1; ++y)
    for (int x = cells.x0; x <= cells.x1; ++x) {
      const std::size_t c = grid_.number(x, y);
      for (auto n = grid_begin_[c]; n < grid_begin_[c + 1]; ++n) {
        const Segment& s = segments_[std::size_t(grid_items_[std::size_t(n)])];
        // Once, though it is listed in several cells.
        if (x != std::max(cells.x0, s.cells.x0) || y != std::max(cells.y0, s.cells.y0)) continue;
        const double weight = length_within(s.a, s.b, point.position, radius) * weight_of(s);
        outward += weight * s.outward;
        steepness += weight * s.steepness;
        weights += weight;
      }
    }
  if (!(weights > 0) || !(outward.norm() > 0)) return point;
  return {point.position, outward.normalized(), steepness / weights};
}

std::optional<Waterline::Point> Waterline::closest(const Vec2& point, double max_distance) const {
  if (segments_.empty()) return std::nullopt;
  double best = max_distance * max_distance;
  const Segment* found = nullptr;
  Vec2 position = point;
  const int cx = static_cast<int>(std::floor((point.x() - grid_.origin.x()) / cell_));
  const int cy = static_cast<int>(std::floor((point.y() - grid_.origin.y()) / cell_));
  const int rings = static_cast<int>(std::ceil(max_distance / cell_)) + 1;
  const auto visit = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= grid_.nx || y >= grid_.ny) return;
    const std::size_t c = grid_.number(x, y);
    for (auto n = grid_begin_[c]; n < grid_begin_[c + 1]; ++n) {
      const Segment& s = segments_[std::size_t(grid_items_[std::size_t(n)])];
      const Vec2 edge = s.b - s.a;
      const double length2 = edge.squaredNorm();
      const double at = length2 > 0 ? std::clamp((point - s.a).dot(edge) / length2, 0.0, 1.0) : 0.0;
      const Vec2 candidate = s.a + at * edge;
      const double distance2 = (candidate - point).squaredNorm();
      if (distance2 < best) {
        best = distance2;
        found = &s;
        position = candidate;
      }
    }
  };
  for (int ring = 0; ring <= rings; ++ring) {
    // Cells of this ring are at least (ring - 1) cells away.
    if (found && best < std::pow(std::max(0, ring - 1) * cell_, 2)) break;
    for (int x = cx - ring; x <= cx + ring; ++x) {
      visit(x, cy - ring);
      if (ring > 0) visit(x, cy + ring);
    }
    for (int y = cy - ring + 1; y <= cy + ring - 1; ++y) {
      visit(cx - ring, y);
      visit(cx + ring, y);
    }
  }
  if (!found) return std::nullopt;
  return blurred({position, found->outward, found->steepness}, [&](const Segment& s) {
    return found->outward.dot(s.outward) > kOtherSide ? 1.0 : 0.0;
  });
}

}  // namespace hydrodip
