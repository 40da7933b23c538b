#include "calibrate/landings.h"

#include <Eigen/LU>
#include <cmath>

namespace hydrodip {
namespace {

// Over which a map's slope is looked at: the map is linear within a triangle of the film.
constexpr double kAside_mm = 0.5;
// Decimals that are kept, so that a store's lines are short: far below what any scan sees.
constexpr double kDecimals = 1e7, kDecimalsOfSlope = 1e5;

double rounded(double value, double decimals) { return std::round(value * decimals) / decimals; }

std::optional<Landing> landing_at(const FilmMap& map, const TriangleMesh& object, const Vec2& u) {
  const auto lands = [&](const Vec2& point) -> std::optional<Vec3> {
    const auto hit = map.to_object(point);
    return hit ? std::optional<Vec3>(position_at(object, *hit)) : std::nullopt;
  };
  const auto here = lands(u);
  if (!here) return std::nullopt;
  Landing landing;
  landing.position = here->unaryExpr([](double x) { return rounded(x, kDecimals); });
  for (int axis = 0; axis < 2; ++axis) {
    const Vec2 aside = kAside_mm * Vec2::Unit(axis);
    const auto before = lands(u - aside), after = lands(u + aside);
    if (!before && !after) return std::nullopt;
    const Vec3 slope =
        (after.value_or(*here) - before.value_or(*here)) / (before && after ? 2 : 1) / kAside_mm;
    landing.by_film.col(axis) =
        slope.unaryExpr([](double x) { return rounded(x, kDecimalsOfSlope); });
  }
  return landing;
}

}  // namespace

Eigen::Matrix<double, 2, 3> by_object(const Landing& landing) {
  const Eigen::Matrix2d metric = landing.by_film.transpose() * landing.by_film;
  return metric.inverse() * landing.by_film.transpose();
}

std::size_t Landings::index_of(const GridPlace& place) const {
  return std::size_t(place[1] + reach[1]) * std::size_t(2 * reach[0] + 1) +
         std::size_t(place[0] + reach[0]);
}

const Landing* Landings::find(const GridPlace& place) const {
  if (std::abs(place[0]) > reach[0] || std::abs(place[1]) > reach[1]) return nullptr;
  const std::size_t index = index_of(place);
  return index < corner.size() && corner[index] ? &*corner[index] : nullptr;
}

Landings landings_of(const CheckerboardDip& dip, const CalibrationObject& object,
                     const GridPlace& reach) {
  Landings result;
  result.reach = reach;
  for (int row = -reach[1]; row <= reach[1]; ++row)
    for (int column = -reach[0]; column <= reach[0]; ++column)
      result.corner.push_back(
          landing_at(*dip.map, object.object, dip.board.on_film({column, row})));
  return result;
}

}  // namespace hydrodip
