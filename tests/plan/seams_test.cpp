#include "plan/seams.h"
#include "exact/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hydrodip {
namespace {

constexpr double kHalf = 20;

// A plate in x, y whose paint has one stripe without ink, or a hollow, or nothing special.
class StripedPaint : public Paint {
 public:
  StripedPaint(const TriangleMesh& mesh, double from, double to)
      : Paint({1, 1, 1, 1}), mesh_(mesh), from_(from), to_(to) {}
  LinearColor color_at(const SurfacePoint& point) const override {
    const double x = position_at(mesh_, point).x();
    return x > from_ && x < to_ ? LinearColor{1, 1, 1, 1} : LinearColor{0.1F, 0.1F, 0.2F, 1};
  }
  bool says_anything() const override { return true; }

 private:
  const TriangleMesh& mesh_;
  double from_, to_;
};

class Plate : public testing::Test {
 protected:
  Plate() {
    mesh_->positions = {
        {-kHalf, -kHalf, 0}, {kHalf, -kHalf, 0}, {kHalf, kHalf, 0}, {-kHalf, kHalf, 0}};
    mesh_->triangles = {{0, 1, 2}, {0, 2, 3}};
  }

  // The plate in smaller triangles.
  static TriangleMesh tiled(int columns, int rows) {
    TriangleMesh mesh;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i)
        mesh.positions.emplace_back(kHalf * (2.0 * i / columns - 1), kHalf * (2.0 * j / rows - 1),
                                    0);
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const int at = j * (columns + 1) + i, above = at + columns + 1;
        mesh.triangles.push_back({at, at + 1, above + 1});
        mesh.triangles.push_back({at, above + 1, above});
      }
    return mesh;
  }

  // The first dip reaches up to x = 10, the second down to x = -10.
  SharedSurface divide(const Paint& paint, double overlap_mm) {
    const auto nodes = std::make_shared<const SurfaceNodes>(spread_targets(*mesh_, 6000));
    std::vector<std::vector<float>> worth(2);
    for (const Target& node : nodes->nodes()) {
      worth[0].push_back(node.position.x() < 10 ? 1.0F : 0.0F);
      worth[1].push_back(node.position.x() > -10 ? 1.0F : 0.0F);
    }
    const Surface surface(mesh_->positions, mesh_->triangles);
    RunContext context;
    return {{nodes, worth, paint, surface, 1, overlap_mm}, context};
  }

  std::vector<float> at(const SharedSurface& shared, double x, double y) {
    return shared.shares_at({x, y, 0}, Vec3::UnitZ());
  }

  // Where the first dip's part falls to a half.
  double seam_at(const SharedSurface& shared, double y) {
    double low = -kHalf, high = kHalf;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      (at(shared, middle, y)[0] > 0.5F ? low : high) = middle;
    }
    return low;
  }

  std::shared_ptr<TriangleMesh> mesh_ = std::make_shared<TriangleMesh>();
};

TEST_F(Plate, SharesAddUpAndComeFromFilmThatIsThere) {
  const SharedSurface shared = divide(StripedPaint(*mesh_, 0, 0), 2);
  for (double x = -19.5; x < 20; x += 0.37)
    for (double y = -19; y < 20; y += 3.1) {
      const std::vector<float> shares = at(shared, x, y);
      EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0F), 1, 1e-5);
      if (x > 10.5) {
        EXPECT_EQ(shares[0], 0);
      }
      if (x < -10.5) {
        EXPECT_EQ(shares[1], 0);
      }
    }
  const std::vector<double> parts = shared.shares_of_surface();
  EXPECT_NEAR(std::accumulate(parts.begin(), parts.end(), 0.0), 1, 1e-9);
}

TEST_F(Plate, TheSeamGoesWhereNoInkIs) {
  const SharedSurface shared = divide(StripedPaint(*mesh_, 4, 6), 2);
  for (double y = -18; y < 19; y += 2) {
    EXPECT_GT(seam_at(shared, y), 3.4) << y;
    EXPECT_LT(seam_at(shared, y), 6.6) << y;
  }
  // About as long as the plate is wide: without ink it costs little to wind.
  EXPECT_NEAR(shared.seam_mm(), 2 * kHalf, 15);
}

TEST_F(Plate, TheFadeIsAsWideAsTheOverlapAndLinear) {
  for (const double overlap : {2.0, 6.0}) {
    const SharedSurface shared = divide(StripedPaint(*mesh_, -1, 1), overlap);
    double off = 0, count = 0;
    for (double y = -15; y < 16; y += 1) {
      const double seam = seam_at(shared, y);
      for (double t = -0.8; t <= 0.8; t += 0.1) {
        const double expected = std::clamp(0.5 - t, 0.0, 1.0);
        const float share = at(shared, seam + t * overlap, y)[0];
        off += std::abs(double(share) - expected);
        ++count;
      }
    }
    EXPECT_LT(off / count, 0.08) << overlap;  // nodes are half a millimetre apart
  }
}

TEST_F(Plate, TheFadeKeepsOffTheBorderOfAFilm) {
  const SharedSurface shared = divide(StripedPaint(*mesh_, 0, 0), 2);
  for (double y = -18; y < 19; y += 2) EXPECT_LT(std::abs(seam_at(shared, y)), 9) << y;
}

// Whatever is known of whole triangles: small ones, large ones and slivers.
TEST_F(Plate, AnAllotmentIsWhatOneDipGets) {
  for (const double overlap : {0.0, 2.0, 12.0}) {
    const SharedSurface shared = divide(StripedPaint(*mesh_, 0, 0), overlap);
    for (const auto& [columns, rows] : {std::pair(1, 1), {100, 100}, {13, 17}, {200, 1}}) {
      const auto tiles = std::make_shared<const TriangleMesh>(tiled(columns, rows));
      const std::vector<Allotment> of = shared.allotments(tiles);
      ASSERT_EQ(of.size(), 2);
      int known = 0;
      for (int i = 0; i < 4000; ++i) {
        const SurfacePoint point{i * 7 % int(tiles->triangles.size()), (i % 20) / 40.0,
                                 (i / 20 % 20) / 40.0};
        const auto shares = shared.shares_at(position_at(*tiles, point), Vec3::UnitZ());
        ASSERT_EQ(of[0].at(point), shares[0]) << columns << " " << rows << " " << i;
        ASSERT_EQ(of[1].at(point), shares[1]) << columns << " " << rows << " " << i;
        for (std::size_t k : {0, 1}) {
          const std::optional<float> over = of[k].over(point.triangle);
          ASSERT_EQ(over.value_or(shares[k]), shares[k]) << columns << " " << rows << " " << i;
          known += over.has_value();
        }
        ASSERT_NEAR(shares[0] + shares[1], 1, 1e-5);
      }
      // Of small triangles most are known as a whole, unless all of them fade.
      if (columns == 100 && overlap < 12) {
        EXPECT_GT(known, 4000) << overlap;
      }
    }
  }
}

TEST_F(Plate, OneDipDoesAll) {
  const auto nodes = std::make_shared<const SurfaceNodes>(spread_targets(*mesh_, 500));
  const Surface surface(mesh_->positions, mesh_->triangles);
  RunContext context;
  const StripedPaint paint(*mesh_, 0, 0);
  const SharedSurface shared({nodes, {std::vector<float>(500, 1.0F)}, paint, surface, 1, 2},
                             context);
  EXPECT_EQ(at(shared, 3, 4), std::vector<float>{1});
  EXPECT_TRUE(shared.seam_nodes().empty());
  EXPECT_EQ(shared.seam_mm(), 0);
}

// Both sides of a thin plate are far from each other.
// Also where the reach is a million times the object, and from far away.
TEST(SurfaceNodes, NearIsWhatADistanceSays) {
  const shapes::Shape ball = shapes::full_sphere(10, 20, 30);
  TriangleMesh object;
  object.positions = ball.positions;
  object.triangles = ball.triangles;
  const SurfaceNodes nodes(spread_targets(object, 800));
  std::vector<std::int32_t> found;
  for (const Vec3& from : {Vec3(10, 0, 0), Vec3(0, -7, 7), Vec3(300, -20, 5)})
    for (const double reach : {1e-3, 3.0, 15.0, 400.0, 1e7}) {
      const Vec3 normal = from.normalized();
      nodes.near(from, normal, reach, found);
      std::vector<std::int32_t> wanted;
      for (std::size_t i = 0; i < nodes.nodes().size(); ++i) {
        const Target& node = nodes.nodes()[i];
        if ((node.position - from).norm() <= reach && node.normal.dot(normal) > 0.5)
          wanted.push_back(std::int32_t(i));
      }
      EXPECT_EQ(found, wanted) << reach;
    }
}

TEST(NearestNode, IsTheNearestOfThoseThatAreNear) {
  const shapes::Shape ball = shapes::full_sphere(10, 20, 30);
  TriangleMesh object;
  object.positions = ball.positions;
  object.triangles = ball.triangles;
  const SurfaceNodes nodes(spread_targets(object, 800));
  std::vector<std::int32_t> among, found;
  for (std::int32_t i = 0; i < 800; ++i)
    if (i % 3 == 1) among.push_back(i);
  const NearestNode nearest(nodes, among);
  for (const Vec3& from : {Vec3(10, 0, 0), Vec3(0, -7, 7), Vec3(1, 2, -3), Vec3(300, -20, 5)})
    for (const double reach : {1e-3, 0.8, 3.0, 15.0, 400.0, 1e7}) {
      const Vec3 normal = from.normalized();
      nodes.near(from, normal, reach, found);
      std::int32_t of_all = -1;
      double least = std::numeric_limits<double>::infinity();
      for (const std::int32_t i : found) {
        const double squared = (nodes.nodes()[std::size_t(i)].position - from).squaredNorm();
        if (i % 3 != 1 || squared >= least) continue;
        least = squared;
        of_all = i;
      }
      const NearestNode::Found at = nearest.find(from, normal, reach);
      EXPECT_EQ(at.node, of_all) << reach;
      EXPECT_TRUE(of_all < 0 || at.squared == least) << reach;
    }
  EXPECT_EQ(NearestNode(nodes, {}).find({10, 0, 0}, Vec3::UnitX(), 99).node, -1);
}

// A plate's nodes twice, in the same places: the first is taken.
TEST(NearestNode, OfTwoThatAreAsNearIsTheFirst) {
  Targets twice;
  twice.area = 8;
  for (int i = 0; i < 8; ++i) {
    Target& node = twice.list.emplace_back();
    node.position = Vec3(i % 4, 0, 0);
    node.normal = Vec3::UnitZ();
    node.area = 1;
  }
  const SurfaceNodes nodes(twice);
  const NearestNode nearest(nodes, {7, 6, 5, 4, 3, 2, 1, 0});
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(nearest.find(Vec3(i + 0.1, 0, 0), Vec3::UnitZ(), 1).node, i);
}

// As a wide fade asks, for which all nodes may lie within reach: each part for what is nearest to
// nodes of the other.
TEST_F(Plate, OfAllNodesWithinReachFewAreLookedAt) {
  const SharedSurface shared = divide(StripedPaint(*mesh_, 0, 0), 2);
  std::vector<std::int32_t> part;
  for (std::size_t i = 0; i < shared.dip_of().size(); ++i)
    if (shared.dip_of()[i] == 0) part.push_back(std::int32_t(i));
  const NearestNode nearest(shared.nodes(), part);
  const std::vector<std::int32_t> at_seam = shared.seam_nodes();
  ASSERT_GT(at_seam.size(), 100U);
  const auto looked_at = [&](double reach) {
    double count = 0;
    for (const std::int32_t i : at_seam)
      count += nearest.find(shared.nodes().nodes()[std::size_t(i)].position, Vec3::UnitZ(), reach)
                   .looked_at;
    return count / double(at_seam.size());
  };
  const double narrow = looked_at(3), wide = looked_at(60);
  EXPECT_GT(narrow, 2);
  EXPECT_LT(wide, 2 * narrow);
  EXPECT_LT(wide, double(part.size()) / 20);
}

TEST(SurfaceNodes, AThinWallHasTwoSides) {
  TriangleMesh wall;
  wall.positions = {{0, 0, 0},   {10, 0, 0},   {10, 10, 0},   {0, 10, 0},
                    {0, 0, 0.1}, {10, 0, 0.1}, {10, 10, 0.1}, {0, 10, 0.1}};
  wall.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  const SurfaceNodes nodes(spread_targets(wall, 1000));
  std::vector<std::int32_t> found;
  nodes.near({5, 5, 0.1}, Vec3::UnitZ(), 2, found);
  EXPECT_FALSE(found.empty());
  for (const std::int32_t i : found) EXPECT_GT(nodes.nodes()[std::size_t(i)].position.z(), 0.05);
  for (const auto& [a, b] : nodes.neighbors())
    EXPECT_NEAR(nodes.nodes()[std::size_t(a)].position.z(),
                nodes.nodes()[std::size_t(b)].position.z(), 1e-9);
}

}  // namespace
}  // namespace hydrodip
