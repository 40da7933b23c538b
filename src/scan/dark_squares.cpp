#include "scan/dark_squares.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <deque>
#include <map>
#include <numbers>
#include <optional>

#include "base/parallel.h"
#include "object/surface.h"

namespace hydrodip {
namespace {

// Views from all sides in which squares are looked for: pixels a square, and at most so many
// pixels along a view.
constexpr double kPixelsPerSquare = 20;
constexpr int kMostPixels = 1600;
// Darker than this share of the brightness around it (over so many squares to each side) is dark:
// half way between ink and ground, where a quarter of the ground is inked.
constexpr double kDarkShare = 0.72, kAround = 2;
// Of a square's printed area; film stretches.
constexpr double kLeastArea = 0.3, kMostArea = 4;
// Seen more aslant than that (cosine), a square is left to another view.
constexpr double kLeastFacing = 0.6;
// Edges are looked at between these shares of their length, so far aside (in edges).
constexpr double kEdgeBegin = 0.12, kEdgeEnd = 0.88, kAside = 0.3;
constexpr int kAlong = 17, kAcross = 41;
// Of an edge: how much less light comes from its dark side. Pictures are blurred in light, so that
// an edge is where light, not its encoded value, is half way.
constexpr double kLeastContrast = 0.35;
constexpr int kFewestOnEdge = 9;
constexpr double kOutlier = 0.05;  // off an edge's line, in edges
constexpr int kRefinements = 3;

double light_of(const LinearColor& color) {
  return std::clamp(0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b, 0.0, 1.0);
}

// The scan's colours where rays meet it.
class Look {
 public:
  explicit Look(const Object& scan)
      : scan_(scan), surface_(scan.positions, scan.triangles), box_(scan.bounds()) {}

  const Box3& box() const { return box_; }

  struct Seen {
    Vec3 position, normal;
    double light = 0;                                                   // linear
    double brightness() const { return linear_to_srgb(float(light)); }  // as people grade it
  };
  // Of the outside only.
  std::optional<Seen> along(const Vec3& origin, const Vec3& direction, double most) const {
    const auto hit = surface_.first_hit(origin, direction, 0, most);
    if (!hit) return std::nullopt;
    const Vec3 normal = surface_.normal(*hit);
    if (normal.dot(direction) >= 0) return std::nullopt;
    const LinearColor color = color_at(scan_, {hit->triangle, hit->u, hit->v}, {1, 1, 1, 1});
    return Seen{surface_.position(*hit), normal, light_of(color)};
  }

 private:
  const Object& scan_;
  Surface surface_;
  Box3 box_;
};

// A plane that touches the surface; the surface is looked at along its normal.
struct Plane {
  Vec3 origin, x, y, normal;

  Plane(const Vec3& at, const Vec3& n)
      : origin(at), x(n.unitOrthogonal()), y(n.cross(x)), normal(n) {}
  Vec3 at(const Vec2& p) const { return origin + p.x() * x + p.y() * y; }
  Vec2 of(const Vec3& p) const { return {x.dot(p - origin), y.dot(p - origin)}; }
};

// ---- where squares are, roughly ----

// What one view shows of one dark spot.
struct Spot {
  std::vector<Vec3> point;
  Vec3 normal = Vec3::Zero(), middle = Vec3::Zero();
  double facing = 0;  // cosine
};

class ParallelView {
 public:
  ParallelView(const Look& look, const Vec3& direction, double pixel_mm)
      : plane_(look.box().center(), -direction), pixel_mm_(pixel_mm) {
    const double far = look.box().size().norm();
    side_ = std::max(8, int(std::ceil(far / pixel_mm)));
    seen_.resize(std::size_t(side_) * std::size_t(side_));
    parallel_for(std::size_t(side_), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row)
        for (int column = 0; column < side_; ++column) {
          const Vec2 p = pixel_mm_ * Vec2(column - 0.5 * side_, double(row) - 0.5 * side_);
          seen_[row * std::size_t(side_) + std::size_t(column)] =
              look.along(plane_.at(p) - far * direction, direction, 2 * far);
        }
    });
  }

  // Whole dark spots that could be squares.
  std::vector<Spot> spots(double square_mm) const {
    const std::vector<char> dark = dark_pixels(int(kAround * square_mm / pixel_mm_));
    std::vector<char> done(seen_.size(), 0);
    std::vector<Spot> list;
    for (std::size_t first = 0; first < seen_.size(); ++first) {
      if (!dark[first] || done[first]) continue;
      if (auto spot = spot_from(first, dark, done, square_mm)) list.push_back(std::move(*spot));
    }
    return list;
  }

 private:
  // By the mean around each pixel, from sums over rectangles.
  std::vector<char> dark_pixels(int reach) const {
    const auto n = std::size_t(side_) + 1;
    std::vector<double> sum(n * n, 0), count(n * n, 0);
    for (std::size_t y = 1; y < n; ++y)
      for (std::size_t x = 1; x < n; ++x) {
        const auto& seen = seen_[(y - 1) * std::size_t(side_) + x - 1];
        const std::size_t i = y * n + x;
        sum[i] = sum[i - 1] + sum[i - n] - sum[i - n - 1] + (seen ? seen->brightness() : 0);
        count[i] = count[i - 1] + count[i - n] - count[i - n - 1] + (seen ? 1 : 0);
      }
    std::vector<char> dark(seen_.size(), 0);
    for (int y = 0; y < side_; ++y)
      for (int x = 0; x < side_; ++x) {
        const std::size_t i = std::size_t(y) * std::size_t(side_) + std::size_t(x);
        if (!seen_[i]) continue;
        const auto x0 = std::size_t(std::max(0, x - reach));
        const auto y0 = std::size_t(std::max(0, y - reach));
        const auto x1 = std::size_t(std::min(side_, x + reach + 1));
        const auto y1 = std::size_t(std::min(side_, y + reach + 1));
        const auto within = [&](const std::vector<double>& s) {
          return s[y1 * n + x1] - s[y0 * n + x1] - s[y1 * n + x0] + s[y0 * n + x0];
        };
        dark[i] = seen_[i]->brightness() < kDarkShare * within(sum) / within(count);
      }
    return dark;
  }

  // The dark pixels that hang together with one; nothing if they reach out of sight, or are no
  // square by their size.
  std::optional<Spot> spot_from(std::size_t first, const std::vector<char>& dark,
                                std::vector<char>& done, double square_mm) const {
    Spot spot;
    bool whole = true;
    std::deque<std::size_t> next = {first};
    done[first] = 1;
    while (!next.empty()) {
      const std::size_t i = next.front();
      next.pop_front();
      spot.point.push_back(seen_[i]->position);
      spot.normal += seen_[i]->normal;
      const int x = int(i % std::size_t(side_)), y = int(i / std::size_t(side_));
      for (const auto& [dx, dy] :
           {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)}) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= side_ || y + dy >= side_) {
          whole = false;
          continue;
        }
        const std::size_t j = std::size_t(y + dy) * std::size_t(side_) + std::size_t(x + dx);
        if (!seen_[j]) whole = false;
        if (!dark[j] || done[j]) continue;
        done[j] = 1;
        next.push_back(j);
      }
    }
    // Over an edge of the object no square is a square.
    constexpr double kFlat = 0.97;
    const bool flat = spot.normal.norm() > kFlat * double(spot.point.size());
    spot.normal.normalize();
    spot.facing = spot.normal.dot(plane_.normal);
    for (const Vec3& p : spot.point) spot.middle += p / double(spot.point.size());
    if (!whole || !flat || !(spot.facing > kLeastFacing)) return std::nullopt;
    const double area = double(spot.point.size()) * pixel_mm_ * pixel_mm_ / spot.facing;
    if (area < kLeastArea * square_mm * square_mm || area > kMostArea * square_mm * square_mm)
      return std::nullopt;
    return spot;
  }

  Plane plane_;
  double pixel_mm_;
  int side_ = 0;
  std::vector<std::optional<Look::Seen>> seen_;
};

std::vector<Vec3> view_directions() {
  std::vector<Vec3> list;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (const int n = x * x + y * y + z * z; n == 1 || n == 3)
          list.push_back(Vec3(x, y, z).normalized());
  return list;
}

// Each of the scan's spots once, as the view sees it that faces it best.
std::vector<Spot> find_spots(const Look& look, double square_mm) {
  const double pixel_mm =
      std::max(square_mm / kPixelsPerSquare, look.box().size().norm() / kMostPixels);
  std::vector<Spot> all;
  for (const Vec3& direction : view_directions()) {
    std::vector<Spot> spots = ParallelView(look, direction, pixel_mm).spots(square_mm);
    for (Spot& spot : spots) {
      const auto known = std::find_if(all.begin(), all.end(), [&](const Spot& other) {
        return (other.middle - spot.middle).norm() < 0.4 * square_mm;
      });
      if (known == all.end())
        all.push_back(std::move(spot));
      else if (spot.facing > known->facing)
        *known = std::move(spot);
    }
  }
  return all;
}

// ---- corners ----

using Corners = std::array<Vec2, 4>;

// Of a symmetric matrix with positive eigenvalues.
Mat2 square_root(const Mat2& matrix) {
  const double root = std::sqrt(matrix.determinant());
  return (matrix + root * Mat2::Identity()) / std::sqrt(matrix.trace() + 2 * root);
}

// A spot's corners as if it were a square that was stretched evenly: by its second moments, made
// round, and which way its fourth moments then point.
Corners rough_corners(const Spot& spot, const Plane& plane) {
  Eigen::Matrix2Xd points(2, Eigen::Index(spot.point.size()));
  for (std::size_t i = 0; i < spot.point.size(); ++i)
    points.col(Eigen::Index(i)) = plane.of(spot.point[i]);
  const Vec2 middle = points.rowwise().mean();
  points.colwise() -= middle;
  Mat2 spread = Mat2::Zero();
  for (const Vec2 p : points.colwise()) spread += p * p.transpose() / double(points.cols());
  const Mat2 back = square_root(spread), round = back.inverse();
  std::complex<double> fourth = 0;
  for (const Vec2 p : points.colwise()) {
    const Vec2 q = round * p;
    const std::complex<double> second = std::pow(std::complex<double>(q.x(), q.y()), 2);
    fourth += second * second;
  }
  // Of a square along the axes the sum is below 0: its corners lie between them.
  const double turn = std::arg(-fourth) / 4;
  const double half = std::sqrt(3.0);  // of a square whose second moments are 1
  Corners corners;
  for (int k = 0; k < 4; ++k) {
    const double angle = turn + (0.25 + 0.5 * k) * std::numbers::pi;
    corners[std::size_t(k)] =
        middle + back * (std::sqrt(2.0) * half * Vec2(std::cos(angle), std::sin(angle)));
  }
  return corners;
}

// How far aside of the straight line between two corners an edge lies: a + b t + c t^2 at the share
// t of the way, outwards.
using Bend = Eigen::Vector3d;

std::optional<double> crossing(const Look& look, const Plane& plane, const Vec2& at,
                               const Vec2& outwards, double aside_mm, double above_mm) {
  std::array<double, kAcross> profile{};
  for (int i = 0; i < kAcross; ++i) {
    const double s = aside_mm * (2.0 * i / (kAcross - 1) - 1);
    const auto seen = look.along(plane.at(at + s * outwards) + above_mm * plane.normal,
                                 -plane.normal, 2 * above_mm);
    if (!seen) return std::nullopt;
    profile[std::size_t(i)] = seen->light;
  }
  constexpr int kLevel = kAcross / 4;
  double inside = 0, outside = 0;
  for (int i = 0; i < kLevel; ++i) {
    inside += profile[std::size_t(i)] / kLevel;
    outside += profile[std::size_t(kAcross - 1 - i)] / kLevel;
  }
  if (inside > (1 - kLeastContrast) * outside) return std::nullopt;
  const double middle = 0.5 * (inside + outside);
  // From the middle of the ramp: the last sample that is dark.
  for (int i = kAcross - kLevel; i > 0; --i) {
    const double before = profile[std::size_t(i - 1)], after = profile[std::size_t(i)];
    if (before < middle && after >= middle)
      return aside_mm * (2.0 * (i - 1 + (middle - before) / (after - before)) / (kAcross - 1) - 1);
  }
  return std::nullopt;
}

std::optional<Bend> edge(const Look& look, const Plane& plane, const Vec2& from, const Vec2& to) {
  const Vec2 way = to - from;
  const double length = way.norm();
  const Vec2 outwards = Vec2(way.y(), -way.x()) / length;  // corners run counter-clockwise
  std::vector<Vec2> points;                                // share, aside
  for (int i = 0; i < kAlong; ++i) {
    const double t = kEdgeBegin + (kEdgeEnd - kEdgeBegin) * i / (kAlong - 1);
    if (const auto aside =
            crossing(look, plane, from + t * way, outwards, kAside * length, 2 * length))
      points.push_back({t, *aside});
  }
  Bend bend = Bend::Zero();
  for (int round = 0; round < 3; ++round) {
    if (points.size() < kFewestOnEdge) return std::nullopt;
    Mat3 squares = Mat3::Zero();
    Bend right = Bend::Zero();
    for (const Vec2& p : points) {
      const Bend powers(1, p.x(), p.x() * p.x());
      squares += powers * powers.transpose();
      right += p.y() * powers;
    }
    bend = squares.inverse() * right;
    const std::size_t before = points.size();
    std::erase_if(points, [&](const Vec2& p) {
      return std::abs(bend.dot(Bend(1, p.x(), p.x() * p.x())) - p.y()) > kOutlier * length;
    });
    if (points.size() == before) break;
  }
  return bend;
}

// Corners where bent edges meet; nothing if an edge does not show.
std::optional<Corners> refined(const Look& look, const Plane& plane, const Corners& corners) {
  std::array<Bend, 4> bends;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto found = edge(look, plane, corners[k], corners[(k + 1) % 4]);
    if (!found) return std::nullopt;
    bends[k] = *found;
  }
  const auto on_edge = [&](std::size_t k, double t) -> Vec2 {
    const Vec2 way = corners[(k + 1) % 4] - corners[k];
    const Vec2 outwards = Vec2(way.y(), -way.x()).normalized();
    return corners[k] + t * way + bends[k].dot(Bend(1, t, t * t)) * outwards;
  };
  Corners result;
  for (std::size_t k = 0; k < 4; ++k) {
    // The end of the edge before meets the beginning of this one: Newton's steps.
    const std::size_t before = (k + 3) % 4;
    double end = 1, begin = 0;
    for (int step = 0; step < 8; ++step) {
      constexpr double kAhead = 1e-4;
      const Vec2 off = on_edge(before, end) - on_edge(k, begin);
      Eigen::Matrix2d slope;
      slope << (on_edge(before, end + kAhead) - on_edge(before, end)) / kAhead,
          -(on_edge(k, begin + kAhead) - on_edge(k, begin)) / kAhead;
      if (slope.determinant() == 0) return std::nullopt;
      const Vec2 change = slope.inverse() * -off;
      end += change.x();
      begin += change.y();
    }
    if (!(std::abs(end - 1) < 0.5 && std::abs(begin) < 0.5)) return std::nullopt;
    result[k] = on_edge(k, begin);
  }
  return result;
}

std::optional<DarkSquare> square_of(const Look& look, const Spot& spot) {
  const Plane plane(spot.middle, spot.normal);
  std::optional<Corners> corners = rough_corners(spot, plane);
  for (int i = 0; i < kRefinements && corners; ++i) corners = refined(look, plane, *corners);
  if (!corners) return std::nullopt;
  DarkSquare square;
  square.normal = spot.normal;
  for (std::size_t k = 0; k < 4; ++k) {
    const double above_mm = 2 * ((*corners)[1] - (*corners)[0]).norm();
    const auto seen =
        look.along(plane.at((*corners)[k]) + above_mm * plane.normal, -plane.normal, 2 * above_mm);
    if (!seen) return std::nullopt;
    square.corner[k] = seen->position;
  }
  return square;
}

// Opposite sides of a whole square are much alike; of one that is cut off or was not read well they
// are not.
bool is_whole(const DarkSquare& square) {
  constexpr double kMostUnlike = 0.2;
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 side = square.corner[k + 1] - square.corner[k];
    const Vec3 opposite = square.corner[(k + 3) % 4] - square.corner[k + 2];
    if ((side + opposite).norm() > kMostUnlike * std::max(side.norm(), opposite.norm()))
      return false;
  }
  return true;
}

// ---- rows and columns ----

// A square's side, and what lies beyond it.
struct Side {
  Vec3 middle, outwards;  // not of length 1: from the square's middle
};

Side side_of(const DarkSquare& square, std::size_t k) {
  const Vec3 middle = 0.5 * (square.corner[k] + square.corner[(k + 1) % 4]);
  return {middle, middle - square.middle()};
}

// The square beyond a side: of those that lie straight ahead, the nearest.
std::optional<std::size_t> ahead(const std::vector<DarkSquare>& squares, std::size_t from,
                                 std::size_t k) {
  // In half squares, along and aside; four are between middles of film that is not stretched.
  constexpr double kNearest = 2.5, kFarthest = 6.5, kMostAside = 0.45;
  const Side side = side_of(squares[from], k);
  const double half = side.outwards.norm();
  const Vec3 along = side.outwards / half;
  const Vec3 across = squares[from].normal.cross(along).normalized();
  std::optional<std::size_t> best;
  double nearest = kFarthest * half;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (i == from || squares[i].normal.dot(squares[from].normal) < 0) continue;
    const Vec3 off = squares[i].middle() - squares[from].middle();
    const double forward = along.dot(off);
    if (forward < kNearest * half || std::abs(across.dot(off)) > kMostAside * forward) continue;
    // Along the surface, which bends in the middle: straight over a tip it seems near.
    const double bend = std::sqrt(0.5 * (1 + squares[i].normal.dot(squares[from].normal)));
    if (off.norm() < nearest * bend) {
      nearest = off.norm() / bend;
      best = i;
    }
  }
  return best;
}

struct Link {
  std::size_t square = 0, side = 0;  // beyond; and that one's side which faces us
};

// Links that both squares agree on.
std::vector<std::array<std::optional<Link>, 4>> links_of(const std::vector<DarkSquare>& squares) {
  std::vector<std::array<std::optional<std::size_t>, 4>> beyond(squares.size());
  for (std::size_t i = 0; i < squares.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) beyond[i][k] = ahead(squares, i, k);
  std::vector<std::array<std::optional<Link>, 4>> links(squares.size());
  for (std::size_t i = 0; i < squares.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      if (!beyond[i][k]) continue;
      const std::size_t j = *beyond[i][k];
      const auto back = std::find(beyond[j].begin(), beyond[j].end(), std::optional(i));
      if (back != beyond[j].end()) links[i][k] = Link{j, std::size_t(back - beyond[j].begin())};
    }
  return links;
}

// Whether a square is much shorter than the one beside it in the direction in which they lie: where
// the film ends, squares may be cut off along a side.
bool is_cut_off(const std::vector<DarkSquare>& squares,
                const std::array<std::optional<Link>, 4>& links, std::size_t i) {
  constexpr double kShortest = 0.85;
  const auto length = [&](std::size_t square, std::size_t side) {
    return side_of(squares[square], side).outwards.norm();
  };
  for (std::size_t k = 0; k < links.size(); ++k)
    if (links[k] && length(i, k) < kShortest * length(links[k]->square, links[k]->side))
      return true;
  return false;
}

}  // namespace

std::vector<DarkSquare> find_dark_squares(const Object& scan, double square_mm) {
  const Look look(scan);
  const std::vector<Spot> spots = find_spots(look, square_mm);
  std::vector<std::optional<DarkSquare>> found(spots.size());
  parallel_for(spots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) found[i] = square_of(look, spots[i]);
  });
  std::vector<DarkSquare> squares;
  for (const auto& square : found)
    if (square && is_whole(*square)) squares.push_back(*square);
  return squares;
}

CornerGrid grid_of_dark_squares(const std::vector<DarkSquare>& squares) {
  // Seen from outside, sides run counter-clockwise; on the film, seen from above, clockwise:
  // +x, -y, -x, +y. The corner between a side and the next, from a square's least corner:
  constexpr GridPlace kWays[] = {{1, 0}, {0, -1}, {-1, 0}, {0, 1}};
  constexpr GridPlace kCornerAfter[] = {{1, 0}, {0, 0}, {0, 1}, {1, 1}};
  struct Lying {
    int patch = -1;
    GridPlace at{};
    std::size_t turn = 0;  // side k looks along kWays[(k + turn) % 4]
    bool left_out = false;
  };
  const auto links = links_of(squares);
  std::vector<Lying> lying(squares.size());
  int patches = 0;
  for (std::size_t first = 0; first < squares.size(); ++first) {
    if (lying[first].patch >= 0) continue;
    lying[first].patch = patches++;
    std::deque<std::size_t> next = {first};
    while (!next.empty()) {
      const std::size_t i = next.front();
      next.pop_front();
      for (std::size_t k = 0; k < 4; ++k) {
        if (!links[i][k]) continue;
        const auto& [j, facing] = *links[i][k];
        const std::size_t way = (k + lying[i].turn) % 4;
        const GridPlace at = {lying[i].at[0] + kWays[way][0], lying[i].at[1] + kWays[way][1]};
        const std::size_t turn = (way + 2 + 4 - facing) % 4;
        if (lying[j].patch < 0) {
          lying[j] = {lying[i].patch, at, turn, false};
          next.push_back(j);
        } else if (lying[j].at != at || lying[j].turn != turn) {
          lying[i].left_out = lying[j].left_out = true;
        }
      }
    }
  }
  std::map<std::array<int, 3>, std::size_t> at_place;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const auto [entry, is_new] =
        at_place.try_emplace({lying[i].patch, lying[i].at[0], lying[i].at[1]}, i);
    if (!is_new) lying[i].left_out = lying[entry->second].left_out = true;
  }
  for (std::size_t i = 0; i < squares.size(); ++i)
    if (is_cut_off(squares, links[i], i)) lying[i].left_out = true;
  CornerGrid grid;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (lying[i].left_out) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const GridPlace& corner = kCornerAfter[(k + lying[i].turn) % 4];
      grid.position.push_back(squares[i].corner[(k + 1) % 4]);
      grid.place.push_back({2 * lying[i].at[0] + corner[0], 2 * lying[i].at[1] + corner[1]});
      grid.patch.push_back(lying[i].patch);
    }
  }
  return grid;
}

}  // namespace hydrodip
