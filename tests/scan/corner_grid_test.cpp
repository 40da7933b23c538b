#include "scan/corner_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "base/error.h"
#include "contains.h"

namespace hydrodip {
namespace {

using Quad = std::array<std::int32_t, 4>;

struct QuadMesh {
  std::vector<Vec3> corners;
  std::vector<Quad> quads;
};

// columns x rows corners on the film, seen from above; the object lies above the film, so that from
// outside of it faces run the other way.
QuadMesh sheet(int columns, int rows) {
  QuadMesh mesh;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) mesh.corners.push_back(Vec3(5.0 * i, 5.0 * j, 0));
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i + 1 < columns; ++i) {
      const int a = j * columns + i;
      mesh.quads.push_back({a, a + columns, a + columns + 1, a + 1});
    }
  return mesh;
}

// Quads in another order, each begun at another corner.
void shuffle(QuadMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  std::shuffle(mesh.quads.begin(), mesh.quads.end(), random);
  for (Quad& quad : mesh.quads) std::rotate(quad.begin(), quad.begin() + random() % 4, quad.end());
}

// Rows and columns are as on the sheet, but for a shift and quarter turns.
void expect_same_grid(const CornerGrid& grid) {
  ASSERT_FALSE(grid.position.empty());
  const Vec2 p0 = grid.position[0].head<2>() / 5;
  const Vec2 q0(grid.place[0][0], grid.place[0][1]);
  int fits = 0;
  for (int turns = 0; turns < 4; ++turns) {
    const Mat2 turn = (Mat2() << 0, -1, 1, 0).finished();
    Mat2 total = Mat2::Identity();
    for (int i = 0; i < turns; ++i) total = (turn * total).eval();
    bool all = true;
    for (std::size_t c = 0; c < grid.position.size(); ++c) {
      const Vec2 p = grid.position[c].head<2>() / 5 - p0;
      const Vec2 q = Vec2(grid.place[c][0], grid.place[c][1]) - q0;
      all = all && (total * q - p).norm() < 1e-9;
    }
    fits += all;
  }
  EXPECT_EQ(fits, 1);
}

int count(const std::vector<GridLength>& lengths, bool diagonal) {
  return int(std::count_if(lengths.begin(), lengths.end(),
                           [&](const GridLength& length) { return length.diagonal == diagonal; }));
}

TEST(QuadsTest, RowsAndColumnsComeFromConnectivityInAnyOrder) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    QuadMesh mesh = sheet(7, 5);
    shuffle(mesh, seed);
    const CornerGrid grid = grid_of_quads(mesh.corners, mesh.quads, "sheet");
    EXPECT_EQ(grid.position.size(), 35u);
    expect_same_grid(grid);
    const std::vector<GridLength> lengths = grid_lengths(grid);
    EXPECT_EQ(count(lengths, false), 6 * 5 + 7 * 4);
    EXPECT_EQ(count(lengths, true), 2 * 6 * 4);
    for (const GridLength& length : lengths) {
      const double d =
          (grid.position[std::size_t(length.from)] - grid.position[std::size_t(length.to)]).norm();
      EXPECT_NEAR(d, length.diagonal ? 5 * std::sqrt(2.0) : 5, 1e-12);
    }
  }
}

TEST(QuadsTest, AFewQuadsTurnedRoundChangeNothing) {
  QuadMesh mesh = sheet(6, 6);
  for (const std::size_t q : {0, 7, 13}) std::reverse(mesh.quads[q].begin(), mesh.quads[q].end());
  expect_same_grid(grid_of_quads(mesh.corners, mesh.quads, "sheet"));
}

TEST(QuadsTest, AllQuadsTurnedRoundMirrorTheGrid) {
  QuadMesh mesh = sheet(4, 4), turned = sheet(4, 4);
  for (Quad& quad : turned.quads) std::reverse(quad.begin(), quad.end());
  const auto handedness = [](const CornerGrid& grid) {
    // Of rows and columns against the sheet's own.
    for (const GridLength& a : grid_lengths(grid))
      for (const GridLength& b : grid_lengths(grid)) {
        if (a.from != b.from || a.diagonal || b.diagonal) continue;
        const auto along = [&](const GridLength& l) -> Vec2 {
          return (grid.position[std::size_t(l.to)] - grid.position[std::size_t(l.from)]).head<2>();
        };
        const auto places = [&](const GridLength& l) -> Vec2 {
          const GridPlace &t = grid.place[std::size_t(l.to)], &f = grid.place[std::size_t(l.from)];
          return {t[0] - f[0], t[1] - f[1]};
        };
        const double product = cross2(along(a), along(b)) * cross2(places(a), places(b));
        if (product != 0) return product > 0 ? 1 : -1;
      }
    return 0;
  };
  EXPECT_EQ(handedness(grid_of_quads(mesh.corners, mesh.quads, "")), 1);
  EXPECT_EQ(handedness(grid_of_quads(turned.corners, turned.quads, "")), -1);
}

TEST(QuadsTest, MissingSquaresLeaveTheRestConnected) {
  QuadMesh mesh = sheet(8, 8);
  mesh.quads.erase(mesh.quads.begin() + 24);
  mesh.quads.erase(mesh.quads.begin() + 10);
  expect_same_grid(grid_of_quads(mesh.corners, mesh.quads, "sheet"));
}

TEST(QuadsTest, PartsThatTouchAtACornerOnlyAreNotRelated) {
  QuadMesh mesh = sheet(3, 3);
  mesh.quads = {mesh.quads[0], mesh.quads[3]};  // diagonal neighbours
  const CornerGrid grid = grid_of_quads(mesh.corners, mesh.quads, "sheet");
  EXPECT_EQ(grid.position.size(), 8u);
  EXPECT_EQ(std::set<int>(grid.patch.begin(), grid.patch.end()).size(), 2u);
  EXPECT_EQ(count(grid_lengths(grid), false), 8);
}

TEST(QuadsTest, RefusesWhatIsNoCheckerboard) {
  const auto refuse = [](QuadMesh mesh) {
    EXPECT_THROW(grid_of_quads(mesh.corners, mesh.quads, "sheet"), InputError);
  };
  QuadMesh doubled = sheet(3, 2);
  doubled.quads.push_back(doubled.quads[0]);
  doubled.quads.push_back(doubled.quads[0]);
  refuse(doubled);
  // Three squares at one edge, as a book's pages at its back.
  QuadMesh book;
  book.corners = {{0, 0, 0},  {1, 0, 0},  {1, 1, 0}, {0, 1, 0},
                  {0, -1, 0}, {1, -1, 0}, {1, 0, 1}, {0, 0, 1}};
  book.quads = {{0, 1, 2, 3}, {1, 0, 4, 5}, {0, 1, 6, 7}};
  try {
    grid_of_quads(book.corners, book.quads, "sheet");
    ADD_FAILURE() << "a book was taken for a board";
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "3 quads share one edge")) << error.what();
  }
  QuadMesh pinched = sheet(2, 2);
  pinched.quads[0][2] = pinched.quads[0][1];
  refuse(pinched);
  QuadMesh outside = sheet(2, 2);
  outside.quads[0][2] = 4;
  refuse(outside);
  // Three squares around a corner, as at a cube's.
  QuadMesh cube;
  cube.corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  cube.quads = {{0, 1, 2, 3}, {0, 4, 5, 1}, {0, 3, 6, 4}};
  refuse(cube);
}

}  // namespace
}  // namespace hydrodip
