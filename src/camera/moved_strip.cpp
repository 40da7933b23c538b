#include "camera/moved_strip.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "base/eigenpairs.h"
#include "camera/corner_fit.h"
#include "camera/planar_motion.h"

namespace hydrodip {
namespace {

// Calibrations know strips to a few hundredths of a millimetre; what is moved by less than this
// moves the film by a third of it.
constexpr double kMoved_mm = 0.3, kSure = 5;

// How far a strip, which moves as a whole, lies off its place, seen from there: per corner.
Eigen::VectorXd strip_motion(const RimCorners& strip, const ViewValues& view) {
  std::vector<Vec2> from, to;
  for (const RimCorner& c : strip) {
    from.emplace_back(c.at.head<2>());
    to.push_back(on_level(view, c.px, c.at.z()));
  }
  const PlanarMotion move = planar_fit(from, to);
  Eigen::VectorXd motion(2 * Eigen::Index(strip.size()));
  for (std::size_t i = 0; i < from.size(); ++i)
    motion.segment<2>(2 * Eigen::Index(i)) = move * from[i] - from[i];
  return motion;
}

MovedStrip moved_against(const RimCorners& strip, const Fit& others, std::size_t other_corners) {
  const ViewValues view = others.values;
  const Eigen::MatrixXd covariance = ViewFinder::covariance(others);
  const Eigen::VectorXd motion = strip_motion(strip, view);
  MovedStrip moved{strip.front().strip, 0, 0, rms_px(others, other_corners)};
  Eigen::Index farthest = 0;
  for (Eigen::Index i = 0; i < motion.size(); i += 2)
    if (motion.segment<2>(i).norm() > moved.moved_mm)
      moved.moved_mm = motion.segment<2>(i).norm(), farthest = i;
  Eigen::Matrix<double, 2, View::kValues> slope;
  for (int k = 0; k < View::kValues; ++k) {
    const double step = std::max(1e-9, 0.1 * std::sqrt(covariance(k, k)));
    ViewValues more = view, less = view;
    more[k] += step;
    less[k] -= step;
    slope.col(k) =
        (strip_motion(strip, more) - strip_motion(strip, less)).segment<2>(farthest) / (2 * step);
  }
  moved.sigma_mm = std::sqrt(eigenpairs(Mat2(slope * covariance * slope.transpose())).values[1]);
  return moved;
}

}  // namespace

bool MovedStrip::is_sure() const { return moved_mm > std::max(kMoved_mm, kSure * sigma_mm); }

std::optional<MovedStrip> most_moved(const RimCorners& corners, const ViewFinder& finder,
                                     const Eigen::VectorXd& from) {
  std::map<int, RimCorners> strips;
  for (const RimCorner& c : corners) strips[c.strip].push_back(c);
  std::optional<MovedStrip> most;
  for (const auto& [number, strip] : strips) {
    RimCorners others;
    for (const RimCorner& c : corners)
      if (c.strip != number) others.push_back(c);
    if (strip.size() < 3 || !reaches_around(others)) continue;
    const MovedStrip moved = moved_against(strip, finder.fit(others, from), others.size());
    if (!most || moved.others_px < most->others_px) most = moved;
  }
  return most;
}

}  // namespace hydrodip
