#include "scan/registration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/dense_solvers.h"
#include "base/eigenpairs.h"
#include "base/error.h"

namespace hydrodip {
namespace {

constexpr std::size_t kFewestPairs = 6;
// So many of the patch's corners have to land for a shift to count.
constexpr double kLeastOverlap = 0.7;
// A fit worse than this share of a square is none.
constexpr double kLargestMisfit = 0.5;
// A mirrored reading is believed when it fits this much better.
constexpr double kClearlyBetter = 0.6;
// How much where a corner lands counts beside its distance from the surface.
constexpr double kLandingWeight = 0.03;
constexpr int kMostRounds = 60;
constexpr double kSettled_mm = 1e-9;
constexpr double kReach_mm = 1000;

GridPlace turned(const GridPlace& place, int quarter_turns) {
  GridPlace result = place;
  for (int i = 0; i < quarter_turns; ++i) result = {-result[1], result[0]};
  return result;
}

// The corners of the largest patch, as indices; the first patch of that size.
std::vector<std::size_t> largest_patch(const CornerGrid& grid) {
  std::map<int, std::vector<std::size_t>> patches;
  for (std::size_t c = 0; c < grid.patch.size(); ++c) patches[grid.patch[c]].push_back(c);
  std::vector<std::size_t> largest;
  for (const auto& [number, corners] : patches)
    if (corners.size() > largest.size()) largest = corners;
  return largest;
}

// Places of simulated corners, looked up once.
class Landings {
 public:
  Landings(const GridLanding& landing, const GridPlace& reach) {
    for (int row = -reach[1]; row <= reach[1]; ++row)
      for (int column = -reach[0]; column <= reach[0]; ++column)
        if (const auto at = landing({column, row})) {
          position_[{column, row}] = *at;
          low_ = {std::min(low_[0], column), std::min(low_[1], row)};
          high_ = {std::max(high_[0], column), std::max(high_[1], row)};
        }
  }
  const Vec3* find(const GridPlace& place) const {
    const auto found = position_.find(place);
    return found == position_.end() ? nullptr : &found->second;
  }
  bool empty() const { return position_.empty(); }
  const GridPlace& low() const { return low_; }
  const GridPlace& high() const { return high_; }

 private:
  std::map<GridPlace, Vec3> position_;
  GridPlace low_{1 << 20, 1 << 20}, high_{-(1 << 20), -(1 << 20)};
};

// One way to read the scan: mirrored positions or not, mirrored places or not, and where they lie.
struct Reading {
  bool mirror_positions = false, mirror_places = false;
  std::vector<GridPlace> place;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  double rms_mm = 1e300;
};

// The rigid motion of a reading, and what is left.
void fit_rigidly(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to, Reading& reading) {
  reading.pose = rigid_motion(from, to);
  const Eigen::Matrix3Xd left =
      (reading.pose.linear() * from).colwise() + reading.pose.translation() - to;
  reading.rms_mm = std::sqrt(left.squaredNorm() / double(from.cols()));
}

Vec3 mirrored(const Vec3& p, bool mirror) { return mirror ? Vec3(-p.x(), p.y(), p.z()) : p; }

// The best reading of one kind.
class Matcher {
 public:
  Matcher(const CornerGrid& grid, const std::vector<std::size_t>& corners, const Landings& landings)
      : grid_(grid), corners_(corners), landings_(landings) {}

  Reading best(bool mirror_positions, bool mirror_places) const {
    Reading best;
    best.mirror_positions = mirror_positions;
    best.mirror_places = mirror_places;
    for (int turns = 0; turns < 4; ++turns) {
      std::vector<GridPlace> places;
      GridPlace low{1 << 20, 1 << 20}, high{-(1 << 20), -(1 << 20)};
      for (const std::size_t c : corners_) {
        GridPlace place = grid_.place[c];
        if (mirror_places) place[0] = -place[0];
        places.push_back(turned(place, turns));
        for (std::size_t k = 0; k < 2; ++k) {
          low[k] = std::min(low[k], places.back()[k]);
          high[k] = std::max(high[k], places.back()[k]);
        }
      }
      // Shifts that leave no more than a strip outside.
      const GridPlace slack = {(high[0] - low[0]) / 8 + 1, (high[1] - low[1]) / 8 + 1};
      for (int dy = landings_.low()[1] - low[1] - slack[1];
           dy <= landings_.high()[1] - high[1] + slack[1]; ++dy)
        for (int dx = landings_.low()[0] - low[0] - slack[0];
             dx <= landings_.high()[0] - high[0] + slack[0]; ++dx)
          consider(places, {dx, dy}, best);
    }
    return best;
  }

 private:
  void consider(const std::vector<GridPlace>& places, const GridPlace& shift, Reading& best) const {
    Reading reading = {best.mirror_positions, best.mirror_places, places, {}, 0};
    Eigen::Matrix3Xd from(3, Eigen::Index(places.size())), to(3, Eigen::Index(places.size()));
    Eigen::Index count = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      reading.place[i] = {places[i][0] + shift[0], places[i][1] + shift[1]};
      const Vec3* lands = landings_.find(reading.place[i]);
      if (lands == nullptr) continue;
      from.col(count) = mirrored(grid_.position[corners_[i]], best.mirror_positions);
      to.col(count) = *lands;
      ++count;
    }
    if (double(count) < kLeastOverlap * double(places.size()) || count < 3) return;
    fit_rigidly(from.leftCols(count), to.leftCols(count), reading);
    // Readings that differ by rounding alone are the same to us: the first one counts.
    if (reading.rms_mm < best.rms_mm * (1 - 1e-6)) best = reading;
  }

  const CornerGrid& grid_;
  const std::vector<std::size_t>& corners_;
  const Landings& landings_;
};

void refuse_mismatch(const Reading& best, double square_mm, const std::string& name) {
  if (best.rms_mm > 1e299)
    throw InputError(fmt::format(
        "{}: the scan shows more squares than can come to lie on this object at this depth; check "
        "which object was scanned, --square and the depth",
        name));
  if (best.rms_mm > kLargestMisfit * square_mm)
    throw InputError(fmt::format(
        "{}: the scan does not have the object's shape: at best its corners lie {:.1f} mm from "
        "where the film lays them; check which object was scanned, its depth and --square",
        name, best.rms_mm));
}

// Rows of the linear system for one corner: the motion is a turn w about the origin and a shift t.
struct NormalEquations {
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();

  // Wants direction . (motion of p) to be `wanted`.
  void add(const Vec3& p, const Vec3& direction, double wanted, double weight) {
    Eigen::Matrix<double, 6, 1> row;
    row << p.cross(direction), direction;
    matrix += weight * weight * row * row.transpose();
    right += weight * weight * wanted * row;
  }
};

std::array<Vec3, 2> tangents(const Vec3& normal) {
  const Vec3 first = normal.unitOrthogonal();
  return {first, normal.cross(first)};
}

// Finds how one patch lies, by trying all that one of its corners could be.
class PatchPlacer {
 public:
  PatchPlacer(const CornerGrid& grid, const Eigen::Isometry3d& pose, bool turned,
              const Landings& landings, double square_mm)
      : grid_(grid), pose_(pose), turned_(turned), landings_(landings), square_mm_(square_mm) {}

  // The corners' places, or nothing.
  std::vector<GridPlace> places(const std::vector<std::size_t>& corners) const {
    return best(corners, kLargestMisfit * square_mm_).places;
  }

  // How far the corners are, rms, from the nearest that they could be; endless if there are none.
  double nearest_mm(const std::vector<std::size_t>& corners) const {
    return best(corners, 1e299).misfit_mm;
  }

 private:
  struct Placing {
    std::vector<GridPlace> places;
    double misfit_mm = 1e300;
  };

  Placing best(const std::vector<std::size_t>& corners, double limit_mm) const {
    Placing best;
    double least_mm = limit_mm;
    for (int turns = 0; turns < 4; ++turns)
      for (int row = landings_.low()[1]; row <= landings_.high()[1]; ++row)
        for (int column = landings_.low()[0]; column <= landings_.high()[0]; ++column) {
          const Vec3* lands = landings_.find({column, row});
          if (lands == nullptr) continue;
          if ((*lands - pose_ * grid_.position[anchor(corners)]).norm() > square_mm_) continue;
          std::vector<GridPlace> candidate = laid(corners, turns, {column, row});
          const double misfit_mm = misfit(corners, candidate);
          if (misfit_mm < least_mm * (1 - 1e-6)) {
            least_mm = misfit_mm;
            best = {std::move(candidate), misfit_mm};
          }
        }
    return best;
  }

  // One amidst them, which lands if any does.
  static std::size_t anchor(const std::vector<std::size_t>& corners) {
    return corners[corners.size() / 2];
  }

  std::vector<GridPlace> laid(const std::vector<std::size_t>& corners, int turns,
                              const GridPlace& at) const {
    std::vector<GridPlace> places;
    for (const std::size_t c : corners) {
      GridPlace place = grid_.place[c];
      if (turned_) place[0] = -place[0];
      places.push_back(hydrodip::turned(place, turns));
    }
    const GridPlace from = places[places.size() / 2];
    const GridPlace shift = {at[0] - from[0], at[1] - from[1]};
    for (GridPlace& place : places) place = {place[0] + shift[0], place[1] + shift[1]};
    return places;
  }

  // Root mean square; endless if too few of them land.
  double misfit(const std::vector<std::size_t>& corners,
                const std::vector<GridPlace>& places) const {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3* lands = landings_.find(places[i]);
      if (lands == nullptr) continue;
      sum += (*lands - pose_ * grid_.position[corners[i]]).squaredNorm();
      ++count;
    }
    return count < kLeastOverlap * double(corners.size()) ? 1e300 : std::sqrt(sum / count);
  }

  const CornerGrid& grid_;
  const Eigen::Isometry3d& pose_;
  bool turned_;
  const Landings& landings_;
  double square_mm_;
};

}  // namespace

GridPlace reach_of(const FilmOptions& film, double square_mm) {
  return {int(0.5 * film.width_mm / square_mm), int(0.5 * film.height_mm / square_mm)};
}

Eigen::Isometry3d rigid_motion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  // Horn 1987: the unit quaternion of the turn belongs to the largest eigenvalue.
  const Vec3 from_middle = from.rowwise().mean(), to_middle = to.rowwise().mean();
  const Mat3 s = (from.colwise() - from_middle) * (to.colwise() - to_middle).transpose();
  Eigen::Matrix4d by_quaternion;
  by_quaternion << s.trace(), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0),   //
      s(1, 2) - s(2, 1), 2 * s(0, 0) - s.trace(), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2),  //
      s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), 2 * s(1, 1) - s.trace(), s(1, 2) + s(2, 1),  //
      s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), 2 * s(2, 2) - s.trace();
  const Eigen::VectorXd q = eigenpairs(by_quaternion).vectors.col(3);
  Eigen::Isometry3d motion(Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
  motion.pretranslate(to_middle - motion * from_middle);
  return motion;
}

Eigen::Isometry3d moved_a_little(const Eigen::Isometry3d& pose, const Vec3& shift,
                                 const Vec3& turn) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  const double angle = turn.norm();
  if (angle > 0) motion.rotate(Eigen::AngleAxisd(angle, turn / angle));
  motion.pretranslate(shift);
  return motion * pose;
}

void place_patches(const CornerGrid& grid, const Eigen::Isometry3d& pose, bool turned,
                   const GridLanding& landing, const GridPlace& reach, double square_mm,
                   std::vector<std::optional<GridPlace>>& place) {
  const Landings landings(landing, reach);
  if (landings.empty()) return;
  std::map<int, std::vector<std::size_t>> patches;
  for (std::size_t c = 0; c < grid.patch.size(); ++c)
    if (!place[c]) patches[grid.patch[c]].push_back(c);
  const PatchPlacer placer(grid, pose, turned, landings, square_mm);
  for (const auto& [number, corners] : patches) {
    const std::vector<GridPlace> found = placer.places(corners);
    for (std::size_t i = 0; i < found.size(); ++i) place[corners[i]] = found[i];
  }
}

std::string why_unplaced(const CornerGrid& grid, const Surface& surface, const GridLanding& landing,
                         const GridPlace& reach, double square_mm) {
  constexpr double kOffObject_mm = 2;
  const double off_mm = as_it_lies(grid, surface).rms_mm;
  if (off_mm > kOffObject_mm)
    return fmt::format(
        "its corners lie {:.1f} mm off the object's surface (root mean square), so the scan is not "
        "in the posed object's frame; leave out --aligned to have it laid on the object",
        off_mm);
  const Landings landings(landing, reach);
  const Eigen::Isometry3d as_given = Eigen::Isometry3d::Identity();
  const PatchPlacer placer(grid, as_given, false, landings, square_mm);
  const double nearest_mm = landings.empty() ? 1e300 : placer.nearest_mm(largest_patch(grid));
  if (nearest_mm > 1e299)
    return "its corners lie where no film of this job lands; check which object was scanned, its "
           "pose and depth, and --square";
  return fmt::format(
      "its corners lie {:.2f} mm (root mean square) from the nearest of the board as this job lays "
      "it, half a square of {:g} mm or more, so that none can be told from its neighbours; leave "
      "out --aligned to have the scan laid on the object, or check --square and --board",
      nearest_mm, square_mm);
}

CornerGrid moved(const CornerGrid& grid, const Eigen::Isometry3d& pose) {
  CornerGrid result = grid;
  for (Vec3& p : result.position) p = pose * p;
  return result;
}

GridMatch match_grid(const CornerGrid& grid, const GridLanding& landing, const GridPlace& reach,
                     double square_mm, const std::string& name) {
  const std::vector<std::size_t> corners = largest_patch(grid);
  if (corners.size() < kFewestPairs)
    throw InputError(fmt::format(
        "{}: no more than {} corners hang together, too few to find out where they lie on the "
        "object; give a table of corners, or a scan in the object's frame with --aligned",
        name, corners.size()));
  const Landings landings(landing, reach);
  const Matcher matcher(grid, corners, landings);
  Reading best = matcher.best(false, false);
  const Reading turned = matcher.best(false, true);
  const Reading mirror =
      std::min(matcher.best(true, true), matcher.best(true, false),
               [](const Reading& a, const Reading& b) { return a.rms_mm < b.rms_mm; });

  GridMatch match;
  if (turned.rms_mm < kClearlyBetter * best.rms_mm) {
    best = turned;
    match.turned = true;
  }
  match.mirrored = mirror.rms_mm < kClearlyBetter * best.rms_mm;
  if (!match.mirrored) refuse_mismatch(best, square_mm, name);
  match.place.resize(grid.position.size());
  for (std::size_t i = 0; i < corners.size() && i < best.place.size(); ++i)
    match.place[corners[i]] = best.place[i];
  match.pose = best.pose;
  match.rms_mm = best.rms_mm;
  return match;
}

Alignment align(const CornerGrid& grid, const GridMatch& match, const Surface& surface,
                const GridLanding& landing) {
  std::vector<std::optional<Vec3>> lands(grid.position.size());
  for (std::size_t c = 0; c < lands.size(); ++c)
    if (match.place[c]) lands[c] = landing(*match.place[c]);
  Eigen::Isometry3d pose = match.pose;
  for (int round = 0; round < kMostRounds; ++round) {
    NormalEquations equations;
    for (std::size_t c = 0; c < grid.position.size(); ++c) {
      const Vec3 p = pose * grid.position[c];
      const auto hit = surface.closest_point(p, kReach_mm);
      if (!hit) continue;
      const Vec3 normal = surface.normal(*hit);
      equations.add(p, normal, normal.dot(surface.position(*hit) - p), 1);
      if (!lands[c]) continue;
      for (const Vec3& tangent : tangents(normal))
        equations.add(p, tangent, tangent.dot(*lands[c] - p), kLandingWeight);
    }
    // A trace of damping: a motion that nothing determines is none.
    for (int k = 0; k < 6; ++k) equations.matrix(k, k) *= 1 + 1e-12;
    const Eigen::Matrix<double, 6, 1> step = solve_symmetric(equations.matrix, equations.right);
    if (!step.allFinite()) break;
    pose = moved_a_little(pose, step.tail<3>(), step.head<3>());
    if (step.norm() < kSettled_mm) break;
  }
  Alignment alignment = as_it_lies(moved(grid, pose), surface);
  alignment.pose = pose;
  return alignment;
}

Alignment as_it_lies(const CornerGrid& grid, const Surface& surface) {
  Alignment alignment;
  double sum = 0;
  for (const Vec3& p : grid.position) {
    const auto hit = surface.closest_point(p, kReach_mm);
    const double distance = hit ? hit->t : kReach_mm;
    sum += distance * distance;
    alignment.worst_mm = std::max(alignment.worst_mm, distance);
  }
  if (!grid.position.empty()) alignment.rms_mm = std::sqrt(sum / double(grid.position.size()));
  return alignment;
}

}  // namespace hydrodip
