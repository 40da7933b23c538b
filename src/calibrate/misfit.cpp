#include "calibrate/misfit.h"

#include <Eigen/Geometry>
#include <limits>

#include "base/dense_solvers.h"

namespace hydrodip {
namespace {

constexpr int kPose = 6, kFilm = 3, kOpen = kPose + kFilm + 1;
// Columns that differ by less, relatively, are one.
constexpr double kSameSpace = 1e-6;

// Which way, on the film, ink around a corner would push it by spreading: away from dark squares.
Vec2 spread_of(const Board& board, const GridPlace& corner) {
  Vec2 way = Vec2::Zero();
  for (const int dx : {-1, 0})
    for (const int dy : {-1, 0})
      way -= board.ink_of({corner[0] + dx, corner[1] + dy}) / 255.0 * Vec2(2 * dx + 1, 2 * dy + 1);
  return way;
}

Eigen::Matrix<double, 3, kOpen> motions_of(const Board& board, const GridPlace& place,
                                           const Landing& landing) {
  Eigen::Matrix<double, 3, kOpen> motions;
  const Vec2 u = board.on_film(place);
  for (int axis = 0; axis < 3; ++axis) {
    motions.col(axis) = Vec3::Unit(axis);
    motions.col(3 + axis) = Vec3::Unit(axis).cross(landing.position);
  }
  motions.middleCols<2>(kPose) = landing.by_film;
  motions.col(kPose + 2) = landing.by_film * Vec2(-u.y(), u.x());
  motions.col(kPose + 3) = landing.by_film * spread_of(board, place);
  return motions;
}

}  // namespace

Eigen::MatrixXd open_motions(const Board& board, const Landings& landings,
                             const std::vector<GridPlace>& corners, bool pose_known) {
  Eigen::MatrixXd motions = Eigen::MatrixXd::Constant(3 * Eigen::Index(corners.size()), kOpen,
                                                      std::numeric_limits<double>::quiet_NaN());
  for (std::size_t c = 0; c < corners.size(); ++c)
    if (const Landing* landing = landings.find(corners[c]))
      motions.middleRows<3>(3 * Eigen::Index(c)) = motions_of(board, corners[c], *landing);
  if (pose_known) return motions.rightCols(kOpen - kPose);
  return motions;
}

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  if (columns.size() == 0) return Eigen::MatrixXd(columns.rows(), 0);
  Eigen::MatrixXd scaled = columns;
  for (Eigen::Index k = 0; k < scaled.cols(); ++k)
    if (const double length = scaled.col(k).norm(); length > 0) scaled.col(k) /= length;
  return column_space(scaled, kSameSpace);
}

Eigen::MatrixXd without(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& space) {
  return columns - space * (space.transpose() * columns);
}

}  // namespace hydrodip
