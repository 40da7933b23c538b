#include "plan/sheet_packing.h"

#include <gtest/gtest.h>

#include <random>

namespace hydrodip {
namespace {

// None over another, all on the sheet; how many are.
int sound(const std::vector<PackedPiece>& pieces, const std::vector<Vec2>& sizes,
          const Vec2& sheet) {
  int placed = 0;
  std::vector<Box2> boxes;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!pieces[i].placed) continue;
    ++placed;
    const Vec2 size = pieces[i].turned ? Vec2(sizes[i].y(), sizes[i].x()) : sizes[i];
    const Box2 box{pieces[i].corner_mm, pieces[i].corner_mm + size};
    EXPECT_GE(box.min.minCoeff(), -1e-6);
    EXPECT_LE((box.max - sheet).maxCoeff(), 1e-6);
    for (const Box2& other : boxes)
      EXPECT_FALSE((box.max - other.min).minCoeff() > 1e-6 &&
                   (other.max - box.min).minCoeff() > 1e-6);
    boxes.push_back(box);
  }
  return placed;
}

TEST(Packing, EqualPiecesFillTheSheet) {
  const std::vector<Vec2> sizes(12, Vec2(50, 70));
  const Vec2 sheet(200, 210);
  EXPECT_EQ(sound(pack_pieces(sizes, sheet), sizes, sheet), 12);
}

TEST(Packing, TurnsPiecesThatOnlyFitSo) {
  const std::vector<Vec2> sizes = {Vec2(150, 40), Vec2(40, 150), Vec2(150, 40)};
  const Vec2 sheet(120, 150);
  EXPECT_EQ(sound(pack_pieces(sizes, sheet), sizes, sheet), 3);
}

TEST(Packing, WhatIsTooLargeStaysOut) {
  const std::vector<Vec2> sizes = {Vec2(300, 40), Vec2(50, 50), Vec2(50, 50)};
  const Vec2 sheet(100, 60);
  const auto pieces = pack_pieces(sizes, sheet);
  EXPECT_FALSE(pieces[0].placed);
  EXPECT_EQ(sound(pieces, sizes, sheet), 2);
}

TEST(Packing, IsSoundForAnyPieces) {
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    std::vector<Vec2> sizes;
    for (int i = 0; i < 25; ++i)
      sizes.emplace_back(10.0 + double(random() % 60), 10.0 + double(random() % 60));
    const Vec2 sheet(210, 297);
    EXPECT_GT(sound(pack_pieces(sizes, sheet), sizes, sheet), 15);
  }
}

}  // namespace
}  // namespace hydrodip
