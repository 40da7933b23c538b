#include "camera/rim_bundle.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "camera/corner_fit.h"

namespace hydrodip {
namespace {

Eigen::VectorXd off_px(const RimBundle& bundle, const Lens& lens, const std::vector<Pose>& cameras,
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
    const RimObservation& o = bundle.seen[i];
    const auto s = std::size_t(o.strip), c = std::size_t(o.photo);
    const Vec3 on_rim = strip_turn[s].leftCols<2>() * o.on_strip + strips[s].shift;
    Vec3 point = camera_turn[c] * on_rim + cameras[c].shift;
    point.z() = std::max(point.z(), 1.0);
    off.segment<2>(2 * Eigen::Index(i)) = lens.project(point) - o.px;
  }
  return off;
}

// All of a bundle's unknowns one after another: lens, cameras, strips but the first.
Eigen::VectorXd packed(const RimUnknowns& u) {
  Eigen::VectorXd v(Lens::kValues +
                    Pose::kValues * Eigen::Index(u.cameras.size() + u.strips.size() - 1));
  v.head<Lens::kValues>() = u.lens.values();
  Eigen::Index at = Lens::kValues;
  for (const Pose& camera : u.cameras) v.segment<6>(at) = camera.values(), at += 6;
  for (std::size_t s = 1; s < u.strips.size(); ++s)
    v.segment<6>(at) = u.strips[s].values(), at += 6;
  return v;
}

RimUnknowns unpacked(const Eigen::VectorXd& v, const RimBundle& bundle) {
  RimUnknowns u{Lens::of(v.head<Lens::kValues>()), {}, {Pose()}};
  Eigen::Index at = Lens::kValues;
  for (int c = 0; c < bundle.photos; ++c, at += 6) u.cameras.push_back(Pose::of(v.segment<6>(at)));
  for (int s = 1; s < bundle.strips; ++s, at += 6) u.strips.push_back(Pose::of(v.segment<6>(at)));
  return u;
}

// First with strips in one plane and a lens that does not bend anything: from there all the rest
// is near.
RimUnknowns flat_fit(const RimBundle& bundle, const RimUnknowns& start,
                     const std::vector<PlanarMotion>& planar) {
  const Eigen::Index cameras = 6 * bundle.photos;
  Eigen::VectorXd v(1 + cameras + 3 * (bundle.strips - 1));
  v[0] = start.lens.focal_px;
  for (int c = 0; c < bundle.photos; ++c)
    v.segment<6>(1 + 6 * c) = start.cameras[std::size_t(c)].values();
  for (int s = 1; s < bundle.strips; ++s) {
    const PlanarMotion& p = planar[std::size_t(s)];
    v.segment<3>(1 + cameras + 3 * (s - 1)) = Vec3(p.x, p.y, p.turn);
  }
  const auto unpack = [&](const Eigen::VectorXd& values) {
    RimUnknowns u{{values[0], bundle.middle_px}, {}, {Pose()}};
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
                      const RimUnknowns u = unpack(values);
                      return off_px(bundle, u.lens, u.cameras, u.strips) / kCorner_px;
                    },
                    v)
                    .values);
}

Fit whole_fit(const RimBundle& bundle, const RimUnknowns& start) {
  return least_squares(
      [&](const Eigen::VectorXd& values) -> Eigen::VectorXd {
        const RimUnknowns u = unpacked(values, bundle);
        return off_px(bundle, u.lens, u.cameras, u.strips) / kCorner_px;
      },
      packed(start));
}

// Leaves out what lies astray; whether anything did.
bool clean(RimBundle& bundle, const Fit& fit) {
  const std::vector<std::uint8_t> astray = lies_astray(fit, bundle.seen.size());
  std::vector<RimObservation> kept;
  for (std::size_t i = 0; i < bundle.seen.size(); ++i)
    if (!astray[i]) kept.push_back(bundle.seen[i]);
  const bool any = kept.size() < bundle.seen.size();
  bundle.seen = std::move(kept);
  return any;
}

}  // namespace

RimSolution solve(RimBundle& bundle, const RimUnknowns& start,
                  const std::vector<PlanarMotion>& planar) {
  Fit fit = whole_fit(bundle, flat_fit(bundle, start, planar));
  if (clean(bundle, fit)) fit = whole_fit(bundle, unpacked(fit.values, bundle));
  return {unpacked(fit.values, bundle), std::move(fit)};
}

}  // namespace hydrodip
