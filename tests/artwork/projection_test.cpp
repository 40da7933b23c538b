// Where pushed pictures lie, against closed forms. Placement is asked in mm, so that no pixel's
// size hides an error; the promise is 0.02 mm.
#include <gtest/gtest.h>

#include "artwork/projector.h"
#include "base/error.h"
#include "shapes.h"

namespace hydrodip {
namespace {

constexpr double kExact_mm = 1e-6;

ArtworkLayer layer_of(Projection projection, double width_mm = 20) {
  ArtworkLayer layer;
  layer.image = "test.png";
  layer.projection = projection;
  layer.width_mm = width_mm;
  return layer;
}

Placed place(const ArtworkLayer& layer, const PosedObject& object, double aspect = 1,
             bool closed = true) {
  return place_pushed({layer, aspect, object, closed});
}

TEST(Planar, IsSeenUprightAndUnmirroredAlongItsWay) {
  const PosedObject object = posed(box({0, 0, 0}, {60, 40, 30}));
  ArtworkLayer layer = layer_of(Projection::kPlanar);
  layer.at_mm = Vec3(25, 15, 30);
  layer.toward = Vec3(0, 0, -1);
  layer.up = Vec3(0, 1, 0);
  const Placed placed = place(layer, object);
  int seen = 0;
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    Spot spot;
    const Vec3 p = position_at(object.mesh(), point) - moved(object, Vec3::Zero());
    const bool on_top = std::abs(p.z() - 30) < 1e-9;
    const bool lit = placed.placement->find(point, spot) && placed.placement->is_lit(point);
    if (!on_top) {
      EXPECT_FALSE(lit) << p.transpose();
      return;
    }
    if (!lit) return;
    ++seen;
    // Looking down with +y up, +x is to the right.
    EXPECT_NEAR(spot.place_mm.x(), p.x() - 25, kExact_mm);
    EXPECT_NEAR(spot.place_mm.y(), p.y() - 15, kExact_mm);
  });
  EXPECT_GT(seen, 5);
}

TEST(Planar, OnATiltedPlaneIsTheFootOfTheRay) {
  // z = x / 2 + y / 3 over a square, a sheet that is seen from above.
  const auto at = [](double s, double t) { return Vec3(40 * s, 40 * t, 20 * s + 40 * t / 3); };
  const PosedObject object = posed(sheet(7, 5, at));
  ArtworkLayer layer = layer_of(Projection::kPlanar, 30);
  layer.at_mm = Vec3(20, 20, 100);  // along its way a place means the same
  layer.toward = Vec3(1, 0, -2);
  layer.turn_deg = 0;
  const Placed placed = place(layer, object, 1, false);
  const Vec3 way = Vec3(1, 0, -2).normalized();
  const Vec3 up = (Vec3(0, 0, 1) - way.z() * way).normalized();
  const Vec3 right = way.cross(up);
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    Spot spot;
    if (!placed.placement->find(point, spot)) return;
    const Vec3 p = position_at(object.mesh(), point) - moved(object, Vec3::Zero());
    EXPECT_NEAR(spot.place_mm.x(), (p - Vec3(20, 20, 100)).dot(right), kExact_mm);
    EXPECT_NEAR(spot.place_mm.y(), (p - Vec3(20, 20, 100)).dot(up), kExact_mm);
  });
}

TEST(Planar, IsTheSameInAnyPose) {
  const TriangleMesh mesh = box({-10, -20, 5}, {30, 20, 25});
  ArtworkLayer layer = layer_of(Projection::kPlanar);
  layer.at_mm = Vec3(10, 0, 25);
  layer.toward = Vec3(0, 0, -1);
  const PosedObject plain = posed(mesh);
  PoseOptions turned;
  turned.down = ModelSide::kPlusX;
  turned.rotate_deg = Vec3(10, 20, 70);
  const PosedObject other = posed(mesh, turned);
  const Placed a = place(layer, plain), b = place(layer, other);
  each_point(mesh, [&](const SurfacePoint& point) {
    Spot one, two;
    const bool lit = a.placement->find(point, one) && a.placement->is_lit(point);
    ASSERT_EQ(lit, b.placement->find(point, two) && b.placement->is_lit(point));
    if (lit) {
      EXPECT_LT((one.place_mm - two.place_mm).norm(), kExact_mm);
    }
  });
}

TEST(Planar, ByDefaultComesFromBelowAndFillsTheModel) {
  const PosedObject object = posed(box({0, 0, 0}, {60, 40, 30}));
  ArtworkLayer layer = layer_of(Projection::kPlanar, 0);
  const Placed placed = place(layer, object, 2.0);
  EXPECT_NEAR(placed.size_mm.x(), 60, 1e-9);  // twice as wide as high: the width decides
  EXPECT_NEAR(placed.size_mm.y(), 30, 1e-9);
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    Spot spot;
    const bool lit = placed.placement->find(point, spot) && placed.placement->is_lit(point);
    // Only the picture itself ends before the sides do.
    if (lit) {
      EXPECT_NEAR(position_at(object.mesh(), point).z(), 0, 1e-9);
    }
    // Seen from below with +y up, -x is to the right.
    if (lit) {
      EXPECT_NEAR(spot.place_mm.x(), -position_at(object.mesh(), point).x(), 1e-9);
    }
  });
}

TEST(Planar, AsLargeAsFitsCountsTheTurn) {
  const PosedObject object = posed(box({0, 0, 0}, {60, 40, 30}));
  ArtworkLayer layer = layer_of(Projection::kPlanar, 0);
  layer.turn_deg = 90;
  EXPECT_NEAR(place(layer, object, 2.0).size_mm.x(), 40, 1e-9);  // upright: its width is high
  layer.turn_deg = 45;
  // A square on its corner: its diagonal is as long as the model is wide.
  EXPECT_NEAR(place(layer, object, 1.0).size_mm.x(), 40 / std::sqrt(2.0), 1e-9);
}

TEST(Planar, ByItsPlaceAloneGoesSquareToTheSurface) {
  const PosedObject object = posed(box({0, 0, 0}, {60, 40, 30}));
  ArtworkLayer layer = layer_of(Projection::kPlanar);
  layer.at_mm = Vec3(60.3, 20, 15);  // a ruler's error beside the +x face
  const Placed placed = place(layer, object);
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    Spot spot;
    const Vec3 p = position_at(object.mesh(), point) - moved(object, Vec3::Zero());
    if (!placed.placement->find(point, spot) || !placed.placement->is_lit(point)) return;
    EXPECT_NEAR(p.x(), 60, 1e-9);
    EXPECT_NEAR(spot.place_mm.x(), p.y() - 20, kExact_mm);
    EXPECT_NEAR(spot.place_mm.y(), p.z() - 15, kExact_mm);
  });
}

TEST(Cylinder, OnACylinderIsItsArc) {
  constexpr double kRadius = 20;
  const PosedObject object = posed(tube(kRadius, 50, 720, 10));
  ArtworkLayer layer = layer_of(Projection::kCylinder, 40);
  layer.toward = Vec3(0, 0, 1);
  layer.at_mm = Vec3(0, -kRadius, 30);
  const Placed placed = place(layer, object, 1, false);
  const Vec3 centre = moved(object, Vec3(0, 0, 0));
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    Spot spot;
    if (!placed.placement->find(point, spot) || !placed.placement->is_lit(point)) return;
    const Vec3 p = position_at(object.mesh(), point) - centre;
    // Seen from -y with z up, +x is to the right. 0.02 mm: the mesh has corners, the form has not.
    EXPECT_NEAR(spot.place_mm.x(), kRadius * std::atan2(p.x(), -p.y()), 0.002);
    EXPECT_NEAR(spot.place_mm.y(), p.z() - 30, kExact_mm);
  });
}

TEST(Cylinder, AsLargeAsFitsGoesHalfWayAround) {
  constexpr double kRadius = 20;
  const PosedObject object = posed(tube(kRadius, 200, 720, 10));
  ArtworkLayer layer = layer_of(Projection::kCylinder, 0);
  layer.at_mm = Vec3(0, -kRadius, 100);
  EXPECT_NEAR(place(layer, object, 1, false).size_mm.x(), kPi * kRadius, 0.01);
  EXPECT_NEAR(place(layer, object, 1, false).size_mm.y(), kPi * kRadius, 0.01);
}

// An axis has no direction: written the other way round it is the same one, and up is the model's
// z.
TEST(Cylinder, StandsUprightWhicheverWayItsAxisIsWritten) {
  const PosedObject object = posed(tube(20, 50, 180, 10));
  ArtworkLayer layer = layer_of(Projection::kCylinder, 30);
  layer.at_mm = Vec3(0, -20, 25);
  for (const double sign : {1.0, -1.0}) {
    layer.toward = Vec3(0, 0, sign);
    layer.up.reset();
    const Placed open = place(layer, object, 1, false);
    layer.up = Vec3(0, 0, -1);
    const Placed turned = place(layer, object, 1, false);
    each_point(object.mesh(), [&](const SurfacePoint& point) {
      const Vec3 p = position_at(object.mesh(), point) - moved(object, Vec3::Zero());
      Spot spot;
      if (!open.placement->find(point, spot)) return;
      EXPECT_NEAR(spot.place_mm.y(), p.z() - 25, kExact_mm);
      ASSERT_TRUE(turned.placement->find(point, spot));
      EXPECT_NEAR(spot.place_mm.y(), 25 - p.z(), kExact_mm);
    });
  }
}

TEST(Cylinder, FindsTheAxisOfACupWithAHandle) {
  TriangleMesh cup = tube(35, 90, 256, 8);
  for (Vec3& p : cup.positions) p += Vec3(5, -3, 0);
  append(cup, box({38, -8, 20}, {70, 4, 70}));  // a clumsy handle
  const PosedObject object = posed(cup);
  ArtworkLayer layer = layer_of(Projection::kCylinder, 60);
  layer.toward = Vec3(0, 0, 1);
  layer.at_mm = Vec3(5, -38, 45);
  const Placed placed = place(layer, object, 2, false);
  const Vec3 centre = moved(object, Vec3(5, -3, 0));
  int seen = 0;
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    Spot spot;
    const Vec3 p = position_at(object.mesh(), point) - centre;
    if (p.x() > 30 || !placed.placement->find(point, spot)) return;
    if (std::abs(spot.place_mm.x()) > 30) return;
    ++seen;
    EXPECT_NEAR(spot.place_mm.x(), 35 * std::atan2(p.x(), -p.y()), 0.3);
  });
  EXPECT_GT(seen, 100);
}

TEST(Sphere, OnASphereIsLongitudeAndLatitude) {
  constexpr double kRadius = 30;
  const PosedObject object = posed(ball(kRadius, 720, 360));
  ArtworkLayer layer = layer_of(Projection::kSphere, 60);
  layer.toward = Vec3(0, 0, 1);
  layer.at_mm = Vec3(0, -kRadius, 0);
  const Placed placed = place(layer, object);
  const Vec3 centre = moved(object, Vec3::Zero());
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    Spot spot;
    if (!placed.placement->find(point, spot) || !placed.placement->is_lit(point)) return;
    const Vec3 p = (position_at(object.mesh(), point) - centre).normalized();
    if (std::abs(p.z()) > 0.99) return;
    EXPECT_NEAR(spot.place_mm.x(), kRadius * std::atan2(p.x(), -p.y()), 0.01);
    EXPECT_NEAR(spot.place_mm.y(), kRadius * std::asin(p.z()), 0.01);
  });
}

// At a height the picture is as wide as it is there.
TEST(Sphere, NearAPoleAPictureIsAsWideAsAtTheEquator) {
  constexpr double kRadius = 30, kLatitude = kPi / 3;
  const PosedObject object = posed(ball(kRadius, 720, 360));
  ArtworkLayer layer = layer_of(Projection::kSphere, 10);
  layer.toward = Vec3(0, 0, 1);
  layer.at_mm = Vec3(0, -kRadius * std::cos(kLatitude), kRadius * std::sin(kLatitude));
  const Placed placed = place(layer, object);
  const Vec3 centre = moved(object, Vec3::Zero());
  int seen = 0;
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    Spot spot;
    if (!placed.placement->find(point, spot) || !placed.placement->is_lit(point)) return;
    const Vec3 p = (position_at(object.mesh(), point) - centre).normalized();
    if (p.z() < 0.7 || p.z() > 0.95) return;
    ++seen;
    EXPECT_NEAR(spot.place_mm.x(), kRadius * std::cos(kLatitude) * std::atan2(p.x(), -p.y()), 0.02);
    EXPECT_NEAR(spot.place_mm.y(), kRadius * (std::asin(p.z()) - kLatitude), 0.02);
  });
  EXPECT_GT(seen, 100);
}

TEST(Cylinder, OfWhatLiesTheAxisLies) {
  TriangleMesh lying = tube(20, 50, 180, 10);
  for (Vec3& p : lying.positions) p = Vec3(p.z(), p.x(), p.y());
  const PosedObject object = posed(lying);
  ArtworkLayer layer = layer_of(Projection::kCylinder, 30);
  layer.at_mm = Vec3(25, -20, 0);
  const Placed placed = place(layer, object, 1, false);
  int seen = 0;
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    Spot spot;
    if (!placed.placement->find(point, spot) || !placed.placement->is_lit(point)) return;
    ++seen;
    EXPECT_NEAR(spot.place_mm.y(),
                (position_at(object.mesh(), point) - moved(object, Vec3::Zero())).x() - 25,
                kExact_mm);
  });
  EXPECT_GT(seen, 100);
}

TEST(Planar, BesideTheMiddleAPictureFitsToTheNearerEdge) {
  const PosedObject object = posed(box({0, 0, 0}, {60, 40, 30}));
  ArtworkLayer layer = layer_of(Projection::kPlanar, 0);
  layer.toward = Vec3(0, 0, 1);
  layer.up = Vec3(0, 1, 0);
  layer.at_mm = Vec3(15, 20, 0);
  EXPECT_NEAR(place(layer, object, 1).size_mm.x(), 30, 1e-9);
  layer.at_mm = Vec3(30, 32, 0);
  EXPECT_NEAR(place(layer, object, 1).size_mm.y(), 16, 1e-9);
}

TEST(Box, PutsThePictureOnEverySideUnmirrored) {
  const PosedObject object = posed(box({-20, -20, -20}, {20, 20, 20}));
  ArtworkLayer layer = layer_of(Projection::kBox, 0);
  layer.toward = Vec3(0, 1, 0);
  const Placed placed = place(layer, object);
  EXPECT_NEAR(placed.size_mm.x(), 40, 1e-9);
  const Vec3 centre = moved(object, Vec3::Zero());
  std::array<int, 6> sides{};
  each_point(object.mesh(), [&](const SurfacePoint& point) {
    Spot spot;
    ASSERT_TRUE(placed.placement->find(point, spot));
    ASSERT_TRUE(placed.placement->is_lit(point));
    const Vec3 p = position_at(object.mesh(), point) - centre;
    const Vec3 n = face_normal(object.mesh(), point.triangle);
    // The picture's plane is the face: going right and up along it, one goes round the normal.
    const Vec3 up = std::abs(n.z()) > 0.5 ? Vec3(0, n.z(), 0) : Vec3(0, 0, 1);
    const Vec3 right = (-n).cross(up);
    EXPECT_NEAR(spot.place_mm.x(), p.dot(right), kExact_mm);
    EXPECT_NEAR(spot.place_mm.y(), p.dot(up), kExact_mm);
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(n[Eigen::Index(k)]) > 0.5) ++sides[2 * k + (n[Eigen::Index(k)] > 0 ? 1 : 0)];
  });
  for (const int count : sides) EXPECT_GT(count, 0);
}

TEST(Box, StandsUprightOnEverySideHoweverTheObjectIsHeld) {
  for (const Vec3& rotate : {Vec3(0, 0, 0), Vec3(90, 0, 0), Vec3(20, -130, 70)}) {
    PoseOptions pose;
    pose.rotate_deg = rotate;
    const PosedObject object = posed(box({-20, -20, -20}, {20, 20, 20}), pose);
    const Placed placed = place(layer_of(Projection::kBox), object);
    const ModelFrame frame(object);
    int upright = 0;
    each_point(object.mesh(), [&](const SurfacePoint& point) {
      Spot spot;
      ASSERT_TRUE(placed.placement->find(point, spot));
      const Vec3 p = frame.back(position_at(object.mesh(), point));
      const Vec3 n = frame.direction_back(face_normal(object.mesh(), point.triangle));
      if (std::abs(n.z()) > 0.5) return;  // top and bottom
      ++upright;
      EXPECT_NEAR(spot.place_mm.y(), p.z(), kExact_mm);
      EXPECT_NEAR(spot.place_mm.x(), p.dot(Vec3::UnitZ().cross(n)), kExact_mm);
    });
    EXPECT_GT(upright, 20);
  }
}

TEST(Box, StandsByTheUpThatIsTold) {
  const PosedObject object = posed(box({-20, -20, -20}, {20, 20, 20}));
  for (const Vec3& up : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, -2, 0)}) {
    ArtworkLayer layer = layer_of(Projection::kBox);
    layer.up = up;
    const Placed placed = place(layer, object);
    const Vec3 centre = moved(object, Vec3::Zero());
    each_point(object.mesh(), [&](const SurfacePoint& point) {
      Spot spot;
      const Vec3 n = face_normal(object.mesh(), point.triangle);
      if (std::abs(n.dot(up.normalized())) > 0.5) return;
      ASSERT_TRUE(placed.placement->find(point, spot));
      const Vec3 p = position_at(object.mesh(), point) - centre;
      EXPECT_NEAR(spot.place_mm.y(), p.dot(up.normalized()), kExact_mm);
    });
  }
}

// A layer that says nothing of its place goes by how the object is held. As it was laid, it does
// not any more.
TEST(Placing, IsTheSameInAnyPoseOnceItIsLaid) {
  TriangleMesh lumpy = ball(30, 48, 24);
  for (Vec3& p : lumpy.positions) p = Vec3(1.3 * p.x() + 4, p.y() - 7, 0.8 * p.z() + 0.1 * p.x());
  PoseOptions first, second;
  first.rotate_deg = Vec3(40, 0, 15);
  second.down = ModelSide::kPlusX;
  second.rotate_deg = Vec3(-10, 65, 0);
  const PosedObject before = posed(lumpy, first), after = posed(lumpy, second);
  for (const Projection projection : {Projection::kPlanar, Projection::kCylinder,
                                      Projection::kSphere, Projection::kBox, Projection::kWrap}) {
    SCOPED_TRACE(int(projection));
    const ArtworkLayer open = layer_of(projection, 0);
    const auto laid_on = [&](const ArtworkLayer& layer, const PosedObject& object) {
      WrapReport unread;
      return projection == Projection::kWrap ? place_wrapped({layer, 1.5, object, true}, unread)
                                             : place(layer, object, 1.5);
    };
    const Placed wanted = laid_on(open, before), kept = laid_on(wanted.layer, after);
    EXPECT_NEAR((wanted.size_mm - kept.size_mm).norm(), 0, 2e-3);
    int seen = 0;
    each_point(before.mesh(), [&](const SurfacePoint& point) {
      Spot there, here;
      const bool is_there = wanted.placement->find(point, there);
      if (!is_there || there.place_mm.cwiseAbs().maxCoeff() > 15) return;
      if (!wanted.placement->is_lit(point)) return;
      ++seen;
      ASSERT_TRUE(kept.placement->find(point, here));
      EXPECT_TRUE(kept.placement->is_lit(point));
      EXPECT_NEAR((here.place_mm - there.place_mm).norm(), 0, 2e-3);
    });
    EXPECT_GT(seen, 100);
  }
}

TEST(Placing, RefusesWhatIsFarFromTheModelAndSaysWhereItIs) {
  const PosedObject object = posed(box({0, 0, 0}, {60, 40, 30}));
  ArtworkLayer layer = layer_of(Projection::kPlanar);
  layer.at_mm = Vec3(100, 20, 15);
  try {
    place(layer, object);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("60.0,20.0,15.0"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("40.0 mm"), std::string::npos) << error.what();
  }
}

TEST(Placing, RefusesDirectionsThatSayNothing) {
  const PosedObject object = posed(box({0, 0, 0}, {60, 40, 30}));
  ArtworkLayer layer = layer_of(Projection::kPlanar);
  layer.toward = Vec3(0, 0, 0);
  EXPECT_THROW(place(layer, object), InputError);
  layer.toward = Vec3(0, 0, -1);
  layer.up = Vec3(0, 0, 2);
  EXPECT_THROW(place(layer, object), InputError);
}

}  // namespace
}  // namespace hydrodip
