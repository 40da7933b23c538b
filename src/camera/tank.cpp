#include "camera/tank.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/eigenpairs.h"
#include "base/error.h"
#include "camera/board.h"
#include "camera/least_squares.h"

namespace hydrodip {
namespace {

constexpr double kCorner_px = 0.1;  // what a corner is known to
// A strip has to show so many of its marks to be begun with.
constexpr std::size_t kMarksToBegin = 6;
constexpr std::size_t kLeastPhotos = 4;
// Lenses of phones see about so far around, to begin with.
constexpr double kUsualFocal = 0.75;  // over the picture's longer side
constexpr double kWorstFocal = 0.005;
constexpr double kWorstFit_px = 1.5;
// Corners that lie so much farther off than most do not belong to what is fitted.
constexpr double kAstray = 6, kAstray_px = 0.6;
// From picture to picture a phone focuses anew, and its lens floats.
constexpr double kRefocus = 0.003, kFloat_px = 5;
constexpr std::size_t kLeastBoardMarks = 8;

struct Observation {
  int photo = 0, strip = 0;  // numbers in Bundle
  int tag = 0;
  Vec2 on_strip = Vec2::Zero(), px = Vec2::Zero();
};

struct Bundle {
  int photos = 0, strips = 0;  // strip 0 is the one that all others refer to
  Vec2 middle_px = Vec2::Zero();
  std::vector<Observation> seen;
};

std::map<int, std::vector<SeenMark>> by_strip(const SeenPhoto& photo) {
  std::map<int, std::vector<SeenMark>> strips;
  for (const SeenMark& mark : photo.marks)
    if (const int strip = strip_place(mark.id).strip; strip >= 0) strips[strip].push_back(mark);
  return strips;
}

Mat3 strip_to_px(const std::vector<SeenMark>& marks) {
  std::vector<Vec2> from, to;
  for (const SeenMark& mark : marks) {
    from.push_back(strip_place(mark.id).corner);
    to.push_back(mark.corner_px);
  }
  return homography(from, to);
}

// How a strip lies in the plane of the first one.
struct Planar {
  double x = 0, y = 0, turn = 0;
};

Planar planar_fit(const std::vector<Vec2>& from, const std::vector<Vec2>& to) {
  Vec2 a = Vec2::Zero(), b = Vec2::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    a += from[i] / double(from.size());
    b += to[i] / double(from.size());
  }
  double dot = 0, cross = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    dot += (from[i] - a).dot(to[i] - b);
    cross += cross2(from[i] - a, to[i] - b);
  }
  const double turn = std::atan2(cross, dot);
  const Vec2 shift = b - Eigen::Rotation2Dd(turn) * a;
  return {shift.x(), shift.y(), turn};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Planar median_of(const std::vector<Planar>& all) {
  std::vector<double> x, y, cosine, sine;
  for (const Planar& p : all) {
    x.push_back(p.x);
    y.push_back(p.y);
    cosine.push_back(std::cos(p.turn));
    sine.push_back(std::sin(p.turn));
  }
  return {median(x), median(y), std::atan2(median(sine), median(cosine))};
}

Eigen::VectorXd off_px(const Bundle& bundle, const Lens& lens, const std::vector<Pose>& cameras,
                       const std::vector<Pose>& strips) {
  const auto rotations = [](const std::vector<Pose>& poses) {
    std::vector<Mat3> result;
    result.reserve(poses.size());
    for (const Pose& pose : poses) result.push_back(pose.rotation());
    return result;
  };
  const std::vector<Mat3> camera_turn = rotations(cameras), strip_turn = rotations(strips);
  Eigen::VectorXd off(2 * Eigen::Index(bundle.seen.size()));
  for (std::size_t i = 0; i < bundle.seen.size(); ++i) {
    const Observation& o = bundle.seen[i];
    const auto s = std::size_t(o.strip), c = std::size_t(o.photo);
    const Vec3 on_rim = strip_turn[s].leftCols<2>() * o.on_strip + strips[s].shift;
    Vec3 point = camera_turn[c] * on_rim + cameras[c].shift;
    point.z() = std::max(point.z(), 1.0);
    off.segment<2>(2 * Eigen::Index(i)) = lens.project(point) - o.px;
  }
  return off;
}

// All of a bundle's unknowns one after another: lens, cameras, strips but the first.
struct Unknowns {
  Lens lens;
  std::vector<Pose> cameras, strips;
};

Eigen::VectorXd packed(const Unknowns& u) {
  Eigen::VectorXd v(Lens::kValues +
                    Pose::kValues * Eigen::Index(u.cameras.size() + u.strips.size() - 1));
  v.head<Lens::kValues>() = u.lens.values();
  Eigen::Index at = Lens::kValues;
  for (const Pose& camera : u.cameras) v.segment<6>(at) = camera.values(), at += 6;
  for (std::size_t s = 1; s < u.strips.size(); ++s)
    v.segment<6>(at) = u.strips[s].values(), at += 6;
  return v;
}

Unknowns unpacked(const Eigen::VectorXd& v, const Bundle& bundle) {
  Unknowns u{Lens::of(v.head<Lens::kValues>()), {}, {Pose()}};
  Eigen::Index at = Lens::kValues;
  for (int c = 0; c < bundle.photos; ++c, at += 6) u.cameras.push_back(Pose::of(v.segment<6>(at)));
  for (int s = 1; s < bundle.strips; ++s, at += 6) u.strips.push_back(Pose::of(v.segment<6>(at)));
  return u;
}

// First with strips in one plane and a lens that does not bend anything: from there all the rest
// is near.
Unknowns flat_fit(const Bundle& bundle, const Unknowns& start, const std::vector<Planar>& planar) {
  const Eigen::Index cameras = 6 * bundle.photos;
  Eigen::VectorXd v(1 + cameras + 3 * (bundle.strips - 1));
  v[0] = start.lens.focal_px;
  for (int c = 0; c < bundle.photos; ++c)
    v.segment<6>(1 + 6 * c) = start.cameras[std::size_t(c)].values();
  for (int s = 1; s < bundle.strips; ++s) {
    const Planar& p = planar[std::size_t(s)];
    v.segment<3>(1 + cameras + 3 * (s - 1)) = Vec3(p.x, p.y, p.turn);
  }
  const auto unpack = [&](const Eigen::VectorXd& values) {
    Unknowns u{{values[0], bundle.middle_px}, {}, {Pose()}};
    for (int c = 0; c < bundle.photos; ++c)
      u.cameras.push_back(Pose::of(values.segment<6>(1 + 6 * c)));
    for (int s = 1; s < bundle.strips; ++s) {
      const Vec3 p = values.segment<3>(1 + cameras + 3 * (s - 1));
      u.strips.push_back({Vec3(0, 0, p[2]), Vec3(p[0], p[1], 0)});
    }
    return u;
  };
  return unpack(least_squares(
                    [&](const Eigen::VectorXd& values) -> Eigen::VectorXd {
                      const Unknowns u = unpack(values);
                      return off_px(bundle, u.lens, u.cameras, u.strips) / kCorner_px;
                    },
                    v)
                    .values);
}

Fit whole_fit(const Bundle& bundle, const Unknowns& start) {
  return least_squares(
      [&](const Eigen::VectorXd& values) -> Eigen::VectorXd {
        const Unknowns u = unpacked(values, bundle);
        return off_px(bundle, u.lens, u.cameras, u.strips) / kCorner_px;
      },
      packed(start));
}

// Leaves out what lies astray; whether anything did.
bool clean(Bundle& bundle, const Eigen::VectorXd& residuals) {
  std::vector<double> off;
  for (std::size_t i = 0; i < bundle.seen.size(); ++i)
    off.push_back(kCorner_px * residuals.segment<2>(2 * Eigen::Index(i)).norm());
  const double limit = std::max(kAstray_px, kAstray * median(off));
  std::vector<Observation> kept;
  for (std::size_t i = 0; i < off.size(); ++i)
    if (off[i] <= limit) kept.push_back(bundle.seen[i]);
  const bool any = kept.size() < bundle.seen.size();
  bundle.seen = std::move(kept);
  return any;
}

double rms_px(const Fit& fit, std::size_t corners) {
  return kCorner_px * std::sqrt(fit.residuals.head(2 * Eigen::Index(corners)).squaredNorm() /
                                double(2 * corners));
}

// From the first strip's frame.
Pose tank_frame(const std::vector<Vec3>& corners, const Vec3& along) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& c : corners) mean += c / double(corners.size());
  Mat3 spread = Mat3::Zero();
  for (const Vec3& c : corners) spread += (c - mean) * (c - mean).transpose();
  Vec3 up = eigenpairs(spread).vectors.col(0);
  if (up.z() < 0) up = -up;
  Mat3 rotation;
  rotation.row(0) = (along - along.dot(up) * up).normalized();
  rotation.row(2) = up;
  rotation.row(1) = up.cross(rotation.row(0).transpose());
  Box3 box;
  for (const Vec3& c : corners) box.add(rotation * (c - mean));
  Vec3 middle = box.center();
  middle.z() = 0;
  return Pose::of(rotation, -(rotation * mean) - middle);
}

}  // namespace

Tank calibrate_tank(const std::vector<SeenPhoto>& photos, int width_px, int height_px,
                    const RunContext& context) {
  std::map<int, int> sightings;
  for (const SeenPhoto& photo : photos)
    for (const auto& [strip, marks] : by_strip(photo))
      if (marks.size() >= kMarksToBegin) ++sightings[strip];
  if (sightings.empty())
    throw InputError(
        "no strip of the board is to be seen in these photos; print it with 'hydrodip register "
        "board', glue it to the tank's rim and photograph it sharp, from above");
  const int first =
      std::max_element(sightings.begin(), sightings.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      })->first;

  Bundle bundle;
  bundle.middle_px = 0.5 * Vec2(width_px, height_px);
  std::map<int, int> number = {{first, 0}};
  Unknowns start;
  start.lens.focal_px = kUsualFocal * std::max(width_px, height_px);
  start.lens.center_px = bundle.middle_px;
  std::map<int, std::vector<Planar>> found;
  for (const SeenPhoto& photo : photos) {
    const auto strips = by_strip(photo);
    const auto reference = strips.find(first);
    if (reference == strips.end() || reference->second.size() < kMarksToBegin) {
      context.warn(
          fmt::format("{}: does not show strip {} of the board; left out.", photo.name, first + 1));
      continue;
    }
    const Mat3 to_px = strip_to_px(reference->second);
    Mat3 from_px;
    from_px << 1, 0, -bundle.middle_px.x(), 0, 1, -bundle.middle_px.y(), 0, 0, start.lens.focal_px;
    start.cameras.push_back(pose_of_plane(from_px * to_px));
    const Mat3 to_plane = to_px.inverse();
    for (const auto& [strip, marks] : strips) {
      if (strip != first && sightings[strip] < 2) continue;
      const int at = number.emplace(strip, int(number.size())).first->second;
      std::vector<Vec2> from, to;
      for (const SeenMark& mark : marks) {
        bundle.seen.push_back(
            {bundle.photos, at, mark.id, strip_place(mark.id).corner, mark.corner_px});
        from.push_back(strip_place(mark.id).corner);
        to.push_back((to_plane * mark.corner_px.homogeneous()).hnormalized());
      }
      if (strip != first && marks.size() >= kMarksToBegin)
        found[at].push_back(planar_fit(from, to));
    }
    ++bundle.photos;
  }
  if (std::size_t(bundle.photos) < kLeastPhotos)
    throw InputError(fmt::format(
        "only {} of these photos show strip {} of the board: give at least {}, better 12, from "
        "different sides",
        bundle.photos, first + 1, kLeastPhotos));
  bundle.strips = int(number.size());
  std::vector<Planar> planar(number.size());
  for (const auto& [at, all] : found) planar[std::size_t(at)] = median_of(all);

  context.progress("calibrating the camera", 0.5);
  Unknowns flat = flat_fit(bundle, start, planar);
  Fit fit = whole_fit(bundle, flat);
  if (clean(bundle, fit.residuals)) fit = whole_fit(bundle, unpacked(fit.values, bundle));
  const Unknowns solved = unpacked(fit.values, bundle);

  Tank tank;
  tank.width_px = width_px;
  tank.height_px = height_px;
  tank.lens = solved.lens;
  tank.rms_px = rms_px(fit, bundle.seen.size());
  const double freedom = double(fit.residuals.size() - fit.values.size());
  const double scale = freedom > 0 ? fit.residuals.squaredNorm() / freedom : 1;
  tank.lens_covariance = scale * fit.covariance.topLeftCorner<Lens::kValues, Lens::kValues>();
  if (!(tank.rms_px < kWorstFit_px))
    throw InputError(fmt::format(
        "the photos do not fit one camera and one board: corners are off by {:.1f} px; use one "
        "camera without zooming, and let no strip move between the photos",
        tank.rms_px));
  const double focal_sigma = std::sqrt(tank.lens_covariance(0, 0)) / tank.lens.focal_px;
  if (!(focal_sigma < kWorstFocal))
    throw InputError(fmt::format(
        "the photos are too much alike to tell the lens by (focal length to {:.1f} %): take more, "
        "from all four sides and well aslant",
        100 * focal_sigma));

  std::set<int> tags;
  for (const Observation& o : bundle.seen) tags.insert(o.tag);
  std::map<int, Vec3> corner;
  std::vector<Vec3> all;
  int lowest = number.begin()->first;
  for (const int tag : tags) {
    const StripPlace at = strip_place(tag);
    lowest = std::min(lowest, at.strip);
    corner[tag] =
        solved.strips[std::size_t(number[at.strip])] * Vec3(at.corner.x(), at.corner.y(), 0);
    all.push_back(corner[tag]);
  }
  const Pose to_tank =
      tank_frame(all, solved.strips[std::size_t(number[lowest])].rotation().col(0));
  for (const auto& [tag, place] : corner) tank.corner_mm[tag] = to_tank * place;
  context.progress("calibrating the camera", 1);
  return tank;
}

Vec2 View::on_water(const Eigen::Matrix<double, kValues, 1>& values, const Vec2& px) {
  const Pose pose = Pose::of(values.head<6>());
  const Lens lens = Lens::of(values.segment<Lens::kValues>(6));
  const Mat3 back = pose.rotation().transpose();
  const Vec3 eye = -(back * pose.shift), ray = back * lens.ray(px);
  const double t = (-values[kValues - 1] - eye.z()) / ray.z();
  return (eye + t * ray).head<2>();
}

View view_of(const SeenPhoto& photo, const Tank& tank, double water_sigma_mm) {
  std::vector<Vec2> px, flat, seen;
  std::vector<Vec3> corner;
  for (const SeenMark& mark : photo.marks) {
    const auto known = tank.corner_mm.find(mark.id);
    if (known == tank.corner_mm.end()) continue;
    corner.push_back(known->second);
    px.push_back(mark.corner_px);
    flat.push_back(known->second.head<2>());
    seen.push_back(tank.lens.ray(mark.corner_px).head<2>());
  }
  Mat2 spread = Mat2::Zero();
  Vec2 mean = Vec2::Zero();
  for (const Vec2& p : flat) mean += p / double(flat.size());
  for (const Vec2& p : flat) spread += (p - mean) * (p - mean).transpose() / double(flat.size());
  const bool wide = flat.size() >= kLeastBoardMarks && eigenpairs(spread).values[0] > 400;
  if (!wide)
    throw InputError(fmt::format(
        "{}: too few marks of the tank's rim are to be seen ({}); take the photo so that strips on "
        "at least two sides of the tank are in it, sharp and without glare",
        photo.name, px.size()));

  Eigen::Matrix<double, Lens::kValues, Lens::kValues> known = tank.lens_covariance;
  known(0, 0) += std::pow(kRefocus * tank.lens.focal_px, 2);
  known(1, 1) += kFloat_px * kFloat_px;
  known(2, 2) += kFloat_px * kFloat_px;
  // In units of its deviation, along axes in which it is independent.
  const Eigenpairs axes = eigenpairs(known);
  const Eigen::MatrixXd to_units =
      axes.values.cwiseMax(1e-300).cwiseSqrt().cwiseInverse().asDiagonal() *
      axes.vectors.transpose();
  const Eigen::VectorXd usual = tank.lens.values();
  const auto residuals = [&](const Eigen::VectorXd& v, const std::vector<std::size_t>& used) {
    const Pose pose = Pose::of(v.head<6>());
    const Mat3 turn = pose.rotation();
    const Lens lens = Lens::of(v.segment<Lens::kValues>(6));
    const auto corners = 2 * Eigen::Index(used.size());
    Eigen::VectorXd off(corners + Lens::kValues + 1);
    for (std::size_t i = 0; i < used.size(); ++i) {
      Vec3 point = turn * corner[used[i]] + pose.shift;
      point.z() = std::max(point.z(), 1.0);
      off.segment<2>(2 * Eigen::Index(i)) = (lens.project(point) - px[used[i]]) / kCorner_px;
    }
    off.segment(corners, Lens::kValues) = to_units * (v.segment(6, Lens::kValues) - usual);
    off[corners + Lens::kValues] = (v[View::kValues - 1] - tank.water_below_mm) / water_sigma_mm;
    return off;
  };
  Eigen::VectorXd start(View::kValues);
  start << pose_of_plane(homography(flat, seen)).values(), usual, tank.water_below_mm;
  std::vector<std::size_t> used(px.size());
  for (std::size_t i = 0; i < used.size(); ++i) used[i] = i;
  const auto fit_used = [&](const Eigen::VectorXd& from) {
    return least_squares([&](const Eigen::VectorXd& v) { return residuals(v, used); }, from);
  };
  Fit fit = fit_used(start);
  std::vector<double> off;
  for (std::size_t i = 0; i < used.size(); ++i)
    off.push_back(kCorner_px * fit.residuals.segment<2>(2 * Eigen::Index(i)).norm());
  const double limit = std::max(kAstray_px, kAstray * median(off));
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (off[i] <= limit) kept.push_back(i);
  if (kept.size() < used.size() && kept.size() >= kLeastBoardMarks) {
    used = kept;
    fit = fit_used(fit.values);
  }

  View view;
  view.values = fit.values;
  view.rms_px = rms_px(fit, used.size());
  view.board_marks = int(used.size());
  if (!(view.rms_px < kWorstFit_px))
    throw InputError(fmt::format(
        "{}: the rim's marks are {:.1f} px off where the calibration found them: a strip has "
        "moved, or it is another camera or zoom; calibrate again with 'hydrodip register "
        "--calibrate-camera'",
        photo.name, view.rms_px));
  const double freedom = double(fit.residuals.size() - fit.values.size());
  const double scale = std::max(1.0, freedom > 0 ? fit.residuals.squaredNorm() / freedom : 1.0);
  view.covariance = scale * fit.covariance;
  return view;
}

}  // namespace hydrodip
