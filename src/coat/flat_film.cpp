#include "coat/flat_film.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/run_scope.h"
#include "film/locate.h"

namespace hydrodip {
namespace {

// Film that lies nowhere only has to follow.
constexpr double kLooseWeight = 1e-3;
constexpr int kRounds = 40;
constexpr double kPlaced_mm = 1e-3;

using Sparse = Eigen::SparseMatrix<double>;

// A triangle as it shall be, in a plane of its own.
struct Shape {
  std::array<Vec2, 3> corner;
  std::array<double, 3> cotangent;  // of the angle at each corner, times the triangle's weight
};

Shape shape_of(const Vec3& a, const Vec3& b, const Vec3& c, double weight) {
  const Vec3 e1 = b - a, e2 = c - a;
  const double length = std::max(e1.norm(), 1e-12), x = e1.dot(e2) / length;
  Shape shape;
  shape.corner = {Vec2(0, 0), Vec2(length, 0),
                  Vec2(x, std::sqrt(std::max(e2.squaredNorm() - x * x, 1e-18)))};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 p = shape.corner[(k + 1) % 3] - shape.corner[k];
    const Vec2 q = shape.corner[(k + 2) % 3] - shape.corner[k];
    // Blunt angles would pull the wrong way.
    shape.cotangent[k] = weight * std::max(p.dot(q) / std::max(cross2(p, q), 1e-12), 1e-3);
  }
  return shape;
}

class Flattening {
 public:
  explicit Flattening(const DippedFilm& film) : mesh_(film.mesh()) {
    shapes_.reserve(mesh_.triangles.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Triangle& v = mesh_.triangles[t];
      if (film.lies_on_object(t)) {
        shapes_.push_back(shape_of(film.position[std::size_t(v[0])],
                                   film.position[std::size_t(v[1])],
                                   film.position[std::size_t(v[2])], 1));
        continue;
      }
      const auto flat = [&](std::size_t k) {
        const Vec2& u = mesh_.u[std::size_t(v[k])];
        return Vec3(u.x(), u.y(), 0);
      };
      shapes_.push_back(shape_of(flat(0), flat(1), flat(2), kLooseWeight));
    }
    factorize();
  }

  std::vector<Vec2> run() {
    std::vector<Vec2> place = mesh_.u;
    for (int round = 0; round < kRounds; ++round) {
      check_cancelled();
      if (improve(place) < kPlaced_mm) break;
    }
    return place;
  }

 private:
  void factorize() {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t t = 0; t < shapes_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t i = mesh_.triangles[t][(k + 1) % 3], j = mesh_.triangles[t][(k + 2) % 3];
        const double w = shapes_[t].cotangent[k];
        entries.insert(entries.end(), {{i, i, w}, {j, j, w}, {i, j, -w}, {j, i, -w}});
      }
    // Where it is as a whole is free.
    constexpr double kHold = 1e-9;
    const auto n = Eigen::Index(mesh_.u.size());
    for (Eigen::Index i = 0; i < n; ++i) entries.emplace_back(i, i, kHold);
    Sparse matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    solver_.compute(matrix);
  }

  // Rotations that fit best, then places that fit them. How far the farthest one moved.
  double improve(std::vector<Vec2>& place) {
    const auto n = Eigen::Index(mesh_.u.size());
    Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
    for (std::size_t t = 0; t < shapes_.size(); ++t) {
      const Triangle& v = mesh_.triangles[t];
      const Shape& shape = shapes_[t];
      double sine = 0, cosine = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
        const Vec2 is = place[std::size_t(v[a])] - place[std::size_t(v[b])];
        const Vec2 shall = shape.corner[a] - shape.corner[b];
        cosine += shape.cotangent[k] * shall.dot(is);
        sine += shape.cotangent[k] * cross2(shall, is);
      }
      const double length = std::hypot(sine, cosine);
      if (!(length > 0)) continue;
      Mat2 turn;
      turn << cosine, -sine, sine, cosine;
      turn /= length;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
        const Vec2 pull = shape.cotangent[k] * (turn * (shape.corner[a] - shape.corner[b]));
        right.row(v[a]) += pull.transpose();
        right.row(v[b]) -= pull.transpose();
      }
    }
    const Eigen::MatrixX2d solved = solver_.solve(right);
    // About the centre of the film, so that a placement keeps its meaning.
    Vec2 shift = Vec2::Zero();
    for (std::size_t i = 0; i < mesh_.u.size(); ++i)
      shift += mesh_.u[i] - solved.row(Eigen::Index(i)).transpose();
    shift /= double(mesh_.u.size());
    double farthest = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
      const Vec2 next = solved.row(Eigen::Index(i)).transpose() + shift;
      farthest = std::max(farthest, (next - place[i]).norm());
      place[i] = next;
    }
    return farthest;
  }

  const FilmMesh& mesh_;
  std::vector<Shape> shapes_;
  Eigen::SimplicialLDLT<Sparse> solver_;
};

double distortion_of(const DippedFilm& film, const std::vector<Vec2>& place) {
  double sum = 0, total = 0;
  for (std::size_t t = 0; t < film.mesh().triangles.size(); ++t) {
    if (!film.lies_on_object(t)) continue;
    const Triangle& v = film.mesh().triangles[t];
    const Shape shape = shape_of(film.position[std::size_t(v[0])], film.position[std::size_t(v[1])],
                                 film.position[std::size_t(v[2])], 1);
    Mat2 surface, pattern;
    for (std::size_t k = 1; k < 3; ++k) {
      surface.col(Eigen::Index(k) - 1) = shape.corner[k];
      pattern.col(Eigen::Index(k) - 1) = place[std::size_t(v[k])] - place[std::size_t(v[0])];
    }
    if (!(std::abs(pattern.determinant()) > 1e-12)) continue;
    const Eigen::JacobiSVD<Mat2> svd(surface * pattern.inverse());
    const double area = 0.5 * std::abs(surface.determinant());
    for (int k = 0; k < 2; ++k)
      sum += 0.5 * area * std::min(1.0, std::pow(svd.singularValues()[k] - 1, 2));
    total += area;
  }
  return total > 0 ? std::sqrt(sum / total) : 0;
}

}  // namespace

FlatFilm::FlatFilm(const DippedFilm& film)
    : mesh_(film.shared_mesh), place_(Flattening(film).run()) {
  distortion_ = distortion_of(film, place_);
  distortion_as_printed_ = distortion_of(film, mesh_->u);
}

Vec2 FlatFilm::at(const Vec2& film_mm) const {
  const FilmLocation there = locate_flat(*mesh_, film_mm);
  if (there.triangle < 0) return film_mm;
  const Triangle& v = mesh_->triangles[std::size_t(there.triangle)];
  Vec2 place = Vec2::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    place += there.weight[Eigen::Index(k)] * place_[std::size_t(v[k])];
  return place;
}

}  // namespace hydrodip
