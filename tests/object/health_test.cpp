#include "object/health.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/error.h"
#include "base/run_scope.h"
#include "object/polygon.h"

namespace hydrodip {
namespace {

// A box as a soup: no two triangles share a vertex index, as in STL.
void add_box(Object& object, const Vec3& center, double side, bool inward = false) {
  static constexpr int kFaces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                        {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                        {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& face : kFaces) {
    Triangle triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      const int corner = face[inward && c > 0 ? 3 - c : c];
      triangle[c] = std::int32_t(object.positions.size());
      object.positions.push_back(
          center + side * Vec3((corner & 1) - 0.5, (corner >> 1 & 1) - 0.5, (corner >> 2) - 0.5));
    }
    object.triangles.push_back(triangle);
    object.material_of.push_back(0);
  }
  if (object.materials.empty()) object.materials.emplace_back();
}

Object box() {
  Object object;
  add_box(object, Vec3::Zero(), 2);
  return object;
}

TEST(Health, CleanBox) {
  Object object = box();
  const MeshHealth health = check_and_repair(object);
  EXPECT_EQ(health.vertices, 8);
  EXPECT_EQ(health.triangles, 12);
  EXPECT_EQ(health.shells, 1);
  EXPECT_TRUE(health.closed());
  EXPECT_NEAR(health.volume_mm3, 8, 1e-12);
  EXPECT_NEAR(health.area_mm2, 24, 1e-12);
  EXPECT_TRUE(health.findings().empty());
}

TEST(Health, RepairsAnyMixtureOfOrientations) {
  std::mt19937 random(9);
  for (int round = 0; round < 20; ++round) {
    Object object = box();
    object.uvs.resize(12);
    for (std::size_t f = 0; f < 12; ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        // The attribute names its corner.
        object.uvs[f][c] =
            object.positions[std::size_t(object.triangles[f][c])].head<2>().cast<float>();
      }
    }
    long turned = 0;
    for (std::size_t f = 0; f < 12; ++f) {
      if (random() % 2 == 0) continue;
      std::swap(object.triangles[f][1], object.triangles[f][2]);
      std::swap(object.uvs[f][1], object.uvs[f][2]);
      ++turned;
    }
    const MeshHealth health = check_and_repair(object);
    EXPECT_EQ(health.flipped, turned);
    EXPECT_NEAR(health.volume_mm3, 8, 1e-12);
    for (std::size_t f = 0; f < 12; ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3& p = object.positions[std::size_t(object.triangles[f][c])];
        EXPECT_EQ(object.uvs[f][c], p.head<2>().cast<float>());
      }
    }
  }
}

TEST(Health, NestedShellsAlternate) {
  // Solid, cavity, island, whatever the file says.
  for (const bool inward : {false, true}) {
    Object object;
    add_box(object, Vec3(0.1, 0, 0), 1, inward);
    add_box(object, Vec3::Zero(), 4, inward);
    add_box(object, Vec3::Zero(), 2, !inward);
    add_box(object, Vec3(10, 0, 0), 1, inward);
    const MeshHealth health = check_and_repair(object);
    EXPECT_EQ(health.shells, 4);
    EXPECT_NEAR(health.volume_mm3, 64 - 8 + 1 + 1, 1e-9);
    EXPECT_TRUE(health.closed());
  }
}

TEST(Health, HolesAreCountedAndTheMajorityKept) {
  Object object = box();
  object.triangles.erase(object.triangles.begin() + 11);
  object.triangles.erase(object.triangles.begin() + 0);
  object.material_of.resize(10);
  std::swap(object.triangles[3][1], object.triangles[3][2]);
  const MeshHealth health = check_and_repair(object);
  EXPECT_EQ(health.boundary_edges, 6);
  EXPECT_EQ(health.holes, 2);
  EXPECT_EQ(health.flipped, 1);
  EXPECT_FALSE(health.closed());
  EXPECT_EQ(health.findings().size(), 2u);

  // An open shell that faces inward keeps doing so: the file may mean it.
  Object inward;
  add_box(inward, Vec3::Zero(), 2, true);
  inward.triangles.pop_back();
  inward.material_of.pop_back();
  EXPECT_EQ(check_and_repair(inward).flipped, 0);
}

TEST(Health, DropsDegenerateAndDuplicateFaces) {
  Object object = box();
  const auto add = [&](const Triangle& triangle) {
    object.triangles.push_back(triangle);
    object.material_of.push_back(0);
  };
  add({0, 0, 1});                                                                 // repeated vertex
  add({object.triangles[4][2], object.triangles[4][0], object.triangles[4][1]});  // rotated
  add({object.triangles[5][1], object.triangles[5][0], object.triangles[5][2]});  // reversed
  const MeshHealth health = check_and_repair(object);
  EXPECT_EQ(health.degenerate_removed, 1);
  EXPECT_EQ(health.duplicates_removed, 2);
  EXPECT_EQ(health.triangles, 12);
  EXPECT_EQ(object.material_of.size(), 12u);
  EXPECT_TRUE(health.closed());
}

// As programs write walls with two sides: each face twice, back to back, in two materials. Which
// one comes first must not matter.
TEST(Health, OfFacesBackToBackTheOuterOneIsSeen) {
  for (const bool back_first : {false, true}) {
    Object object = box();
    object.materials.resize(2);
    object.colors.assign(object.triangles.size(), {});
    const std::size_t count = object.triangles.size();
    for (std::size_t f = 0; f < count; ++f) {
      object.colors[f] = {LinearColor{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
      const Triangle& t = object.triangles[f];
      object.triangles.push_back({t[1], t[0], t[2]});
      object.material_of.push_back(1);
      object.colors.push_back({LinearColor{0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}});
    }
    const Object outer = box();
    if (back_first)
      for (std::size_t f = 0; f < count; ++f) {
        std::swap(object.triangles[f], object.triangles[count + f]);
        std::swap(object.material_of[f], object.material_of[count + f]);
        std::swap(object.colors[f], object.colors[count + f]);
      }
    EXPECT_EQ(check_and_repair(object).duplicates_removed, long(count));
    ASSERT_EQ(object.triangles.size(), count);
    for (std::size_t f = 0; f < count; ++f) {
      EXPECT_EQ(object.material_of[f], 0);
      // Each corner has kept its own colour.
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& at = object.positions[std::size_t(object.triangles[f][k])];
        for (std::size_t j = 0; j < 3; ++j)
          if (outer.positions[std::size_t(outer.triangles[f][j])] == at) {
            EXPECT_EQ(object.colors[f][k].r, j == 0 ? 1 : 0);
            EXPECT_EQ(object.colors[f][k].g, j == 1 ? 1 : 0);
          }
      }
    }
  }
}

// The sine of a whole turn is not 0, and the last digit that a file writes is not the same twice.
// What is farther apart is a hole.
TEST(Health, RoundingPartsNoSeam) {
  for (const double gap : {1e-14, 3e-7, 1e-4}) {
    Object object = box();  // each triangle has corners of its own
    for (std::size_t f = 0; f < object.triangles.size(); f += 2)
      for (const std::int32_t v : object.triangles[f])
        for (int k = 0; k < 3; ++k) object.positions[std::size_t(v)][k] += gap * (k - 1);
    const MeshHealth health = check_and_repair(object);
    EXPECT_EQ(health.closed(), gap < 1e-5) << gap;
    if (gap < 1e-5) {
      EXPECT_EQ(health.vertices, 8);
      EXPECT_EQ(health.triangles, 12);
      EXPECT_NEAR(health.volume_mm3, 8, 1e-5);
    }
  }
}

// Single precision knows places far from the origin less well, and makes no gap a seam that is much
// wider than the object's own.
TEST(Health, AGapFarFromTheOriginStaysOne) {
  for (const double far : {0.0, 1e6}) {
    Object object = box();
    for (std::size_t f = 0; f < object.triangles.size(); f += 2)
      for (const std::int32_t v : object.triangles[f])
        object.positions[std::size_t(v)] += Vec3(-1e-3, 0, 1e-3);
    for (Vec3& p : object.positions) p.x() += far;
    EXPECT_FALSE(check_and_repair(object).closed()) << far;
  }
}

TEST(Health, ASliverWithoutAreaStillJoinsItsNeighbours) {
  // A tetrahedron with a vertex on the middle of one edge of one face only; the sliver closes it.
  Object object;
  object.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0}};
  object.triangles = {{0, 2, 4}, {4, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 4, 1}};
  object.material_of.assign(6, 0);
  object.materials.emplace_back();
  std::swap(object.triangles[2][1], object.triangles[2][2]);
  const MeshHealth health = check_and_repair(object);
  EXPECT_EQ(health.degenerate_removed, 1);
  EXPECT_EQ(health.boundary_edges, 0);
  EXPECT_EQ(health.flipped, 1);
  EXPECT_NEAR(health.volume_mm3, 8.0 / 6, 1e-12);
}

TEST(Health, BoxesThatShareAnEdge) {
  Object object;
  add_box(object, Vec3(0, 0, 0), 2, true);
  add_box(object, Vec3(2, 2, 0), 2);
  const MeshHealth health = check_and_repair(object);
  EXPECT_EQ(health.nonmanifold_edges, 1);
  EXPECT_EQ(health.shells, 1);
  EXPECT_NEAR(health.volume_mm3, 16, 1e-12);  // each was turned outward by itself
}

// One of its sides is missing.
Object tray(const Vec3& size, bool inward) {
  Object object;
  add_box(object, Vec3::Zero(), 1, inward);
  object.triangles.erase(object.triangles.begin() + 2, object.triangles.begin() + 4);
  object.material_of.pop_back();
  object.material_of.pop_back();
  for (Vec3& p : object.positions) p = p.cwiseProduct(size) + Vec3(300, -200, 100);
  return object;
}

TEST(Health, AnOpenShellThatLooksInwardsIsInsideOut) {
  for (const Vec3& size : {Vec3(1, 1, 1), Vec3(75, 151, 10), Vec3(10, 10, 90)}) {
    Object object = tray(size, true);
    const MeshHealth health = check_and_repair(object);
    EXPECT_TRUE(health.inside_out) << size;
    const std::vector<std::string> findings = health.findings();
    EXPECT_TRUE(std::any_of(findings.begin(), findings.end(), [](const std::string& finding) {
      return finding.find(kLooksInwards) != std::string::npos &&
             finding.find(kTurnNormals) != std::string::npos;
    }));
    object = tray(size, false);
    EXPECT_FALSE(check_and_repair(object).inside_out) << size;
  }
  Object closed;
  add_box(closed, Vec3::Zero(), 2, true);
  EXPECT_FALSE(check_and_repair(closed).inside_out);  // it is turned outward
}

// A relief has no inside, whichever of its sides is meant.
TEST(Health, ASheetIsNotInsideOut) {
  for (const double height : {0.0, 2.0, -2.0})
    for (const bool down : {false, true}) {
      Object object;
      constexpr int kCells = 12;
      for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i)
          object.positions.emplace_back(
              5 * i, 5 * j, height * std::sin(M_PI * i / kCells) * std::sin(M_PI * j / kCells));
      for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i) {
          const int a = j * (kCells + 1) + i, b = a + 1, c = a + kCells + 1, d = c + 1;
          object.triangles.push_back(down ? Triangle{a, d, b} : Triangle{a, b, d});
          object.triangles.push_back(down ? Triangle{a, c, d} : Triangle{a, d, c});
        }
      object.material_of.assign(object.triangles.size(), 0);
      object.materials.emplace_back();
      EXPECT_FALSE(check_and_repair(object).inside_out) << height << " " << down;
    }
}

TEST(Health, MoebiusStripIsReported) {
  Object object;
  constexpr int kSegments = 12;
  for (int i = 0; i < kSegments; ++i) {
    const double angle = 2 * M_PI * i / kSegments, half = angle / 2;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    const Vec3 across = 0.3 * (std::cos(half) * out + std::sin(half) * Vec3(0, 0, 1));
    object.positions.push_back(out + across);
    object.positions.push_back(out - across);
  }
  for (int i = 0; i < kSegments; ++i) {
    const int a = 2 * i, b = a + 1;
    const bool last = i == kSegments - 1;
    const int c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    object.triangles.push_back({a, b, c});
    object.triangles.push_back({b, d, c});
  }
  object.material_of.assign(object.triangles.size(), 0);
  object.materials.emplace_back();
  const MeshHealth health = check_and_repair(object);
  EXPECT_EQ(health.one_sided_edges, 1);
  EXPECT_EQ(health.holes, 1);
}

TEST(Health, ManyShellsInsideALargeOne) {
  Object object;
  add_box(object, Vec3::Zero(), 100);
  for (int i = 0; i < 1000; ++i) {
    add_box(object, Vec3(i % 10, i / 10 % 10, i / 100) * 4 - Vec3::Constant(18), 1);
  }
  const MeshHealth health = check_and_repair(object);
  EXPECT_EQ(health.shells, 1001);
  EXPECT_NEAR(health.volume_mm3, 1e6 - 1000, 1e-6);
}

double signed_area(const std::vector<Vec3>& corners, const std::array<int, 3>& t) {
  const Vec3& a = corners[std::size_t(t[0])];
  return 0.5 * cross2((corners[std::size_t(t[1])] - a).head<2>(),
                      (corners[std::size_t(t[2])] - a).head<2>());
}

TEST(Triangulate, ConcavePolygonsExactly) {
  // A comb with teeth: many reflex corners. Area: handle 9 x 1, five teeth 1 x 3.
  std::vector<Vec3> comb = {{0, 0, 0}, {9, 0, 0}};
  for (int x = 9; x > 0; --x) {
    comb.push_back(Vec3(x, x % 2 == 1 ? 4 : 1, 0));
    comb.push_back(Vec3(x - 1, x % 2 == 1 ? 4 : 1, 0));
  }
  const auto triangles = triangulate(comb);
  ASSERT_EQ(triangles.size(), comb.size() - 2);
  double area = 0;
  for (const auto& t : triangles) {
    EXPECT_GE(signed_area(comb, t), 0);
    area += signed_area(comb, t);
  }
  EXPECT_NEAR(area, 9 + 15, 1e-12);
  // The same seen from behind.
  std::reverse(comb.begin(), comb.end());
  area = 0;
  for (const auto& t : triangulate(comb)) area += signed_area(comb, t);
  EXPECT_NEAR(area, -24, 1e-12);
}

// A face with a dent is cut without overlaps whichever way it looks.
TEST(Triangulate, FacesThatLookAnyWay) {
  const std::vector<Vec3> arrow = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {3, 1, 0}};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool reversed : {false, true}) {
      std::vector<Vec3> corners;
      for (const Vec3& p : arrow) {
        Vec3 turned = Vec3::Zero();
        turned[(axis + 1) % 3] = p.x();
        turned[(axis + 2) % 3] = p.y();
        corners.push_back(turned);
      }
      if (reversed) std::reverse(corners.begin(), corners.end());
      double area = 0;
      for (const auto& t : triangulate(corners))
        area += 0.5 * (corners[std::size_t(t[1])] - corners[std::size_t(t[0])])
                          .cross(corners[std::size_t(t[2])] - corners[std::size_t(t[0])])
                          .norm();
      EXPECT_NEAR(area, 4, 1e-12) << axis << reversed;
    }
}

TEST(Triangulate, DegeneratePolygonsEnd) {
  EXPECT_EQ(triangulate({}).size(), 0u);
  EXPECT_EQ(triangulate(std::vector<Vec3>(5, Vec3::Zero())).size(), 3u);
  EXPECT_EQ(triangulate({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u);
}

// A circle, a star and a zigzag of many corners: exact areas, in time that allows a test.
TEST(Triangulate, ManyCorners) {
  constexpr int kCorners = 100000;
  for (const double inner : {1.0, 0.5}) {
    std::vector<Vec3> star;
    double exact = 0;
    for (int i = 0; i < kCorners; ++i) {
      const double radius = i % 2 == 0 ? 1 : inner, angle = 2 * M_PI * i / kCorners;
      star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    for (std::size_t i = 0; i < star.size(); ++i)
      exact += 0.5 * cross2(star[i].head<2>(), star[(i + 1) % star.size()].head<2>());
    const auto triangles = triangulate(star);
    ASSERT_EQ(triangles.size(), star.size() - 2);
    double area = 0;
    for (const auto& t : triangles) area += std::abs(signed_area(star, t));
    EXPECT_NEAR(area, exact, 1e-9);
  }
}

TEST(Triangulate, PolygonsThatCrossThemselvesEnd) {
  std::mt19937 random(3);
  std::vector<Vec3> tangle;
  for (int i = 0; i < 20000; ++i)
    tangle.emplace_back(double(random() % 1000), double(random() % 1000), 0);
  EXPECT_EQ(triangulate(tangle).size(), tangle.size() - 2);
  const std::vector<Vec3> same(20000, Vec3(1, 2, 3));
  EXPECT_EQ(triangulate(same).size(), same.size() - 2);
}

TEST(Triangulate, CanBeCancelled) {
  RunContext context;
  context.cancel();
  std::vector<Vec3> tangle;
  for (int i = 0; i < 20000; ++i) tangle.emplace_back(i % 7, i % 11, 0);
  const RunScope scope(context);
  EXPECT_THROW(triangulate(tangle), Cancelled);
}

// A tetrahedron of edge about 60, one face of which is open at a small triangle in its middle.
Object pierced(double hole) {
  Object object;
  object.positions = {{0, 0, 0}, {60, 0, 0}, {0, 60, 0}, {0, 0, 60}};
  const Vec3 middle(20, 20, 0);
  for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(60, 0, 0), Vec3(0, 60, 0)})
    object.positions.push_back(middle + hole / 60 * (corner - middle));
  object.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    object.triangles.push_back({next, i, 4 + i});
    object.triangles.push_back({next, 4 + i, 4 + next});
  }
  object.material_of.assign(object.triangles.size(), 0);
  object.uvs.resize(object.triangles.size());
  object.materials.emplace_back();
  return object;
}

TEST(Health, PinholesAreClosedAndSaid) {
  Object object = pierced(0.06);
  const MeshHealth health = check_and_repair(object);
  EXPECT_EQ(health.holes_closed, 1);
  EXPECT_TRUE(health.closed());
  EXPECT_NEAR(health.volume_mm3, 60.0 * 60 * 60 / 6, 1e-6);
  EXPECT_EQ(object.uvs.size(), object.triangles.size());
  EXPECT_EQ(object.material_of.size(), object.triangles.size());
  const auto findings = health.findings();
  EXPECT_TRUE(std::any_of(findings.begin(), findings.end(), [](const std::string& finding) {
    return finding.find("Closed 1 hole") != std::string::npos;
  }));
}

TEST(Health, HolesThatAreMeantAndScrapsStayOpen) {
  Object open = pierced(6);
  EXPECT_EQ(check_and_repair(open).holes_closed, 0);
  Object scrap = box();
  scrap.positions.insert(scrap.positions.end(), {{5, 5, 5}, {5.001, 5, 5}, {5, 5.001, 5}});
  const auto first = std::int32_t(scrap.positions.size()) - 3;
  scrap.triangles.push_back({first, first + 1, first + 2});
  scrap.material_of.push_back(0);
  EXPECT_EQ(check_and_repair(scrap).holes_closed, 0);
}

}  // namespace
}  // namespace hydrodip
