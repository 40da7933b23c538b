// A hole too small to see must not tear a cell of film that everybody sees.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>

#include "coat/design.h"
#include "contains.h"
#include "job/prepare.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

constexpr double kRadius_mm = 30, kHole_mm = 0.06;
constexpr int kRings = 48, kSectors = 96;

Vec3 on_ball(int ring, int sector) {
  const double polar = std::numbers::pi * ring / kRings;
  const double around = 2 * std::numbers::pi * (sector % kSectors) / kSectors;
  return kRadius_mm * Vec3(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                           -std::cos(polar));
}

// A ball of 60 mm whose south pole enters first. In the first triangle of that ring, counted from
// the south pole, a small triangle is missing; -1: the ball is whole.
void write_ball(const std::filesystem::path& path, int pierced_ring) {
  std::ofstream file(path);
  long written = 0;
  const auto vertex = [&](const Vec3& p) {
    file << fmt::format("v {:.9f} {:.9f} {:.9f}\n", p.x(), p.y(), p.z());
    return ++written;
  };
  const auto triangle = [&](const std::array<Vec3, 3>& p) {
    for (const Vec3& corner : p) vertex(corner);
    file << "f -3 -2 -1\n";
  };
  const auto pierced = [&](const std::array<Vec3, 3>& p) {
    const Vec3 middle = (p[0] + p[1] + p[2]) / 3;
    const double width = (p[1] - p[0]).norm();
    std::array<Vec3, 3> hole;
    for (std::size_t i = 0; i < 3; ++i) hole[i] = middle + kHole_mm / width * (p[i] - middle);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      triangle({p[i], p[next], hole[i]});
      triangle({p[next], hole[next], hole[i]});
    }
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const Vec3 a = on_ball(ring, sector), b = on_ball(ring, sector + 1),
                 c = on_ball(ring + 1, sector + 1), d = on_ball(ring + 1, sector);
      const bool here = ring == pierced_ring && sector == 0;
      if (here) {
        pierced({a, c, d});
      } else {
        triangle({a, c, d});
      }
      if (ring > 0) triangle({a, b, c});
    }
}

struct Dipped {
  DippedObject dip;
  std::vector<std::string> warnings;
};

Dipped dipped_ball(int pierced_ring) {
  const TemporaryFolder folder;
  write_ball(folder / "ball.obj", pierced_ring);
  RunContext context;
  const PreparedObject prepared = prepare_object(folder / "ball.obj", {}, context);
  DesignOptions options;
  options.film.width_mm = options.film.height_mm = 120;
  options.film.elements = 8000;
  options.dip.step_mm = 0.5;
  options.trajectory.depth_mm = 8;
  Timings timings;
  const auto film = std::make_shared<const FilmMesh>(make_film_mesh(options.film));
  const Trajectory way = make_trajectory(options.trajectory, prepared.posed.mesh().positions);
  return {dip_object(prepared.posed, film, way, options.dip, timings, context), context.warnings()};
}

bool warned(const Dipped& dipped, const std::string& part) {
  for (const std::string& warning : dipped.warnings)
    if (contains(warning, part)) return true;
  return false;
}

// Beside the pole, where the film touches first, and on the flank, where it stretches.
TEST(Pinhole, TearsNoFilmAndIsSaid) {
  const Dipped whole = dipped_ball(-1);
  EXPECT_FALSE(warned(whole, "hole"));
  EXPECT_EQ(whole.dip.coverage.torn_mm2, 0);
  for (const int ring : {0, 10}) {
    const Dipped pierced = dipped_ball(ring);
    EXPECT_TRUE(warned(pierced, "Closed 1 hole")) << ring;
    EXPECT_EQ(pierced.dip.film->torn, whole.dip.film->torn) << ring;
    EXPECT_NEAR(pierced.dip.coverage.film_on_object_mm2, whole.dip.coverage.film_on_object_mm2, 1)
        << ring;
    double farthest_mm = 0;
    for (std::size_t v = 0; v < whole.dip.film->position.size(); ++v)
      farthest_mm = std::max(farthest_mm,
                             (pierced.dip.film->position[v] - whole.dip.film->position[v]).norm());
    EXPECT_LT(farthest_mm, 0.01) << ring;
  }
}

}  // namespace
}  // namespace hydrodip
