#include "air/air.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <utility>

#include "air/cells.h"
#include "air/flood.h"
#include "air/mouths.h"
#include "air/pocket_surface.h"
#include "base/parallel.h"
#include "base/run_scope.h"
#include "dip/travel.h"
#include "object/append.h"

namespace hydrodip {

namespace {

// Fewer cells than this, and a hollow is no larger than what the cells get wrong.
constexpr std::size_t kLeastCells = 12;
// A path that turns is looked at so often.
constexpr int kLeastMoments = 64, kMostMoments = 256;
// The lids lie this far above the plane at which a pocket closes, where it is closed for certain.
constexpr double kLidLift_mm = 2e-3;
// Holes in the surface up to so many cells wide may lie between the lines of the grid.
constexpr double kSmallHole = 4;
// Volumes by surface and by cells that differ by more: the surface has no clear inside.
constexpr double kVolumeAgrees = 0.3;

// Tilts: looked for on a grid of so many cells around the pocket, in so many directions.
constexpr std::size_t kTiltCells = 30000;
constexpr int kTiltDirections = 8;
constexpr double kCoarseTilt_deg = 10, kFineTilt_deg = 2, kMostTilt_deg = 85;
constexpr double kHardlyAny = 0.02;   // of a pocket's cells
constexpr double kMostlyOpen = 0.25;  // likewise

using Numbers = std::vector<std::uint16_t>;

// The moments at which cells are asked whether they are under water.
class Moments {
 public:
  Moments(const Travel& travel, double cell_mm)
      : straight_(travel.trajectory().is_straight_down()) {
    const double wanted = std::ceil(travel.length_mm() / cell_mm);
    count_ = straight_ ? int(std::clamp(wanted, 1.0, 20000.0))
                       : int(std::clamp(wanted, double(kLeastMoments), double(kMostMoments)));
    length_ = travel.length_mm();
    for (int m = straight_ ? count_ : 0; m <= count_; ++m)
      levels_.push_back(water_at(travel.at(travelled_mm(m))));
  }

  int count() const { return count_; }
  double travelled_mm(int moment) const { return length_ * moment / count_; }
  // Where the water stands: what lies under none of them stays dry. Straight down, the last alone.
  const std::vector<Plane>& levels() const { return levels_; }

  // The first one at which a point is under water; count() + 1: none.
  std::uint16_t wet(const Vec3& point) const {
    if (straight_) {
      const double m = std::ceil(point.z() / length_ * count_ - 1e-9);
      return std::uint16_t(std::clamp(m, 0.0, double(count_ + 1)));
    }
    for (int m = 0; m <= count_; ++m)
      if (levels_[std::size_t(m)].height(point) <= 0) return std::uint16_t(m);
    return std::uint16_t(count_ + 1);
  }

 private:
  bool straight_;
  int count_ = 1;
  double length_ = 0;
  std::vector<Plane> levels_;
};

Numbers numbers(const AirCells& cells, const std::function<std::uint16_t(const Vec3&)>& number) {
  Numbers result(cells.count());
  parallel_for(result.size(), kElementGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) result[cell] = number(cells.center(cell));
  });
  return result;
}

// Cells of one pocket, in the order in which they hang together.
struct Hollow {
  std::vector<std::uint32_t> cells;
  std::uint16_t closed = 0;
};

std::vector<Hollow> hollows(const AirCells& cells, const Flood& flood, const Numbers& wet, int last,
                            std::vector<std::int32_t>& hollow_of) {
  hollow_of.assign(cells.count(), -1);
  std::vector<Hollow> found;
  for (std::size_t start = 0; start < cells.count(); ++start) {
    if (hollow_of[start] >= 0 || !flood.is_trapped(start, wet) || flood.closed[start] > last)
      continue;
    Hollow hollow{{std::uint32_t(start)}, flood.closed[start]};
    hollow_of[start] = std::int32_t(found.size());
    for (std::size_t k = 0; k < hollow.cells.size(); ++k)
      cells.for_linked(hollow.cells[k], [&](std::size_t next) {
        if (hollow_of[next] >= 0 || !flood.is_trapped(next, wet) ||
            flood.closed[next] != hollow.closed)
          return;
        hollow_of[next] = std::int32_t(found.size());
        hollow.cells.push_back(std::uint32_t(next));
      });
    found.push_back(std::move(hollow));
  }
  return found;
}

// A small hole in the surface, and the cells on either side.
struct Hole {
  AirVent vent;
  std::size_t inside, outside;
};

std::vector<Hole> small_holes(const TriangleMesh& object, const PocketSurface& sides,
                              const Surface& surface, const AirCells& cells) {
  std::map<std::int32_t, std::vector<std::int32_t>> next;
  for (const auto& [a, b] : sides.open_edges()) {
    next[a].push_back(b);
    next[b].push_back(a);
  }
  std::vector<Hole> holes;
  std::set<std::int32_t> seen;
  for (const auto& [start, unused] : next) {
    if (!seen.insert(start).second) continue;
    std::vector<std::int32_t> rim = {start};
    for (std::size_t k = 0; k < rim.size(); ++k)
      for (const std::int32_t v : next[rim[k]])
        if (seen.insert(v).second) rim.push_back(v);
    Box3 box;
    Vec3 middle = Vec3::Zero();
    for (const std::int32_t v : rim) {
      box.add(object.positions[std::size_t(v)]);
      middle += object.positions[std::size_t(v)] / double(rim.size());
    }
    const double width = box.size().maxCoeff();
    if (rim.size() < 3 || !(width < kSmallHole * cells.pitch_mm())) continue;
    Vec3 normal = Vec3::Zero();
    for (const auto& [a, b] : sides.open_edges()) {
      if (seen.count(a) == 0 || std::ranges::find(rim, a) == rim.end()) continue;
      Vec3 part = (object.positions[std::size_t(a)] - middle)
                      .cross(object.positions[std::size_t(b)] - middle);
      if (part.dot(normal) < 0) part = -part;
      normal += part;
    }
    if (!(normal.norm() > 0)) continue;
    normal.normalize();
    const auto beside = [&](double sign) -> std::optional<std::size_t> {
      for (int step = 1; step <= 6; ++step) {
        const std::size_t cell =
            cells.cell_of(middle + sign * 0.5 * step * cells.pitch_mm() * normal);
        const Vec3 way = cells.center(cell) - middle;
        if (sign * normal.dot(way) > 0 && !surface.is_hit(middle, way, 0, 1)) return cell;
      }
      return std::nullopt;
    };
    const auto one = beside(1), other = beside(-1);
    if (one && other) holes.push_back({{middle, width, 0}, *one, *other});
  }
  return holes;
}

// Water in a pocket stands where the last mouth closed. Points in the mouths, one for each.
std::vector<Vec3> mouths(const AirCells& cells, const Hollow& hollow,
                         const std::vector<std::int32_t>& hollow_of, const Surface& surface,
                         const Plane& water) {
  const double reach = 1.8 * cells.pitch_mm();
  const auto is_low = [&](std::size_t cell) {
    const double height = water.height(cells.center(cell));
    return height > -cells.pitch_mm() && height < reach;
  };
  const std::int32_t own = hollow_of[hollow.cells.front()];
  std::set<std::size_t> seen;
  std::vector<Vec3> points;
  for (const std::uint32_t start : hollow.cells) {
    if (!is_low(start) || !seen.insert(start).second) continue;
    std::deque<std::size_t> open = {start};
    Vec3 best = Vec3::Zero();
    double widest = -1;
    while (!open.empty()) {
      const std::size_t cell = open.front();
      open.pop_front();
      const Vec3 center = cells.center(cell);
      const Vec3 point = center - water.height(center) * water.up;
      const auto wall = surface.closest_point(point, 1e3);
      if (wall && wall->t > widest) {
        widest = wall->t;
        best = point;
      }
      cells.for_linked(cell, [&](std::size_t next) {
        if (hollow_of[next] == own && is_low(next) && seen.insert(next).second)
          open.push_back(next);
      });
    }
    points.push_back(best);
  }
  return points;
}

// How much of a pocket air keeps when the object leans.
class Leaning {
 public:
  Leaning(const TriangleMesh& object, const AirCells& all, const Hollow& hollow,
          const std::vector<std::int32_t>& hollow_of) {
    Box3 box;
    for (const std::uint32_t cell : hollow.cells) box.add(all.center(cell));
    const Vec3 more = Vec3::Constant(2 * all.pitch_mm());
    box.min -= more;
    box.max += more;
    cells_ = std::make_unique<AirCells>(object, box, kTiltCells);
    box_ = box;
    const std::int32_t own = hollow_of[hollow.cells.front()];
    for (std::size_t cell = 0; cell < cells_->count(); ++cell)
      if (hollow_of[all.cell_of(cells_->center(cell))] == own) inside_.push_back(cell);
  }

  // Share of the pocket's cells from which air has no way up and out.
  double kept(const Vec3& up) const {
    const double half = 0.5 * (box_.size().cwiseProduct(up.cwiseAbs())).sum();
    const double bottom = up.dot(box_.center()) - half - 2 * cells_->pitch_mm();
    const Numbers height = numbers(*cells_, [&](const Vec3& p) {
      return std::uint16_t(
          std::clamp((up.dot(p) - bottom) / (0.5 * cells_->pitch_mm()), 0.0, 60000.0));
    });
    const Flood flooded = flood(*cells_, height);
    std::size_t trapped = 0;
    // A hollow that is less than a cell deep is within what cells get wrong.
    for (const std::size_t cell : inside_)
      if (flooded.closed[cell] != Flood::kInside && flooded.closed[cell] + 2 < height[cell])
        ++trapped;
    return inside_.empty() ? 0 : double(trapped) / double(inside_.size());
  }

  std::optional<Tilt> lets_out() const {
    std::optional<Tilt> best;
    for (int d = 0; d < kTiltDirections; ++d) {
      const double toward = 360.0 * d / kTiltDirections;
      const auto is_free = [&](double tilt) { return kept(up_of({tilt, toward})) <= kHardlyAny; };
      const double limit = best ? best->tilt_deg : kMostTilt_deg;
      for (double tilt = kCoarseTilt_deg; tilt < limit + kCoarseTilt_deg; tilt += kCoarseTilt_deg) {
        const double at = std::min(tilt, kMostTilt_deg);
        if (!is_free(at)) continue;
        double fine = at;
        for (double t = tilt - kCoarseTilt_deg + kFineTilt_deg; t < at; t += kFineTilt_deg)
          if (is_free(t)) {
            fine = t;
            break;
          }
        if (!best || fine < best->tilt_deg) best = Tilt{fine, toward};
        break;
      }
    }
    return best;
  }

 private:
  // The bath's vertical, seen from an object that leans.
  static Vec3 up_of(const Tilt& tilt) {
    const double lean = tilt.tilt_deg * std::numbers::pi / 180;
    const double toward = tilt.toward_deg * std::numbers::pi / 180;
    return Vec3(-std::sin(lean) * std::cos(toward), -std::sin(lean) * std::sin(toward),
                std::cos(lean));
  }

  std::unique_ptr<AirCells> cells_;
  Box3 box_;
  std::vector<std::size_t> inside_;
};

// Everything that is known of one dip's air while pockets are measured.
class Search {
 public:
  Search(const TriangleMesh& object, const Surface& surface, const Trajectory& trajectory,
         const AirOptions& options)
      : object_(object),
        surface_(surface),
        travel_(trajectory, object.positions, object.triangles),
        advises_(options.cells >= kLeastForAdvice),
        cells_(object, std::size_t(options.cells)),
        moments_(travel_, cells_.pitch_mm()),
        wet_(numbers(cells_, [this](const Vec3& p) { return moments_.wet(p); })) {}

  TrappedAir find(const RunContext& context) {
    TrappedAir air;
    air.cell_mm = cells_.pitch_mm();
    air.pocket_of.assign(object_.triangles.size(), -1);
    context.progress("looking for trapped air", 0.2);
    flood_ = flood(cells_, wet_);
    found_ = hollows(cells_, flood_, wet_, moments_.count(), hollow_of_);
    std::erase_if(found_, [](const Hollow& h) { return h.cells.size() < kLeastCells; });
    context.progress("looking for trapped air", 0.5);
    if (found_.empty()) return air;
    sides_ = std::make_unique<PocketSurface>(object_);
    open_small_holes(air);
    std::vector<std::pair<AirPocket, std::vector<std::int32_t>>> pockets;
    for (const Hollow& hollow : found_) {
      context.progress("looking for trapped air",
                       0.5 + 0.5 * double(pockets.size()) / double(found_.size()));
      TriangleMesh lids;
      AirPocket pocket = close(hollow, &lids);
      PocketSurface::Part part = measure(hollow, pocket);
      if (!(pocket.area_mm2 > 0) || !lean(hollow, pocket)) continue;
      append(air.lids, lids);
      pockets.emplace_back(std::move(pocket), std::move(part.triangles));
    }
    std::ranges::stable_sort(pockets, std::greater<>(),
                             [](const auto& p) { return p.first.area_mm2; });
    for (auto& [pocket, triangles] : pockets) {
      for (const std::int32_t t : triangles)
        air.pocket_of[std::size_t(t)] = std::int32_t(air.pockets.size());
      air.pockets.push_back(pocket);
    }
    return air;
  }

 private:
  // What a hole lets out is no pocket; that it does is worth a word.
  void open_small_holes(TrappedAir& air) {
    std::vector<Hole> holes = small_holes(object_, *sides_, surface_, cells_);
    if (holes.empty()) return;
    for (Hole& hole : holes) {
      for (const std::size_t beside : {hole.inside, hole.outside}) {
        const std::int32_t of = hollow_of_[beside];
        if (of < 0 || hole.vent.area_mm2 > 0) continue;
        const auto hollow = std::ranges::find_if(
            found_, [&](const Hollow& h) { return hollow_of_[h.cells.front()] == of; });
        if (hollow == found_.end()) continue;
        AirPocket pocket = close(*hollow, nullptr);
        measure(*hollow, pocket);
        hole.vent.area_mm2 = pocket.area_mm2;
      }
      cells_.add_link(hole.inside, hole.outside);
    }
    flood_ = flood(cells_, wet_);
    const std::vector<std::int32_t> before = hollow_of_;
    found_ = hollows(cells_, flood_, wet_, moments_.count(), hollow_of_);
    std::erase_if(found_, [](const Hollow& h) { return h.cells.size() < kLeastCells; });
    for (const Hole& hole : holes)
      for (const std::size_t beside : {hole.inside, hole.outside})
        if (before[beside] >= 0 && hollow_of_[beside] < 0 && hole.vent.area_mm2 > 0) {
          air.vents.push_back(hole.vent);
          break;
        }
    std::ranges::stable_sort(air.vents, std::greater<>(), &AirVent::area_mm2);
  }

  // When, and with which lids (null: none wanted).
  AirPocket close(const Hollow& hollow, TriangleMesh* lids) const {
    AirPocket pocket;
    const double gap = 3 * cells_.pitch_mm();
    const int closed = hollow.closed;
    const double by_cells = moments_.travelled_mm(closed);
    const Plane rough = plane_at(by_cells);
    const std::vector<Vec3> points = mouths(cells_, hollow, hollow_of_, surface_, rough);
    const double first = std::min(kLidLift_mm, 0.5 * travel_.length_mm());
    // Cells are wrong by one or two of them, however fine the moments are.
    const double doubt = std::max(moments_.travelled_mm(1), cells_.pitch_mm());
    const double open = std::max(first, by_cells - 2 * doubt);
    const double shut = std::min(by_cells + 2 * doubt, travel_.length_mm());
    pocket.closed_at_mm = by_cells;
    if (!points.empty() && open < shut) {
      if (const auto exact = closing(object_, travel_, points, open, shut, gap))
        pocket.closed_at_mm = *exact;
      else if (by_cells <= 2 * doubt)
        pocket.closed_at_mm = 0;  // closed from the first touch on
    }
    pocket.water = plane_at(pocket.closed_at_mm);
    Plane lid = pocket.water;
    lid.offset += kLidLift_mm;
    std::vector<Vec3> others;
    for (const std::uint32_t cell : neighbours(hollow)) others.push_back(cells_.center(cell));
    if (lids) add_lids(object_, lid, points, others, gap, *lids);
    return pocket;
  }

  // Cells outside the pocket near its water.
  std::vector<std::uint32_t> neighbours(const Hollow& hollow) const {
    Box3 box;
    for (const std::uint32_t cell : hollow.cells) box.add(cells_.center(cell));
    const Plane water = plane_at(moments_.travelled_mm(hollow.closed));
    const std::int32_t own = hollow_of_[hollow.cells.front()];
    std::vector<std::uint32_t> found;
    for (std::size_t cell = 0; cell < cells_.count(); ++cell) {
      if (hollow_of_[cell] == own || flood_.closed[cell] == Flood::kInside) continue;
      const Vec3 center = cells_.center(cell);
      const double height = water.height(center);
      if (height <= 0 || height > cells_.pitch_mm()) continue;
      if ((center - box.min).minCoeff() < -cells_.pitch_mm() ||
          (box.max - center).minCoeff() < -cells_.pitch_mm())
        continue;
      found.push_back(std::uint32_t(cell));
    }
    return found;
  }

  PocketSurface::Part measure(const Hollow& hollow, AirPocket& pocket) const {
    const std::int32_t own = hollow_of_[hollow.cells.front()];
    const double reach = 0.75 * cells_.pitch_mm();
    const auto holds = [&](const Vec3& point, const Vec3& from, const Vec3& normal) {
      for (const double further : {1.0, 2.0}) {
        const std::size_t cell = cells_.cell_of(from + further * (point - from));
        if (normal.dot(cells_.center(cell) - from) > 0 && hollow_of_[cell] == own) return true;
      }
      return false;
    };
    PocketSurface::Part part = sides_->part(pocket.water, moments_.levels(), holds, reach);
    const double by_cells = double(hollow.cells.size()) * std::pow(cells_.pitch_mm(), 3);
    pocket.area_mm2 = part.area_mm2;
    pocket.top = part.top;
    pocket.volume_mm3 =
        part.is_whole && std::abs(part.volume_mm3 - by_cells) < kVolumeAgrees * by_cells
            ? part.volume_mm3
            : by_cells;
    return part;
  }

  // What becomes of it when the object leans. False if the other grid that this takes has a way out
  // as it hangs: whatever way one grid finds is there.
  bool lean(const Hollow& hollow, AirPocket& pocket) const {
    const Leaning leaning(object_, cells_, hollow, hollow_of_);
    const double then = leaning.kept(pocket.water.up);
    if (then < kMostlyOpen) return false;
    if (travel_.trajectory().is_straight_down()) {
      if (advises_) pocket.lets_out = leaning.lets_out();
      return true;
    }
    Vec3 last = pocket.water.up;
    double least = then;
    constexpr int kLooks = 24;
    for (int look = 1; look <= kLooks; ++look) {
      const double travelled =
          pocket.closed_at_mm + (travel_.length_mm() - pocket.closed_at_mm) * look / kLooks;
      const Vec3 up = plane_at(travelled).up;
      if (up.dot(last) > std::cos(kFineTilt_deg * std::numbers::pi / 180)) continue;
      last = up;
      least = std::min(least, leaning.kept(up));
    }
    pocket.escapes_share = 1 - least / then;
    return true;
  }

  Plane plane_at(double travelled_mm) const { return water_at(travel_.at(travelled_mm)); }

  const TriangleMesh& object_;
  const Surface& surface_;
  const Travel travel_;
  const bool advises_;
  AirCells cells_;
  const Moments moments_;
  const Numbers wet_;
  Flood flood_;
  std::vector<Hollow> found_;
  std::vector<std::int32_t> hollow_of_;
  std::unique_ptr<PocketSurface> sides_;
};

}  // namespace

double TrappedAir::area_mm2() const {
  double sum = 0;
  for (const AirPocket& pocket : pockets) sum += pocket.area_mm2;
  return sum;
}

double TrappedAir::volume_mm3() const {
  double sum = 0;
  for (const AirPocket& pocket : pockets) sum += pocket.volume_mm3;
  return sum;
}

bool TrappedAir::holds(int triangle, const Vec3& point) const {
  if (std::size_t(triangle) >= pocket_of.size()) return false;
  const std::int32_t pocket = pocket_of[std::size_t(triangle)];
  return pocket >= 0 && pockets[std::size_t(pocket)].water.height(point) > 0;
}

TrappedAir find_air(const TriangleMesh& object, const Surface& surface,
                    const Trajectory& trajectory, const AirOptions& options,
                    const RunContext& context) {
  const RunScope scope(context);
  if (options.cells <= 0 || object.triangles.empty()) return {};
  context.progress("looking for trapped air", 0);
  return Search(object, surface, trajectory, options).find(context);
}

}  // namespace hydrodip
