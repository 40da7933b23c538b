// Scans with their colours, as a scanner with a camera makes them: a dipped shape of the kit, its
// print baked into a texture under lamps from somewhere, in a random pose.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "calibrate/checkerboard_dip.h"
#include "image/image.h"

namespace hydrodip::scans {

class ColouredScans {
 public:
  // Refers to both. Texels of `texel_mm`, seen from below.
  ColouredScans(const CalibrationObject& object, const Surface& surface, const CheckerboardDip& dip,
                double texel_mm)
      : object_(object), texel_mm_(texel_mm) {
    const Box3 box = object.object.bounds();
    // What lies above the dip all over is not looked at: from below one cannot see it.
    for (const Triangle& t : object.object.triangles) {
      double bottom = 1e300;
      for (const auto v : t) bottom = std::min(bottom, object.object.positions[std::size_t(v)].z());
      if (bottom < box.min.z() + object.depth_mm) triangles_.push_back(t);
    }
    half_ = 0.5 * std::max(box.size().x(), box.size().y());
    side_ = int(std::ceil(2 * half_ / texel_mm));
    for (int y = 0; y < side_; ++y)
      for (int x = 0; x < side_; ++x) texels_.push_back(texel(surface, dip, x, y, box.min.z()));
  }

  struct Scan {
    Object object;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  // posed object to scan
  };
  Scan scan(std::uint32_t seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> even;
    Scan scan;
    scan.pose.linear() =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
            .normalized()
            .toRotationMatrix();
    scan.pose.translation() = 100 * Vec3(even(random), even(random), even(random));
    // A lamp from below and aside, and light from everywhere.
    const Vec3 lamp =
        Vec3(even(random) - 0.5, even(random) - 0.5, -0.3 - 0.7 * even(random)).normalized();
    auto image = std::make_shared<Image>(side_, side_);
    for (int y = 0; y < side_; ++y)
      for (int x = 0; x < side_; ++x) {
        const Texel& texel = texels_[std::size_t(y) * std::size_t(side_) + std::size_t(x)];
        const double light = 0.45 + 0.5 * std::max(0.0, lamp.dot(texel.normal));
        const double seen = light * (0.85 - 0.8 * texel.ink);
        const double value = double(linear_to_srgb(float(seen))) + 0.01 * normal(random);
        std::uint8_t* pixel = image->pixel(x, side_ - 1 - y);
        for (int k = 0; k < 3; ++k) pixel[k] = std::uint8_t(255 * std::clamp(value, 0.0, 1.0));
        pixel[3] = 255;
      }
    Object& object = scan.object;
    for (const Vec3& p : object_.object.positions) object.positions.push_back(scan.pose * p);
    object.triangles = triangles_;
    object.material_of.assign(triangles_.size(), 0);
    object.materials.resize(1);
    object.materials[0].texture = 0;
    object.textures.push_back(image);
    for (const Triangle& t : triangles_) {
      CornerUv uv;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = object_.object.positions[std::size_t(t[k])];
        uv[k] = ((p.head<2>() + Vec2::Constant(half_)) / (side_ * texel_mm_)).cast<float>();
      }
      object.uvs.push_back(uv);
    }
    return scan;
  }

 private:
  struct Texel {
    float ink = 0;
    Vec3 normal = Vec3::Zero();
  };

  Texel texel(const Surface& surface, const CheckerboardDip& dip, int x, int y,
              double lowest) const {
    Texel result;
    constexpr int kSamples = 2;
    for (int i = 0; i < kSamples * kSamples; ++i) {
      const Vec2 p = texel_mm_ * Vec2(x + (i % kSamples + 0.5) / kSamples,
                                      y + (i / kSamples + 0.5) / kSamples) -
                     Vec2::Constant(half_);
      const auto hit = surface.first_hit(Vec3(p.x(), p.y(), lowest - 1), Vec3::UnitZ(), 0, 1000);
      if (!hit) continue;
      result.normal = surface.normal(*hit);
      const auto u = dip.map->to_film(surface.position(*hit), result.normal);
      if (u)
        result.ink += float(dip.board.ink_of(dip.board.square_at(*u))) / 255 / kSamples / kSamples;
    }
    return result;
  }

  const CalibrationObject& object_;
  double texel_mm_;
  double half_ = 0;
  int side_ = 0;
  std::vector<Triangle> triangles_;
  std::vector<Texel> texels_;
};

// How corners that were found lie against where the dip laid them.
struct CornersFound {
  std::size_t corners = 0, misnumbered = 0;
  double rms_mm = 0, worst_mm = 0;
};

// Takes each corner for the printed one that landed nearest; numbers are right if they all lie on
// the board alike, up to a shift and a quarter turn.
inline CornersFound judge(const CornerGrid& grid, const ColouredScans::Scan& scan,
                          const GridLanding& landing, const GridPlace& reach) {
  CornersFound found;
  found.corners = grid.position.size();
  std::vector<std::pair<GridPlace, Vec3>> landed;
  for (int row = -reach[1]; row <= reach[1]; ++row)
    for (int column = -reach[0]; column <= reach[0]; ++column)
      if (const auto at = landing({column, row})) landed.push_back({{column, row}, *at});
  std::map<std::array<int, 4>, std::size_t> agree;  // patch, quarter turn, shift: how many
  for (std::size_t c = 0; c < grid.position.size(); ++c) {
    const Vec3 p = scan.pose.inverse() * grid.position[c];
    const auto nearest =
        std::min_element(landed.begin(), landed.end(), [&](const auto& a, const auto& b) {
          return (a.second - p).squaredNorm() < (b.second - p).squaredNorm();
        });
    const double off = (nearest->second - p).norm();
    found.rms_mm += off * off / double(grid.position.size());
    found.worst_mm = std::max(found.worst_mm, off);
    GridPlace place = grid.place[c];
    for (int turn = 0; turn < 4; ++turn) {
      ++agree[{grid.patch[c], turn, nearest->first[0] - place[0], nearest->first[1] - place[1]}];
      place = {-place[1], place[0]};
    }
  }
  found.rms_mm = std::sqrt(found.rms_mm);
  std::map<int, std::size_t> most;
  for (const auto& [key, count] : agree) most[key[0]] = std::max(most[key[0]], count);
  found.misnumbered = grid.position.size();
  for (const auto& [patch, count] : most) found.misnumbered -= count;
  return found;
}

}  // namespace hydrodip::scans
