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
// A photo of a rim that is as it was calibrated fits it so much worse than the calibration's own
// at most, and even a blurred one so well.
constexpr double kWorseThanCalibrated = 4, kBlurredFit_px = 0.3;
// Calibrations know strips to a few hundredths of a millimetre; what is moved by less than this
// moves the film by a third of it.
constexpr double kMoved_mm = 0.3, kSure = 5;
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
  std::map<int, int> times;
  for (const SeenMark& mark : photo.marks) ++times[mark.id];
  for (const SeenMark& mark : photo.marks)
    if (const int strip = strip_place(mark.id).strip; strip >= 0 && times[mark.id] == 1)
      strips[strip].push_back(mark);
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

// Of a strip of which there is a second print in the photo, its number; -1: there is none.
int strip_seen_twice(const std::vector<SeenMark>& marks) {
  std::map<int, int> seen, twice;
  for (const SeenMark& mark : marks)
    if (++seen[mark.id] == 2) ++twice[strip_place(mark.id).strip];
  // A single one may be a tag that was misread.
  for (const auto& [strip, tags] : twice)
    if (strip >= 0 && tags > 1) return strip;
  return -1;
}

using ViewValues = Eigen::Matrix<double, View::kValues, 1>;

// The point at that height, tank frame, that a pixel sees.
Vec2 on_level(const ViewValues& values, const Vec2& px, double z_mm) {
  const Pose pose = Pose::of(values.head<6>());
  const Lens lens = Lens::of(values.segment<Lens::kValues>(6));
  const Mat3 back = pose.rotation().transpose();
  const Vec3 eye = -(back * pose.shift), ray = back * lens.ray(px);
  return (eye + (z_mm - eye.z()) / ray.z() * ray).head<2>();
}

struct RimCorner {
  int strip = 0;
  Vec3 at = Vec3::Zero();  // as calibrated
  Vec2 px = Vec2::Zero();
};
using RimCorners = std::vector<RimCorner>;

// Two sides of the tank at least.
bool reaches_around(const RimCorners& corners) {
  if (corners.size() < kLeastBoardMarks) return false;
  Mat2 spread = Mat2::Zero();
  Vec2 mean = Vec2::Zero();
  const auto count = double(corners.size());
  for (const RimCorner& c : corners) mean += c.at.head<2>() / count;
  for (const RimCorner& c : corners)
    spread += (c.at.head<2>() - mean) * (c.at.head<2>() - mean).transpose() / count;
  return eigenpairs(spread).values[0] > 400;
}

// Where a photo was taken, by what its corners tell and what was known before.
class ViewFinder {
 public:
  ViewFinder(const Tank& tank, double water_sigma_mm)
      : tank_(tank), water_sigma_mm_(water_sigma_mm) {
    Eigen::Matrix<double, Lens::kValues, Lens::kValues> known = tank.lens_covariance;
    known(0, 0) += std::pow(kRefocus * tank.lens.focal_px, 2);
    known(1, 1) += kFloat_px * kFloat_px;
    known(2, 2) += kFloat_px * kFloat_px;
    // In units of its deviation, along axes in which it is independent.
    const Eigenpairs axes = eigenpairs(known);
    to_units_ = axes.values.cwiseMax(1e-300).cwiseSqrt().cwiseInverse().asDiagonal() *
                axes.vectors.transpose();
  }

  Eigen::VectorXd start(const RimCorners& corners) const {
    std::vector<Vec2> flat, seen;
    for (const RimCorner& c : corners) {
      flat.emplace_back(c.at.head<2>());
      seen.emplace_back(tank_.lens.ray(c.px).head<2>());
    }
    Eigen::VectorXd values(View::kValues);
    values << pose_of_plane(homography(flat, seen)).values(), tank_.lens.values(),
        tank_.water_below_mm;
    return values;
  }

  Fit fit(const RimCorners& corners, const Eigen::VectorXd& from) const {
    return least_squares([&](const Eigen::VectorXd& v) { return residuals(v, corners); }, from);
  }

  // With what scatters more than a corner should.
  static Eigen::MatrixXd covariance(const Fit& fit) {
    const double freedom = double(fit.residuals.size() - fit.values.size());
    return std::max(1.0, freedom > 0 ? fit.residuals.squaredNorm() / freedom : 1.0) *
           fit.covariance;
  }

 private:
  Eigen::VectorXd residuals(const Eigen::VectorXd& v, const RimCorners& corners) const {
    const Pose pose = Pose::of(v.head<6>());
    const Mat3 turn = pose.rotation();
    const Lens lens = Lens::of(v.segment<Lens::kValues>(6));
    const auto end = 2 * Eigen::Index(corners.size());
    Eigen::VectorXd off(end + Lens::kValues + 1);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      Vec3 point = turn * corners[i].at + pose.shift;
      point.z() = std::max(point.z(), 1.0);
      off.segment<2>(2 * Eigen::Index(i)) = (lens.project(point) - corners[i].px) / kCorner_px;
    }
    off.segment(end, Lens::kValues) =
        to_units_ * (v.segment(6, Lens::kValues) - tank_.lens.values());
    off[end + Lens::kValues] = (v[View::kValues - 1] - tank_.water_below_mm) / water_sigma_mm_;
    return off;
  }

  const Tank& tank_;
  double water_sigma_mm_;
  Eigen::MatrixXd to_units_;
};

// How far a strip, which moves as a whole, lies off its place, seen from there: per corner.
Eigen::VectorXd strip_motion(const RimCorners& strip, const ViewValues& view) {
  std::vector<Vec2> from, to;
  for (const RimCorner& c : strip) {
    from.emplace_back(c.at.head<2>());
    to.push_back(on_level(view, c.px, c.at.z()));
  }
  const Planar move = planar_fit(from, to);
  Eigen::VectorXd motion(2 * Eigen::Index(strip.size()));
  for (std::size_t i = 0; i < from.size(); ++i)
    motion.segment<2>(2 * Eigen::Index(i)) =
        Eigen::Rotation2Dd(move.turn) * from[i] + Vec2(move.x, move.y) - from[i];
  return motion;
}

struct MovedStrip {
  int strip = 0;
  double moved_mm = 0, sigma_mm = 0;  // of the corner that has moved farthest
  double others_px = 0;               // what the rest of the rim then fits to
};

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

// The strip without which all others fit best: corner by corner one that has moved as a whole is
// not found, as the view gives way to it.
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

}  // namespace

Tank calibrate_tank(const std::vector<SeenPhoto>& all_photos, int width_px, int height_px,
                    const RunContext& context) {
  std::vector<SeenPhoto> photos;
  for (const SeenPhoto& photo : all_photos)
    if (const int twice = strip_seen_twice(photo.marks); twice < 0)
      photos.push_back(photo);
    else
      context.warn(fmt::format(
          "{}: shows strip {} of the board twice, and only one of the two can be meant; left out.",
          photo.name, twice + 1));
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
  return on_level(values, px, -values[kValues - 1]);
}

View view_of(const SeenPhoto& photo, const Tank& tank, double water_sigma_mm) {
  if (const int strip = strip_seen_twice(photo.marks); strip >= 0)
    throw InputError(fmt::format(
        "{}: strip {} of the board is to be seen twice: take the second print of it out of the "
        "picture, and take the photo again",
        photo.name, strip + 1));
  std::map<int, int> times;
  for (const SeenMark& mark : photo.marks) ++times[mark.id];
  RimCorners corners;
  for (const SeenMark& mark : photo.marks) {
    const auto known = tank.corner_mm.find(mark.id);
    if (known != tank.corner_mm.end() && times[mark.id] == 1)
      corners.push_back({strip_place(mark.id).strip, known->second, mark.corner_px});
  }
  if (!reaches_around(corners))
    throw InputError(fmt::format(
        "{}: too few marks of the tank's rim are to be seen ({}); take the photo so that strips on "
        "at least two sides of the tank are in it, sharp and without glare",
        photo.name, corners.size()));

  const ViewFinder finder(tank, water_sigma_mm);
  Fit fit = finder.fit(corners, finder.start(corners));
  const std::optional<MovedStrip> moved = most_moved(corners, finder, fit.values);
  std::vector<double> off;
  for (std::size_t i = 0; i < corners.size(); ++i)
    off.push_back(kCorner_px * fit.residuals.segment<2>(2 * Eigen::Index(i)).norm());
  const double astray_px = std::max(kAstray_px, kAstray * median(off));
  RimCorners kept;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (off[i] <= astray_px) kept.push_back(corners[i]);
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
  if (moved && moved->others_px <= limit_px &&
      moved->moved_mm > std::max(kMoved_mm, kSure * moved->sigma_mm))
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
