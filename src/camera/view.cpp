#include "camera/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/error.h"
#include "camera/board.h"
#include "camera/corner_fit.h"
#include "camera/moved_strip.h"
#include "camera/view_finder.h"

namespace hydrodip {
namespace {

// A photo of a rim that is as it was calibrated fits it so much worse than the calibration's own
// at most, and even a blurred one so well.
constexpr double kWorseThanCalibrated = 4, kBlurredFit_px = 0.3;

RimCorners rim_corners(const SeenPhoto& photo, const Tank& tank) {
  RimCorners corners;
  for (const SeenMark& mark : single_marks(photo))
    if (const auto known = tank.corner_mm.find(mark.id); known != tank.corner_mm.end())
      corners.push_back({strip_place(mark.id).strip, known->second, mark.corner_px});
  return corners;
}

}  // namespace

Vec2 View::on_water(const Eigen::Matrix<double, kValues, 1>& values, const Vec2& px) {
  return on_level(values, px, -values[kValues - 1]);
}

View view_of(const SeenPhoto& photo, const Tank& tank, double water_sigma_mm) {
  if (const int strip = strip_seen_twice(photo); strip >= 0)
    throw InputError(fmt::format(
        "{}: strip {} of the board is to be seen twice: take the second print of it out of the "
        "picture, and take the photo again",
        photo.name, strip + 1));
  RimCorners corners = rim_corners(photo, tank);
  if (!reaches_around(corners))
    throw InputError(fmt::format(
        "{}: too few marks of the tank's rim are to be seen ({}); take the photo so that strips on "
        "at least two sides of the tank are in it, sharp and without glare",
        photo.name, corners.size()));

  const ViewFinder finder(tank, water_sigma_mm);
  Fit fit = finder.fit(corners, finder.start(corners));
  const std::optional<MovedStrip> moved = most_moved(corners, finder, fit.values);
  const std::vector<std::uint8_t> astray = lies_astray(fit, corners.size());
  RimCorners kept;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (!astray[i]) kept.push_back(corners[i]);
  if (kept.size() < corners.size() && kept.size() >= kLeastBoardMarks) {
    corners = kept;
    fit = finder.fit(corners, fit.values);
  }

  View view;
  view.values = fit.values;
  view.rms_px = rms_px(fit, corners.size());
  view.board_marks = int(corners.size());
  const double limit_px =
      std::min(kWorstFit_px, std::max(kBlurredFit_px, kWorseThanCalibrated * tank.rms_px));
  if (moved && moved->others_px <= limit_px && moved->is_sure())
    throw InputError(fmt::format(
        "{}: strip {} of the rim has moved by {:.1f} mm since the calibration, as the others tell: "
        "put it back, or calibrate again with 'hydrodip register --calibrate-camera'",
        photo.name, moved->strip + 1, moved->moved_mm));
  if (!(view.rms_px < limit_px))
    throw InputError(fmt::format(
        "{}: the rim's marks are {:.1f} px off where the calibration found them (to {:.2f} px): "
        "strips have moved, or the photo is blurred, zoomed, scaled or another camera's; take it "
        "again, or calibrate again with 'hydrodip register --calibrate-camera'",
        photo.name, view.rms_px, tank.rms_px));
  view.covariance = ViewFinder::covariance(fit);
  return view;
}

}  // namespace hydrodip
