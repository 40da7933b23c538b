#include <gtest/gtest.h>

#include <cmath>

#include "tags/mark.h"
#include "tags/seen_marks.h"

namespace hydrodip {
namespace {

// The mark on white paper, seen from above with so many pixels a cell and turned by an angle:
// 4 x 4 samples a pixel.
GrayImage picture_of(const MarkPlace& mark, double cell_px, double turn_rad,
                     const Vec2& corner_px) {
  GrayImage image{400, 400, std::vector<std::uint8_t>(160000, 0)};
  const std::vector<Box2> boxes = mark_boxes(mark);
  const double scale = mark.cell_mm / cell_px;
  for (int y = 0; y < 400; ++y)
    for (int x = 0; x < 400; ++x) {
      int white = 0;
      for (int s = 0; s < 16; ++s) {
        const Vec2 from = Vec2(x + (s % 4 + 0.5) / 4, y + (s / 4 + 0.5) / 4) - corner_px;
        const Vec2 turned(std::cos(turn_rad) * from.x() + std::sin(turn_rad) * from.y(),
                          -std::sin(turn_rad) * from.x() + std::cos(turn_rad) * from.y());
        const Vec2 mm = mark.corner + scale * Vec2(turned.x(), -turned.y());
        bool black = false;
        for (const Box2& box : boxes)
          black = black || (mm.x() > box.min.x() && mm.x() < box.max.x() && mm.y() > box.min.y() &&
                            mm.y() < box.max.y());
        white += !black;
      }
      image.value[std::size_t(y) * 400 + std::size_t(x)] = std::uint8_t(30 + 12 * white);
    }
  return image;
}

TEST(Marks, AreFoundWhereTheyAreHoweverTheyAreTurned) {
  for (int k = 0; k < 6; ++k) {
    const Vec2 corner(200 + 0.37 * k, 200 - 0.23 * k);
    const MarkPlace mark{
        7 + 90 * k, {31, -12}, k % 2 ? Vec2(Vec2::UnitX()) : Vec2(-Vec2::UnitY()), 0.6};
    const auto found = find_marks(picture_of(mark, 4.5 + 0.6 * k, 0.9 * k, corner), RunContext());
    ASSERT_EQ(found.size(), 1U) << k;
    EXPECT_EQ(found[0].id, mark.id);
    EXPECT_LT((found[0].corner_px - corner).norm(), 0.05) << k;
    EXPECT_NEAR(found[0].cell_px, 4.5 + 0.6 * k, 0.25);
  }
}

TEST(Marks, MirroredAreFoundOnlyInTheMirroredPicture) {
  const MarkPlace mark{33, Vec2::Zero(), Vec2::UnitX(), 0.6};
  const GrayImage seen = mirrored(picture_of(mark, 5, 0.2, {190, 210}));
  EXPECT_TRUE(find_marks(seen, RunContext()).empty());
  const auto found = find_marks(mirrored(seen), RunContext());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT((found[0].corner_px - Vec2(190, 210)).norm(), 0.05);
}

TEST(Marks, TagsWithoutTheirCornerAreNone) {
  const MarkPlace mark{33, Vec2::Zero(), Vec2::UnitX(), 0.6};
  GrayImage image = picture_of(mark, 5, 0, {200, 200});
  for (int y = 0; y < 400; ++y)
    for (int x = 176; x < 400; ++x) image.value[std::size_t(y) * 400 + std::size_t(x)] = 222;
  EXPECT_TRUE(find_marks(image, RunContext()).empty());
}

TEST(Marks, NothingIsFoundInTinyOrEmptyPictures) {
  EXPECT_TRUE(find_marks({}, RunContext()).empty());
  EXPECT_TRUE(find_marks({3, 2, std::vector<std::uint8_t>(6, 9)}, RunContext()).empty());
  EXPECT_TRUE(find_marks({64, 64, std::vector<std::uint8_t>(4096, 200)}, RunContext()).empty());
}

}  // namespace
}  // namespace hydrodip
