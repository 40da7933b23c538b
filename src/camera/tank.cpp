#include "camera/tank.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "base/eigenpairs.h"
#include "base/error.h"
#include "camera/board.h"
#include "camera/corner_fit.h"
#include "camera/planar_motion.h"
#include "camera/rim_bundle.h"

namespace hydrodip {
namespace {

// A strip has to show so many of its marks to be begun with.
constexpr std::size_t kMarksToBegin = 6;
constexpr std::size_t kLeastPhotos = 4;
// Lenses of phones see about so far around, to begin with.
constexpr double kUsualFocal = 0.75;  // over the picture's longer side
constexpr double kWorstFocal = 0.005;

std::vector<SeenPhoto> clear_photos(const std::vector<SeenPhoto>& all, const RunContext& context) {
  std::vector<SeenPhoto> photos;
  for (const SeenPhoto& photo : all)
    if (const int twice = strip_seen_twice(photo); twice < 0)
      photos.push_back(photo);
    else
      context.warn(fmt::format(
          "{}: shows strip {} of the board twice, and only one of the two can be meant; left out.",
          photo.name, twice + 1));
  return photos;
}

// Which strips are well seen, and in how many photos.
std::map<int, int> sightings_of(const std::vector<SeenPhoto>& photos) {
  std::map<int, int> sightings;
  for (const SeenPhoto& photo : photos)
    for (const auto& [strip, marks] : by_strip(photo))
      if (marks.size() >= kMarksToBegin) ++sightings[strip];
  return sightings;
}

// The one that all others refer to.
int most_seen(const std::map<int, int>& sightings) {
  if (sightings.empty())
    throw InputError(
        "no strip of the board is to be seen in these photos; print it with 'hydrodip register "
        "board', glue it to the tank's rim and photograph it sharp, from above");
  return std::max_element(sightings.begin(), sightings.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

Mat3 strip_to_px(const std::vector<SeenMark>& marks) {
  std::vector<Vec2> from, to;
  for (const SeenMark& mark : marks) {
    from.push_back(strip_place(mark.id).corner);
    to.push_back(mark.corner_px);
  }
  return homography(from, to);
}

// Where a camera stands before a strip, as a lens without distortion would have it.
Pose camera_before(const Mat3& to_px, const Lens& lens) {
  Mat3 from_px;
  from_px << 1, 0, -lens.center_px.x(), 0, 1, -lens.center_px.y(), 0, 0, lens.focal_px;
  return pose_of_plane(from_px * to_px);
}

// What a calibration begins with.
struct RimStart {
  RimBundle bundle;
  std::map<int, int> number;  // in the bundle, of a strip
  RimUnknowns unknowns;       // lens and cameras
  std::vector<PlanarMotion> planar;
};

RimStart start_of(const std::vector<SeenPhoto>& photos, int width_px, int height_px,
                  const RunContext& context) {
  std::map<int, int> sightings = sightings_of(photos);
  const int first = most_seen(sightings);
  RimStart start;
  start.number = {{first, 0}};
  RimBundle& bundle = start.bundle;
  bundle.middle_px = 0.5 * Vec2(width_px, height_px);
  Lens& lens = start.unknowns.lens;
  lens.focal_px = kUsualFocal * std::max(width_px, height_px);
  lens.center_px = bundle.middle_px;
  std::map<int, std::vector<PlanarMotion>> found;
  for (const SeenPhoto& photo : photos) {
    const auto strips = by_strip(photo);
    const auto reference = strips.find(first);
    if (reference == strips.end() || reference->second.size() < kMarksToBegin) {
      context.warn(
          fmt::format("{}: does not show strip {} of the board; left out.", photo.name, first + 1));
      continue;
    }
    const Mat3 to_px = strip_to_px(reference->second), to_plane = to_px.inverse();
    start.unknowns.cameras.push_back(camera_before(to_px, lens));
    for (const auto& [strip, marks] : strips) {
      if (strip != first && sightings[strip] < 2) continue;
      const int at = start.number.emplace(strip, int(start.number.size())).first->second;
      std::vector<Vec2> from, to;
      for (const SeenMark& mark : marks) {
        const Vec2 corner = strip_place(mark.id).corner;
        bundle.seen.push_back({bundle.photos, at, mark.id, corner, mark.corner_px});
        from.push_back(corner);
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
  bundle.strips = int(start.number.size());
  start.planar.resize(start.number.size());
  for (const auto& [at, all] : found) start.planar[std::size_t(at)] = median_of(all);
  return start;
}

void require_known(const Tank& tank) {
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

// Of every mark that was seen and belongs, tank frame.
std::map<int, Vec3> corners_of(const RimBundle& bundle, const std::map<int, int>& number,
                               const std::vector<Pose>& strips) {
  std::set<int> tags;
  for (const RimObservation& o : bundle.seen) tags.insert(o.tag);
  const auto strip_pose = [&](int strip) -> const Pose& {
    return strips[std::size_t(number.at(strip))];
  };
  std::map<int, Vec3> corners;
  std::vector<Vec3> all;
  int lowest = number.begin()->first;
  for (const int tag : tags) {
    const StripPlace at = strip_place(tag);
    lowest = std::min(lowest, at.strip);
    corners[tag] = strip_pose(at.strip) * Vec3(at.corner.x(), at.corner.y(), 0);
    all.push_back(corners[tag]);
  }
  const Pose to_tank = tank_frame(all, strip_pose(lowest).rotation().col(0));
  for (auto& [tag, corner] : corners) corner = to_tank * corner;
  return corners;
}

}  // namespace

Tank calibrate_tank(const std::vector<SeenPhoto>& photos, int width_px, int height_px,
                    const RunContext& context) {
  RimStart start = start_of(clear_photos(photos, context), width_px, height_px, context);
  context.progress("calibrating the camera", 0.5);
  const RimSolution solved = solve(start.bundle, start.unknowns, start.planar);

  Tank tank;
  tank.width_px = width_px;
  tank.height_px = height_px;
  tank.lens = solved.unknowns.lens;
  tank.rms_px = rms_px(solved.fit, start.bundle.seen.size());
  tank.lens_covariance =
      scatter_of(solved.fit) * solved.fit.covariance.topLeftCorner<Lens::kValues, Lens::kValues>();
  require_known(tank);
  tank.corner_mm = corners_of(start.bundle, start.number, solved.unknowns.strips);
  context.progress("calibrating the camera", 1);
  return tank;
}

}  // namespace hydrodip
