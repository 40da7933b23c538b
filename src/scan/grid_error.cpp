#include "scan/grid_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hydrodip {
namespace {

double printed_length_mm(const GridLength& length, double square_mm) {
  return length.diagonal ? std::numbers::sqrt2 * square_mm : square_mm;
}

double root_mean(double sum, int count) { return count > 0 ? std::sqrt(sum / count) : 0; }

}  // namespace

WarpedGrid warp(const CornerGrid& grid, const Surface& surface, const FilmMap& map,
                double reach_mm) {
  WarpedGrid warped;
  for (const Vec3& corner : grid.position) {
    const auto hit = surface.closest_point(corner, reach_mm);
    warped.push_back(hit ? map.to_film(surface.position(*hit), surface.normal(*hit))
                         : std::nullopt);
  }
  return warped;
}

std::vector<LengthError> length_errors(const std::vector<GridLength>& lengths,
                                       const WarpedGrid& warped, double square_mm) {
  std::vector<LengthError> errors;
  for (const GridLength& length : lengths) {
    const auto& from = warped[std::size_t(length.from)];
    const auto& to = warped[std::size_t(length.to)];
    if (from && to)
      errors.push_back({length, (*to - *from).norm() - printed_length_mm(length, square_mm)});
  }
  return errors;
}

GridError grid_error(const std::vector<LengthError>& errors, double square_mm) {
  GridError result;
  double edge_sum = 0, diagonal_sum = 0, absolute_sum = 0, lengths = 0;
  for (const LengthError& error : errors) {
    const double squared = error.error_mm * error.error_mm;
    (error.length.diagonal ? diagonal_sum : edge_sum) += squared;
    ++(error.length.diagonal ? result.diagonals : result.edges);
    absolute_sum += std::abs(error.error_mm);
    lengths += printed_length_mm(error.length, square_mm) + error.error_mm;
    result.worst_mm = std::max(result.worst_mm, std::abs(error.error_mm));
  }
  const int count = result.edges + result.diagonals;
  result.rms_mm = root_mean(edge_sum + diagonal_sum, count);
  result.literal = lengths > 0 ? std::sqrt((edge_sum + diagonal_sum) / lengths) : 0;
  result.edge_rms_mm = root_mean(edge_sum, result.edges);
  result.diagonal_rms_mm = root_mean(diagonal_sum, result.diagonals);
  result.mean_mm = count > 0 ? absolute_sum / count : 0;
  return result;
}

}  // namespace hydrodip
