#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "dip/trajectory.h"
#include "rig/jig.h"
#include "rig/solids.h"
#include "sheet/film_marks.h"

namespace hydrodip {
namespace {

// Every edge is in two triangles, once each way.
bool is_watertight(const TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) return false;
  }
  return !edges.empty();
}

double volume_of(const TriangleMesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh.triangles)
    volume += mesh.positions[std::size_t(t[0])].dot(
                  mesh.positions[std::size_t(t[1])].cross(mesh.positions[std::size_t(t[2])])) /
              6;
  return volume;
}

TEST(Solids, ABoxWithAHoleIsWatertightAndOfItsVolume) {
  BoxSolid solid;
  solid.add({0, 0, 0}, {10, 20, 5});
  solid.add({10, 5, 0}, {14, 9, 3});
  solid.cut({3, 3, -1}, {6, 8, 6});
  solid.keep({-1, -1, -1}, {13, 30, 30});
  const TriangleMesh mesh = solid.mesh();
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume_of(mesh), 10 * 20 * 5 + 3 * 4 * 3 - 3 * 5 * 5, 1e-9);
}

TEST(Solids, ABodyBetweenHeightsIsWatertightAndOfItsVolume) {
  HeightSolid solid;
  for (int i = 0; i <= 20; ++i) solid.x.push_back(i), solid.y.push_back(0.5 * i);
  solid.low = [&](std::size_t i, std::size_t j) { return 0.1 * double(i) + 0.05 * double(j); };
  solid.high = [](std::size_t, std::size_t) { return 5.0; };
  solid.is_there = [](const Vec2& at) {
    return !(std::abs(at.x() - 10) < 2 && std::abs(at.y() - 5) < 1);
  };
  const TriangleMesh mesh = solid.mesh();
  EXPECT_TRUE(is_watertight(mesh));
  // Of a plane, the mean height times the area; the hole lies in its middle.
  EXPECT_NEAR(volume_of(mesh), (20 * 10 - 4 * 2) * (5 - 1.5), 1e-9);
}

// An L-shaped block on a ball's place: lowest point at z = 0.
TriangleMesh hook(double height_mm) {
  BoxSolid solid;
  solid.add({-20, -15, 0}, {20, 15, 12});
  solid.add({-20, -15, 12}, {-4, 15, height_mm});
  solid.add({-4, -15, 12}, {14, -3, height_mm - 6});
  return solid.mesh();
}

RigJob job_of(double depth_mm) {
  RigJob job;
  job.folder = "job";
  job.depth_mm = depth_mm;
  job.config.bath.width_mm = 370;
  job.config.bath.height_mm = 270;
  return job;
}

// The bench knows of a lean what the dip was computed with.
TEST(Hanging, IsAsTheDipBegins) {
  const TriangleMesh object = hook(40);
  for (const double tilt_deg : {0.0, 20.0}) {
    TrajectoryOptions options;
    options.depth_mm = 12;
    options.tilt_deg = tilt_deg;
    const Trajectory way = make_trajectory(options, object.positions);
    RigJob job = job_of(12);
    job.config.design.trajectory = options;
    job.way_in = {{0, way.at(0)}, {12, way.at(1)}};
    double lowest = 1e9;
    for (const Vec3& p : object.positions) {
      EXPECT_NEAR((hanging_pose(job) * p - way.bath_from_object(0) * p).norm(), 0, 1e-9);
      lowest = std::min(lowest, (hanging_pose(job) * p).z());
    }
    EXPECT_NEAR(lowest, 0, 1e-6) << tilt_deg;
    EXPECT_FALSE(moves_aside(job));
    EXPECT_EQ(hung_otherwise(job).empty(), tilt_deg == 0) << hung_otherwise(job);
  }
}

TEST(Jig, ItsPartsAreWatertightAndStandOnTheBed) {
  const TriangleMesh object = hook(40);
  const Surface surface(object.positions, object.triangles);
  const Jig jig = make_jig(job_of(12), object, surface, {});
  ASSERT_EQ(jig.parts.size(), 6U);  // mount, bar, four pieces of the frame
  for (const JigPart& part : jig.parts) {
    EXPECT_TRUE(is_watertight(part.mesh)) << part.name;
    EXPECT_GT(volume_of(part.mesh), 0) << part.name;
    EXPECT_NEAR(part.mesh.bounds().min.z(), 0, 1e-9) << part.name;
  }
  EXPECT_TRUE(jig.also_fits_deg.empty());
}

TEST(Jig, EveryPartFitsTheBedAsItLies) {
  const TriangleMesh object = hook(40);
  const Surface surface(object.positions, object.triangles);
  JigOptions roomy;
  roomy.bed_mm = {1000, 1000, 1000};
  const JigOptions usual;
  const Jig small = make_jig(job_of(12), object, surface, usual),
            large = make_jig(job_of(12), object, surface, roomy);
  for (const JigPart& part : small.parts) {
    EXPECT_TRUE((part.mesh.bounds().size().array() <= usual.bed_mm.array() + 1e-9).all())
        << part.name << ": " << part.mesh.bounds().size().transpose();
    EXPECT_TRUE(is_watertight(part.mesh)) << part.name;
  }
  // The bar is longer than the bed, and in use where it would be if it were not turned.
  ASSERT_GT(large.parts[1].mesh.bounds().size().x(), usual.bed_mm.x());
  ASSERT_EQ(small.parts[1].mesh.positions.size(), large.parts[1].mesh.positions.size());
  for (std::size_t i = 0; i < small.parts[1].mesh.positions.size(); ++i)
    EXPECT_LT((small.parts[1].in_use * small.parts[1].mesh.positions[i] -
               large.parts[1].in_use * large.parts[1].mesh.positions[i])
                  .norm(),
              1e-9);
}

TEST(Jig, LeavesTheMarksFree) {
  const TriangleMesh object = hook(40);
  const Surface surface(object.positions, object.triangles);
  for (const double margin_mm : {6.0, 8.0, 10.0}) {
    RigJob job = job_of(12);
    FilmOptions& film = job.config.design.film;
    film.margin_mm = margin_mm;
    const double inner = 0.5 * film.width_mm - tape_mm(job.config);
    for (const MarkPlace& mark : film_marks(film.width_mm, film.height_mm, margin_mm)) {
      const Box2 box = mark_outline(mark);
      EXPECT_LE(std::max(box.max.x(), -box.min.x()), inner + 1e-9);
    }
    EXPECT_LE(tape_mm(job.config), 3);
    job.config.print.camera_marks = false;
    EXPECT_EQ(tape_mm(job.config), margin_mm);
  }
}

TEST(Jig, TheSocketLeavesTheClearanceAndNotMuchMore) {
  const TriangleMesh object = hook(40);
  const Surface surface(object.positions, object.triangles);
  const JigOptions options;
  const Jig jig = make_jig(job_of(12), object, surface, options);
  TriangleMesh mount = jig.parts[0].mesh;
  for (Vec3& p : mount.positions) p = jig.parts[0].in_use * p;
  const Surface walls(mount.positions, mount.triangles);
  // Nothing of the mount is nearer to the object than the clearance, and none below the water's
  // rim.
  double nearest = 1e9;
  for (const Vec3& p : mount.positions) {
    EXPECT_GE(p.z(), 12 + 4 - 1e-9);
    if (const auto at = surface.closest_point(p, 5)) nearest = std::min(nearest, at->t);
  }
  EXPECT_GT(nearest, options.clearance_mm - 0.02);
  EXPECT_LT(nearest, options.clearance_mm + 0.6);
  // Over the top of the object, straight up.
  const auto roof = walls.first_hit({-12, 0, 40.01}, Vec3::UnitZ(), 0, 50);
  ASSERT_TRUE(roof.has_value());
  EXPECT_NEAR(roof->t, options.clearance_mm, 0.05);
}

TEST(Jig, EndsTheDipAtTheJobsDepth) {
  const TriangleMesh object = hook(40);
  const Surface surface(object.positions, object.triangles);
  const Jig jig = make_jig(job_of(15), object, surface, {});
  TriangleMesh bar = jig.parts[1].mesh, mount = jig.parts[0].mesh;
  for (Vec3& p : bar.positions) p = jig.parts[1].in_use * p;
  for (Vec3& p : mount.positions) p = jig.parts[0].in_use * p;
  // At full depth the water stands at z = 15, where the frame's underside lies.
  for (std::size_t k = 2; k < jig.parts.size(); ++k)
    EXPECT_NEAR((jig.parts[k].in_use * jig.parts[k].mesh.bounds().min).z(), 15, 1e-9);
  // The bar rests on the mount.
  EXPECT_NEAR(bar.bounds().max.z() - 12, mount.bounds().max.z(), 1e-9);
}

TEST(Jig, IsRefusedWhereNothingHoldsOrNoRoomIs) {
  const TriangleMesh object = hook(40);
  const Surface surface(object.positions, object.triangles);
  EXPECT_THROW(make_jig(job_of(40), object, surface, {}), InputError);
  EXPECT_THROW(make_jig(job_of(33), object, surface, {}), InputError);
  RigJob narrow = job_of(12);
  narrow.config.bath.height_mm = 215;
  EXPECT_THROW(make_jig(narrow, object, surface, {}), InputError);
  EXPECT_THROW(make_jig(job_of(12), object, surface, {Vec3(100, 100, 100), 0.3}), InputError);
}

TEST(Jig, SaysInWhichOtherTurnsTheObjectFits) {
  BoxSolid block;
  block.add({-10, -10, 0}, {10, 10, 40});
  const TriangleMesh square = block.mesh();
  const Jig jig = make_jig(job_of(12), square, Surface(square.positions, square.triangles), {});
  EXPECT_EQ(jig.also_fits_deg, (std::vector<double>{90, 180, 270}));
}

}  // namespace
}  // namespace hydrodip
