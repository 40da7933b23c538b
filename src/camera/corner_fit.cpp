#include "camera/corner_fit.h"

#include <algorithm>
#include <cmath>

namespace hydrodip {
namespace {

constexpr double kAstray = 6, kAstray_px = 0.6;  // times the median

}  // namespace

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double rms_px(const Fit& fit, std::size_t corners) {
  return kCorner_px * std::sqrt(fit.residuals.head(2 * Eigen::Index(corners)).squaredNorm() /
                                double(2 * corners));
}

std::vector<std::uint8_t> lies_astray(const Fit& fit, std::size_t corners) {
  std::vector<double> off;
  off.reserve(corners);
  for (std::size_t i = 0; i < corners; ++i)
    off.push_back(kCorner_px * fit.residuals.segment<2>(2 * Eigen::Index(i)).norm());
  const double limit = std::max(kAstray_px, kAstray * median(off));
  std::vector<std::uint8_t> astray;
  astray.reserve(corners);
  for (const double px : off) astray.push_back(px > limit);
  return astray;
}

double scatter_of(const Fit& fit) {
  const double freedom = double(fit.residuals.size() - fit.values.size());
  return freedom > 0 ? fit.residuals.squaredNorm() / freedom : 1;
}

}  // namespace hydrodip
