#include "film/correction.h"

#include <algorithm>
#include <array>
#include <limits>

namespace hydrodip {
namespace {

// Weights of the four points around a place between the middle two.
std::array<double, 4> cubic(double t) {
  return {0.5 * (-t + 2 * t * t - t * t * t), 0.5 * (2 - 5 * t * t + 3 * t * t * t),
          0.5 * (t + 4 * t * t - 3 * t * t * t), 0.5 * (-t * t + t * t * t)};
}

}  // namespace

Vec2 FilmCorrection::at(const Vec2& u) const {
  if (move.empty()) return Vec2::Zero();
  const Vec2 cell = ((u - first) / pitch_mm).cwiseMax(0).cwiseMin(Vec2(nx - 1, ny - 1));
  const int i = std::min(int(cell.x()), std::max(0, nx - 2)),
            j = std::min(int(cell.y()), std::max(0, ny - 2));
  const auto across = cubic(cell.x() - i), up = cubic(cell.y() - j);
  Vec2 sum = Vec2::Zero();
  for (int b = 0; b < 4; ++b)
    for (int a = 0; a < 4; ++a) {
      const int x = std::clamp(i + a - 1, 0, nx - 1), y = std::clamp(j + b - 1, 0, ny - 1);
      sum += across[std::size_t(a)] * up[std::size_t(b)] *
             move[std::size_t(y) * std::size_t(nx) + std::size_t(x)];
    }
  return sum;
}

double FilmCorrection::farthest_mm() const {
  double farthest = 0;
  for (const Vec2& m : move) {
    if (!m.allFinite()) return std::numeric_limits<double>::infinity();
    farthest = std::max(farthest, m.cwiseAbs().maxCoeff());
  }
  return farthest;
}

}  // namespace hydrodip
