// Pictures laid on the surface like stickers, from their centre outwards.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <utility>

#include "artwork/geodesic.h"
#include "artwork/placement.h"
#include "artwork/projector.h"
#include "base/filled.h"

namespace hydrodip {
namespace {

// Of the picture's diagonal, or the object's: as finely the surface is cut.
constexpr double kCuts = 60;
constexpr int kMostPerSide = 96;
constexpr double kMostTriangles = 400000;
// Beyond that, neighbours on the surface were reached by ways around something.
constexpr double kTorn = 3;
// A picture as large as fits is not stretched more than this.
constexpr double kFair = 1.25;
// What is smaller says nothing about stretch, in shares of the mean triangle.
constexpr double kSliver = 1e-4;

// How a triangle lies in the picture's plane.
struct Lie {
  double most = 0, least = 0;  // lengths on the surface over those of the picture; 0: not reached
  double area_mm2 = 0;
  bool is_torn() const { return !(least > 1 / kTorn) || !(most < kTorn); }
};

class Chart {
 public:
  // `side`: 1 if the picture is seen from where the normals point, else -1.
  Chart(const TriangleMesh& mesh, PolarMap map, int side)
      : mesh_(mesh), side_(side), place_(std::move(map.place_mm)) {
    lies_.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) lies_.push_back(lie_of(t));
  }

  bool is_reached(std::size_t triangle) const {
    for (const std::int32_t v : mesh_.triangles[triangle])
      if (!place_[std::size_t(v)].allFinite()) return false;
    return true;
  }
  const Lie& lie(std::size_t triangle) const { return lies_[triangle]; }
  Box2 box(std::size_t triangle) const {
    Box2 box;
    for (const std::int32_t v : mesh_.triangles[triangle]) box.add(place_[std::size_t(v)]);
    return box;
  }
  // Of its nearest corner.
  double distance(std::size_t triangle) const {
    double least = 1e300;
    for (const std::int32_t v : mesh_.triangles[triangle])
      least = std::min(least, place_[std::size_t(v)].norm());
    return least;
  }
  Vec2 at(const SurfacePoint& p) const {
    const Triangle& t = mesh_.triangles[std::size_t(p.triangle)];
    return (1 - p.u - p.v) * place_[std::size_t(t[0])] + p.u * place_[std::size_t(t[1])] +
           p.v * place_[std::size_t(t[2])];
  }

 private:
  Lie lie_of(const Triangle& t) const {
    const Vec3& a = mesh_.positions[std::size_t(t[0])];
    const Vec3 e1 = mesh_.positions[std::size_t(t[1])] - a;
    const Vec3 e2 = mesh_.positions[std::size_t(t[2])] - a;
    Lie lie;
    lie.area_mm2 = 0.5 * e1.cross(e2).norm();
    Mat2 picture;
    picture.col(0) = place_[std::size_t(t[1])] - place_[std::size_t(t[0])];
    picture.col(1) = place_[std::size_t(t[2])] - place_[std::size_t(t[0])];
    if (!picture.allFinite() || !(side_ * picture.determinant() > 0) || !(lie.area_mm2 > 0))
      return lie;
    const double along = e1.norm(), x = e1.dot(e2) / along;
    Mat2 surface;
    surface << along, x, 0, std::sqrt(std::max(0.0, e2.squaredNorm() - x * x));
    const Eigen::JacobiSVD<Mat2> svd(surface * picture.inverse());
    lie.most = svd.singularValues()[0];
    lie.least = svd.singularValues()[1];
    return lie;
  }

  const TriangleMesh& mesh_;
  int side_;
  std::vector<Vec2> place_;
  std::vector<Lie> lies_;
};

class Wrapped : public Placement {
 public:
  Wrapped(FineMesh fine, PolarMap map, int side)
      : fine_(std::move(fine)), chart_(fine_.mesh(), std::move(map), side) {}
  const FineMesh& fine() const { return fine_; }
  const Chart& chart() const { return chart_; }

  bool find(const SurfacePoint& point, Spot& spot) const override {
    const SurfacePoint there = fine_.fine(point);
    const auto triangle = std::size_t(there.triangle);
    if (chart_.lie(triangle).is_torn()) return false;
    spot = {chart_.at(there), 1};
    return true;
  }

 private:
  FineMesh fine_;
  Chart chart_;
};

int cuts_for(const TriangleMesh& mesh, double length_mm) {
  double longest2 = 0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      longest2 = std::max(longest2, (mesh.positions[std::size_t(t[k])] -
                                     mesh.positions[std::size_t(t[(k + 1) % 3])])
                                        .squaredNorm());
  const double wanted = std::sqrt(longest2) * kCuts / length_mm;
  const double bearable = std::sqrt(kMostTriangles / double(mesh.triangles.size()));
  return int(
      std::clamp(std::min(std::ceil(wanted), std::floor(bearable)), 1.0, double(kMostPerSide)));
}

// How far a picture's corner may lie: before the surface ends, tears or stretches.
double fair_reach(const FineMesh& fine, const Chart& chart, double object_mm) {
  double reach = 1e300, farthest = 0;
  const double sliver =
      kSliver * fine.mesh().bounds().size().squaredNorm() / double(fine.mesh().triangles.size());
  for (std::size_t t = 0; t < fine.mesh().triangles.size(); ++t) {
    if (!chart.is_reached(t)) continue;
    const Lie& lie = chart.lie(t);
    farthest = std::max(farthest, chart.distance(t));
    if (lie.area_mm2 < sliver) continue;
    if (lie.is_torn() || lie.most > kFair || lie.least < 1 / kFair)
      reach = std::min(reach, chart.distance(t));
  }
  return std::clamp(reach, 0.05 * object_mm, std::max(farthest, 0.05 * object_mm));
}

WrapReport report_of(const FineMesh& fine, const Chart& chart, const PictureFrame& frame) {
  // By area: a few bad triangles are not the picture.
  constexpr double kMostOfIt = 0.995;
  WrapReport report;
  std::vector<std::pair<double, double>> most, least;
  double total = 0;
  for (std::size_t t = 0; t < fine.mesh().triangles.size(); ++t) {
    if (!chart.is_reached(t) || frame.misses(chart.box(t))) continue;
    const Lie& lie = chart.lie(t);
    if (lie.is_torn()) {
      // Far ends of a torn triangle lie anywhere: what matters is whether one lies in the picture.
      if (chart.distance(t) < 0.5 * frame.size_mm().norm()) report.folded_mm2 += lie.area_mm2;
      continue;
    }
    most.emplace_back(lie.most, lie.area_mm2);
    least.emplace_back(-lie.least, lie.area_mm2);
    total += lie.area_mm2;
  }
  const auto most_of = [&](std::vector<std::pair<double, double>>& values) {
    std::sort(values.begin(), values.end());
    double sum = 0;
    for (const auto& [value, area] : values)
      if ((sum += area) >= kMostOfIt * total) return value;
    return values.empty() ? 1.0 : values.back().first;
  };
  if (most.empty()) return report;
  report.stretch_most = most_of(most);
  report.stretch_least = -most_of(least);
  return report;
}

// Where the picture's centre lies: as told, else the point that enters the water first.
SurfacePoint centre_of(const PlacementTask& task) {
  const ModelFrame frame(task.posed);
  Vec3 at = Vec3::Zero();
  if (task.layer.at_mm) {
    at = frame.point(*task.layer.at_mm);
  } else {
    const Box3 box = task.posed.mesh().bounds();
    at = box.center();
    const double far_mm = box.size().z() + 1;
    const Vec3 below(at.x(), at.y(), box.min.z() - 0.5 * far_mm);
    if (const auto hit = task.posed.surface().first_hit(below, Vec3::UnitZ(), 0, 2 * far_mm))
      return {hit->triangle, hit->u, hit->v};
    const auto near =
        task.posed.surface().closest_point({at.x(), at.y(), box.min.z()}, box.size().norm() + 1);
    if (near) return {near->triangle, near->u, near->v};
  }
  const SurfaceHit hit = nearest_to(task, at);
  return {hit.triangle, hit.u, hit.v};
}

}  // namespace

Placed place_wrapped(const PlacementTask& task, WrapReport& report) {
  const ArtworkLayer& layer = task.layer;
  const TriangleMesh& mesh = task.posed.mesh();
  const SurfacePoint centre = centre_of(task);
  const Vec3 viewer = seen_from(task, {centre.triangle, centre.u, centre.v, 0});
  const int side = viewer.dot(face_normal(mesh, centre.triangle)) > 0 ? 1 : -1;
  const Upright axes = upright(task, -viewer);
  const bool told = layer.width_mm > 0 || layer.height_mm > 0;
  const double object_mm = mesh.bounds().size().norm();
  Vec2 size = told ? fitting_size(task, Vec2::Ones()) : Vec2::Zero();
  const bool repeats = layer.repeat != Repeat::kOnce;
  const double reach = told && !repeats ? 0.55 * size.norm() : 1e300;
  FineMesh fine(mesh, cuts_for(mesh, std::min(told ? size.norm() : 1e300, object_mm)));
  PolarMap map = polar_map(fine.mesh(), fine.fine(centre), axes.right, axes.up, reach);
  auto wrapped = std::make_unique<Wrapped>(std::move(fine), std::move(map), side);
  if (!told) {
    const double diagonal = 2 * fair_reach(wrapped->fine(), wrapped->chart(), object_mm);
    size.y() = diagonal / std::hypot(task.aspect, 1.0);
    size.x() = task.aspect * size.y();
  }
  report = report_of(wrapped->fine(), wrapped->chart(),
                     PictureFrame(size, layer.turn_deg, layer.repeat));
  ArtworkLayer lying = layer;
  if (!lying.at_mm) lying.at_mm = rounded(ModelFrame(task.posed).back(position_at(mesh, centre)));
  return {std::move(wrapped), size, std::move(lying)};
}

}  // namespace hydrodip
