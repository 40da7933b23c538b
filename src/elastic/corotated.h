// Linear corotational elasticity of one triangle in the plane (paper Eq. 2, 3, 5 and 6).
//
// F = dU/dX is the deformation gradient from the rest triangle (where the film is now) to the
// parametric one (film coordinates), F = R S its polar decomposition, and
//   psi(F) = mu |F - R|^2 + lambda / 2 (tr S - 2)^2,   P = 2 mu (F - R) + lambda (tr S - 2) R.
// In two dimensions everything has a closed form: tr S = |(F00 + F11, F10 - F01)|, and the only
// direction in which R turns is Q = R J, J = [0 -1; 1 0], so that
//   dP = 2 mu dF + lambda (R : dF) R + (lambda (tr S - 2) - 2 mu) / tr S  (Q : dF) Q.
// R and Q are orthogonal, hence the only eigenvalue that can be negative is that along Q, which is
// clamped at zero for Newton's method.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace hydrodip {

// Lame parameters; any Poisson ratio below 0.5.
struct Lame {
  double mu = 0, lambda = 0;
};
inline Lame lame(double youngs_modulus, double poisson) {
  return {youngs_modulus / (2 * (1 + poisson)),
          youngs_modulus * poisson / ((1 + poisson) * (1 - 2 * poisson))};
}

// A rest triangle as the energy needs it: shape-function gradients (row a: dN_a/dX, 1/mm) and area
// (mm^2). Area 0: no film there, no energy.
struct RestTriangle {
  Eigen::Matrix<double, 3, 2> gradient = Eigen::Matrix<double, 3, 2>::Zero();
  double area = 0;
};

// From corners in the plane, counter-clockwise; area 0 if they are not.
inline RestTriangle rest_triangle(const Vec2& a, const Vec2& b, const Vec2& c) {
  RestTriangle rest;
  const double twice = cross2(b - a, c - a);
  if (!(twice > 0)) return rest;
  rest.area = 0.5 * twice;
  const auto normal = [&](const Vec2& from, const Vec2& to) {
    return Eigen::RowVector2d((from.y() - to.y()) / twice, (to.x() - from.x()) / twice);
  };
  rest.gradient.row(0) = normal(b, c);
  rest.gradient.row(1) = normal(c, a);
  rest.gradient.row(2) = normal(a, b);
  return rest;
}

// From a triangle in space, flattened isometrically (the energy does not see its rotation).
inline RestTriangle rest_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double length = ab.norm();
  if (!(length > 0)) return {};
  const double along = ab.dot(ac) / length;
  const double across = std::sqrt(std::max(0.0, ac.squaredNorm() - along * along));
  return rest_triangle(Vec2(0, 0), Vec2(length, 0), Vec2(along, across));
}

inline Mat2 deformation_gradient(const RestTriangle& rest, const Vec2& u0, const Vec2& u1,
                                 const Vec2& u2) {
  return u0 * rest.gradient.row(0) + u1 * rest.gradient.row(1) + u2 * rest.gradient.row(2);
}

struct Polar {
  double cosine = 1, sine = 0;  // R = [c -s; s c]
  double trace = 2;             // tr S
};
inline Polar polar(const Mat2& F) {
  const double x = F(0, 0) + F(1, 1), y = F(1, 0) - F(0, 1);
  // A collapsed triangle has no rotation of its own; any will do, and 1e-12 keeps it finite.
  const double trace = std::max(std::hypot(x, y), 1e-12);
  return {x / trace, y / trace, trace};
}

inline Mat2 rotation(const Polar& p) {
  Mat2 R;
  R << p.cosine, -p.sine, p.sine, p.cosine;
  return R;
}

inline double energy_density(const Mat2& F, const Lame& m) {
  const Polar p = polar(F);
  const double dilation = p.trace - 2;
  return m.mu * (F - rotation(p)).squaredNorm() + 0.5 * m.lambda * dilation * dilation;
}

// Factor of (Q : dF) Q in dP; clamped so that the whole is positive semidefinite if asked.
inline double turning_stiffness(const Polar& p, const Lame& m, bool definite) {
  const double k = (m.lambda * (p.trace - 2) - 2 * m.mu) / p.trace;
  return definite ? std::max(k, -m.mu) : k;
}

// Largest stretch of the film there: 1 / smallest singular value of F.
inline double largest_stretch(const Mat2& F) {
  const double half_sum = 0.5 * F.squaredNorm();
  const double det = F.determinant();
  const double root = std::sqrt(std::max(0.0, half_sum * half_sum - det * det));
  const double largest = std::sqrt(half_sum + root);
  return largest / std::max(std::abs(det), 1e-300);
}

}  // namespace hydrodip
