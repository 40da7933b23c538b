#include "object/charts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/run_scope.h"
#include "object/edges.h"

namespace hydrodip {
namespace {

const double kLeastCosine = std::cos(40 * std::numbers::pi / 180);
constexpr int kCells = 1024;  // as wide as the object is at most
// So much higher or lower, in cells, is no neighbour's place in a sloping surface.
constexpr float kOtherStorey = 4;
constexpr double kOnTheSide = 1e-6;  // in cells

// Per triangle: those across its sides, -1 for none.
std::vector<std::array<std::int32_t, 3>> across_sides(const TriangleMesh& mesh) {
  std::vector<std::array<std::int32_t, 3>> across(mesh.triangles.size(), {-1, -1, -1});
  const auto join = [&](std::int32_t triangle, std::int32_t other) {
    auto& of = across[std::size_t(triangle)];
    if (const auto free = std::find(of.begin(), of.end(), -1); free != of.end()) *free = other;
  };
  const std::vector<TriangleSide> sides = sorted_sides(mesh);
  for_each_edge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 2) return;
    join(face_of(sides[begin]), face_of(sides[begin + 1]));
    join(face_of(sides[begin + 1]), face_of(sides[begin]));
  });
  return across;
}

// What of a chart's plane is taken: centres of cells inside its triangles, and where triangles lie
// that are smaller.
class Footprint {
 public:
  explicit Footprint(const TriangleMesh& mesh) : mesh_(mesh), cells_(kCells * kCells) {
    Box3 box;
    for (const Vec3& p : mesh.positions) box.add(p);
    if (box.empty()) return;
    middle_ = 0.5 * (box.min + box.max);
    // Whatever way the plane lies, with a cell to spare.
    cell_ = std::max((box.max - box.min).norm() / (kCells - 4), 1e-300);
  }

  void begin_chart(const Vec3& normal) {
    ++chart_;
    up_ = normal;
    along_ = normal.unitOrthogonal();
    across_ = normal.cross(along_);
  }

  // Takes a triangle's place; false, and nothing is taken, if it is not free.
  bool take(std::size_t triangle) {
    std::array<Vec3, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 from_middle =
          (mesh_.positions[std::size_t(mesh_.triangles[triangle][k])] - middle_) / cell_;
      corner[k] = {from_middle.dot(along_) + kCells / 2.0, from_middle.dot(across_) + kCells / 2.0,
                   from_middle.dot(up_)};
    }
    const Vec3 centre = (corner[0] + corner[1] + corner[2]) / 3;
    bool has_room = true, has_cells = false;
    for_each_inside(corner, [&](Cell& cell, float height) {
      has_cells = true;
      has_room = has_room && !(cell.chart == chart_ &&
                               (cell.is_inside || is_other_storey(cell.height - height)));
    });
    Cell& at_centre = cell_at(int(centre.x()), int(centre.y()));
    if (!has_cells)
      has_room =
          at_centre.chart != chart_ || !is_other_storey(at_centre.height - float(centre.z()));
    if (!has_room) return false;
    for_each_inside(corner, [&](Cell& cell, float height) { cell = {chart_, true, height}; });
    if (!has_cells && at_centre.chart != chart_) at_centre = {chart_, false, float(centre.z())};
    return true;
  }

 private:
  struct Cell {
    std::uint32_t chart = 0;
    bool is_inside = false;
    float height = 0;
  };

  static bool is_other_storey(float by) { return std::abs(by) > kOtherStorey; }

  Cell& cell_at(int x, int y) {
    return cells_[std::size_t(std::clamp(y, 0, kCells - 1)) * kCells +
                  std::size_t(std::clamp(x, 0, kCells - 1))];
  }

  template <class Visit>
  void for_each_inside(const std::array<Vec3, 3>& corner, const Visit& visit) {
    const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const auto [low, high] = std::minmax({corner[0].y(), corner[1].y(), corner[2].y()});
    for (int y = int(std::ceil(low - 0.5)); y + 0.5 < high; ++y) {
      const double middle = y + 0.5;
      double begin = 1e300, end = -1e300;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &a = corner[k], &b = corner[(k + 1) % 3];
        if ((a.y() <= middle) == (b.y() <= middle)) continue;
        const double x = a.x() + (b.x() - a.x()) * (middle - a.y()) / (b.y() - a.y());
        begin = std::min(begin, x);
        end = std::max(end, x);
      }
      for (int x = int(std::ceil(begin + kOnTheSide - 0.5)); x + 0.5 < end - kOnTheSide; ++x) {
        const double fall =
            (normal.x() * (x + 0.5 - corner[0].x()) + normal.y() * (middle - corner[0].y())) /
            normal.z();
        visit(cell_at(x, y), float(corner[0].z() - fall));
      }
    }
  }

  const TriangleMesh& mesh_;
  std::vector<Cell> cells_;
  Vec3 middle_ = Vec3::Zero(), up_ = Vec3::UnitZ(), along_ = Vec3::UnitX(), across_ = Vec3::UnitY();
  double cell_ = 1;
  std::uint32_t chart_ = 0;
};

}  // namespace

std::vector<std::vector<std::size_t>> charts(const TriangleMesh& mesh) {
  const auto across = across_sides(mesh);
  std::vector<Vec3> normal(mesh.triangles.size());
  std::vector<double> area(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& v = mesh.triangles[t];
    const Vec3& a = mesh.positions[std::size_t(v[0])];
    normal[t] =
        (mesh.positions[std::size_t(v[1])] - a).cross(mesh.positions[std::size_t(v[2])] - a);
    area[t] = normal[t].norm();
    if (area[t] > 0) normal[t] /= area[t];
  }
  std::vector<std::size_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return area[a] > area[b]; });
  std::vector<std::uint8_t> taken(mesh.triangles.size(), 0);
  std::vector<std::vector<std::size_t>> list;
  Footprint footprint(mesh);
  CheckEvery check(1 << 12);
  for (const std::size_t seed : order) {
    check();
    if (taken[seed]) continue;
    taken[seed] = 1;
    std::vector<std::size_t> chart = {seed};
    if (area[seed] > 0) {
      footprint.begin_chart(normal[seed]);
      footprint.take(seed);
    }
    for (std::size_t i = 0; i < chart.size(); ++i)
      for (const std::int32_t other : across[chart[i]]) {
        if (other < 0 || taken[std::size_t(other)]) continue;
        if (!(normal[std::size_t(other)].dot(normal[seed]) > kLeastCosine)) continue;
        if (!footprint.take(std::size_t(other))) continue;
        taken[std::size_t(other)] = 1;
        chart.push_back(std::size_t(other));
      }
    list.push_back(std::move(chart));
  }
  return list;
}

}  // namespace hydrodip
