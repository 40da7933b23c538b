#include "object/flat_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "samples/samples.h"

namespace hydrodip {
namespace {

std::vector<std::size_t> sizes(const std::vector<std::vector<std::size_t>>& pieces) {
  std::vector<std::size_t> sizes;
  for (const auto& piece : pieces) sizes.push_back(piece.size());
  return sizes;
}

TEST(FlatPieces, EveryTriangleIsInOne) {
  const Object box = make_sample("box");
  std::set<std::size_t> seen;
  std::size_t count = 0;
  for (const auto& piece : flat_pieces(box)) {
    seen.insert(piece.begin(), piece.end());
    count += piece.size();
  }
  EXPECT_EQ(count, box.triangles.size());
  EXPECT_EQ(seen.size(), box.triangles.size());
}

TEST(FlatPieces, ACubeHasSixOfTwoTriangles) {
  TriangleMesh cube;
  for (int v = 0; v < 8; ++v) cube.positions.emplace_back(v & 1, (v >> 1) & 1, (v >> 2) & 1);
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  EXPECT_EQ(sizes(flat_pieces(cube)), std::vector<std::size_t>(6, 2));
}

TEST(FlatPieces, ASphereHasNone) {
  Object sphere = make_sample("sphere");
  const std::vector<std::size_t> of = sizes(flat_pieces(sphere));
  EXPECT_LE(*std::max_element(of.begin(), of.end()), 4U) << "half a degree is a facet or two";
}

// Three leaves of a book in one plane would overlap.
TEST(FlatPieces, NoneGoesOnAcrossAnEdgeOfThree) {
  TriangleMesh book;
  book.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}};
  book.triangles = {{0, 2, 1}, {0, 3, 1}, {0, 1, 4}};
  EXPECT_EQ(flat_pieces(book).size(), 3U);
}

}  // namespace
}  // namespace hydrodip
