#include "camera/film_pose.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "camera/board.h"
#include "camera/least_squares.h"

namespace hydrodip {
namespace {

constexpr std::size_t kLeastMarks = 4;
constexpr double kDegPerRad = 180 / std::numbers::pi;
// Marks that belong together lie, but for swelling, alike to within this.
constexpr double kTogether_mm = 6, kLeastBase_mm = 60, kMostSwelling = 0.12;
// Below what a corner is known to, scatter is chance.
constexpr double kLeastScatter_mm = 0.005;
constexpr double kTurned_deg = 45;
// Beyond such deviations nobody can be told how to move a film.
constexpr double kUnsure_mm = 0.5, kUnsure_deg = 0.5, kUnsureSwelling = 0.01;
// No film shrinks or swells more.
constexpr double kLeastSwelling = 0.985, kLargestSwelling = 1.07;

using PoseValues = Eigen::Matrix<double, 5, 1>;  // shift, turn (rad), swelling

struct Pair {
  MarkPlace mark;
  SeenMark seen;
};

// Of the job's sheet, as many as are seen; a tag may be seen more than once.
std::vector<Pair> pairs_of(const std::vector<SeenMark>& seen, const std::vector<MarkPlace>& marks) {
  std::vector<Pair> pairs;
  for (const SeenMark& s : seen)
    for (const MarkPlace& m : marks)
      if (m.id == s.id) pairs.push_back({m, s});
  return pairs;
}

// Tank frame to the film's place.
Vec2 from_place(const FilmPlace& place, const Vec2& on_water) {
  return Eigen::Rotation2Dd(-place.turn_deg / kDegPerRad) * (on_water - place.middle_mm);
}

std::vector<Vec2> points_of(const std::vector<Pair>& pairs,
                            const Eigen::Matrix<double, View::kValues, 1>& view,
                            const FilmPlace& place) {
  std::vector<Vec2> points;
  points.reserve(pairs.size());
  for (const Pair& pair : pairs)
    points.push_back(from_place(place, View::on_water(view, pair.seen.corner_px)));
  return points;
}

// The largest set of marks that can lie on one sheet.
std::vector<Pair> belonging_together(const std::vector<Pair>& pairs,
                                     const std::vector<Vec2>& points) {
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (std::size_t j = i + 1; j < pairs.size(); ++j) {
      const Vec2 printed = pairs[j].mark.corner - pairs[i].mark.corner;
      const Vec2 lies = points[j] - points[i];
      const double scale = lies.norm() / std::max(1e-9, printed.norm());
      if (printed.norm() < kLeastBase_mm || std::abs(scale - 1) > kMostSwelling) continue;
      const Eigen::Rotation2Dd turn(std::atan2(cross2(printed, lies), printed.dot(lies)));
      std::vector<std::size_t> fitting;
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        const Vec2 expected =
            points[i] + scale * (turn * (pairs[k].mark.corner - pairs[i].mark.corner));
        const bool again = std::any_of(fitting.begin(), fitting.end(), [&](std::size_t other) {
          return pairs[other].mark.id == pairs[k].mark.id;
        });
        if (!again && (points[k] - expected).norm() < kTogether_mm) fitting.push_back(k);
      }
      if (fitting.size() > best.size()) best = fitting;
    }
  std::vector<Pair> result;
  result.reserve(best.size());
  for (const std::size_t k : best) result.push_back(pairs[k]);
  return result;
}

Vec2 lies_at(const PoseValues& v, const Vec2& u) {
  return v.head<2>() + Eigen::Rotation2Dd(v[2]) * Vec2(v[3] * u.x(), v[4] * u.y());
}

Fit fit_sheet(const std::vector<Pair>& pairs, const std::vector<Vec2>& points) {
  // To begin with, as the first mark and the farthest one from it lie.
  std::size_t far = 1;
  for (std::size_t i = 1; i < pairs.size(); ++i)
    if ((pairs[i].mark.corner - pairs[0].mark.corner).norm() >
        (pairs[far].mark.corner - pairs[0].mark.corner).norm())
      far = i;
  const Vec2 printed = pairs[far].mark.corner - pairs[0].mark.corner,
             lies = points[far] - points[0];
  PoseValues start;
  start << 0, 0, std::atan2(cross2(printed, lies), printed.dot(lies)), 1, 1;
  start.head<2>() = points[0] - lies_at(start, pairs[0].mark.corner);
  return least_squares(
      [&](const Eigen::VectorXd& v) {
        Eigen::VectorXd off(2 * Eigen::Index(pairs.size()));
        for (std::size_t i = 0; i < pairs.size(); ++i)
          off.segment<2>(2 * Eigen::Index(i)) = lies_at(v, pairs[i].mark.corner) - points[i];
        return off;
      },
      start);
}

// Of the sheet's values: by scatter, and by what the view is known to.
Eigen::Matrix<double, 5, 5> covariance_of(const Fit& fit, const std::vector<Pair>& pairs,
                                          const View& view, const FilmPlace& place) {
  const double freedom = double(fit.residuals.size() - 5);
  const double scatter = std::max(kLeastScatter_mm * kLeastScatter_mm,
                                  fit.residuals.squaredNorm() / std::max(1.0, freedom));
  Eigen::Matrix<double, 5, 5> covariance = scatter * fit.covariance;
  Eigen::Matrix<double, 5, View::kValues> slope;
  for (int k = 0; k < View::kValues; ++k) {
    const double step = std::max(1e-9, 0.1 * std::sqrt(view.covariance(k, k)));
    auto more = view.values, less = view.values;
    more[k] += step;
    less[k] -= step;
    slope.col(k) = (fit_sheet(pairs, points_of(pairs, more, place)).values -
                    fit_sheet(pairs, points_of(pairs, less, place)).values) /
                   (2 * step);
  }
  return covariance + slope * view.covariance * slope.transpose();
}

FilmPose pose_of(const std::vector<Pair>& pairs, const View& view, const FilmPlace& place) {
  const Fit fit = fit_sheet(pairs, points_of(pairs, view.values, place));
  const Eigen::Matrix<double, 5, 5> covariance = covariance_of(fit, pairs, view, place);
  FilmPose pose;
  pose.shift_mm = fit.values.head<2>();
  pose.turn_deg = kDegPerRad * fit.values[2];
  pose.swelling = fit.values.segment<2>(3);
  const auto sigma = [&](int k) { return std::sqrt(covariance(k, k)); };
  pose.shift_sigma_mm = {sigma(0), sigma(1)};
  pose.turn_sigma_deg = kDegPerRad * sigma(2);
  pose.swelling_sigma = {sigma(3), sigma(4)};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Vec2 off = -fit.residuals.segment<2>(2 * Eigen::Index(i));
    pose.marks.push_back(
        {pairs[i].mark.id, pairs[i].mark.corner, Eigen::Rotation2Dd(-fit.values[2]) * off});
  }
  pose.unexplained_rms_mm = std::sqrt(fit.residuals.squaredNorm() / double(pairs.size()));
  pose.board_rms_px = view.rms_px;
  pose.board_marks = view.board_marks;
  pose.view = view;
  return pose;
}

std::size_t rim_marks(const std::vector<SeenMark>& seen) {
  return std::size_t(std::count_if(seen.begin(), seen.end(), [](const SeenMark& mark) {
    return strip_place(mark.id).strip >= 0;
  }));
}

// Why a photo shows too little of the film.
[[noreturn]] void refuse_few_marks(const GrayImage& photo, const std::string& name,
                                   const std::vector<SeenMark>& seen, const FilmSearch& search,
                                   const RunContext& context) {
  const std::vector<SeenMark> back = find_marks(mirrored(photo), context);
  if (pairs_of(back, search.marks).size() >= kLeastMarks) {
    // The rim cannot lie upside down.
    if (rim_marks(back) > rim_marks(seen))
      throw InputError(fmt::format(
          "{}: the photo is mirrored, film and rim alike: turn off the camera's mirroring and take "
          "it again",
          name));
    throw InputError(fmt::format(
        "{}: the film lies upside down: its marks are mirrored; lay a new one with the side up "
        "that its margin says",
        name));
  }
  throw InputError(fmt::format(
      "{}: {} of the film's {} marks are to be seen, and 4 are needed; take the photo sharp, "
      "from above and without glare, of film printed with print.marks=on",
      name, pairs_of(seen, search.marks).size(), search.marks.size()));
}

void require_sure(const FilmPose& pose, const std::string& name) {
  if (pose.shift_sigma_mm.maxCoeff() <= kUnsure_mm && pose.turn_sigma_deg <= kUnsure_deg &&
      pose.swelling_sigma.maxCoeff() <= kUnsureSwelling)
    return;
  throw InputError(fmt::format(
      "{}: tells where the film lies to {:.1f} x {:.1f} mm, {:.2f} degrees and {:.1f} % of "
      "swelling only, too little to move it by ({:g} mm, {:g} degrees, {:g} %): take the photo "
      "with the whole rim in it, from above, and measure the water's level well",
      name, pose.shift_sigma_mm.x(), pose.shift_sigma_mm.y(), pose.turn_sigma_deg,
      100 * pose.swelling_sigma.maxCoeff(), kUnsure_mm, kUnsure_deg, 100 * kUnsureSwelling));
}

}  // namespace

Vec2 FilmPose::at(const Vec2& u) const {
  return shift_mm + Eigen::Rotation2Dd(turn_deg / kDegPerRad) * u.cwiseProduct(swelling);
}

FilmPose find_film(const GrayImage& photo, const std::string& name, const Tank& tank,
                   const FilmSearch& search, const RunContext& context) {
  if (photo.width_px != tank.width_px || photo.height_px != tank.height_px)
    throw InputError(fmt::format(
        "{}: has {} x {} px, and the camera was calibrated with photos of {} x {}; use the same "
        "camera, held the same way up",
        name, photo.width_px, photo.height_px, tank.width_px, tank.height_px));
  const std::vector<SeenMark> seen = find_marks(photo, context);
  const std::vector<Pair> pairs = pairs_of(seen, search.marks);
  if (pairs.size() < kLeastMarks) refuse_few_marks(photo, name, seen, search, context);
  const View view = view_of({name, seen}, tank, search.water_sigma_mm);
  const std::vector<Pair> together =
      belonging_together(pairs, points_of(pairs, view.values, tank.place));
  if (together.size() < kLeastMarks)
    throw InputError(fmt::format(
        "{}: the marks to be seen do not lie as on this job's sheet: it is another job's film, or "
        "not film at all",
        name));
  FilmPose pose = pose_of(together, view, tank.place);
  pose.foreign = int(pairs.size() - together.size());
  if (!search.any_turn && std::abs(pose.turn_deg) > kTurned_deg)
    throw InputError(fmt::format(
        "{}: the film lies turned by {:.0f} degrees: its margin says which edge is the top; lay it "
        "anew, or tell where it is to lie with --set-place",
        name, pose.turn_deg));
  if (pose.swelling.minCoeff() < kLeastSwelling || pose.swelling.maxCoeff() > kLargestSwelling)
    throw InputError(fmt::format(
        "{}: the film would have swollen by {:.1f} x {:.1f} %: it is another job's sheet, was "
        "printed scaled, or the water's level (--water-below) is wrong",
        name, 100 * (pose.swelling.x() - 1), 100 * (pose.swelling.y() - 1)));
  if (pose.unexplained_rms_mm > search.tolerance_mm)
    throw InputError(fmt::format(
        "{}: the film's marks are {:.2f} mm off any evenly swollen sheet (--tolerance {:g}): it is "
        "creased or torn, or another job's; lay a new one",
        name, pose.unexplained_rms_mm, search.tolerance_mm));
  require_sure(pose, name);
  return pose;
}

}  // namespace hydrodip
