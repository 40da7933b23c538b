#include "sheet/film_marks.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <set>

#include "sheet/marks.h"
#include "sheet/sheet.h"
#include "sheet/sheet_testing.h"
#include "tags/seen_marks.h"

namespace hydrodip {
namespace {

using fixtures::blank_image;
using fixtures::has_tool;
using fixtures::rasterised;

double half_em(const std::string& text) { return 0.5 * double(text.size()); }

bool overlap(const Box2& a, const Box2& b) {
  return (a.min.array() < b.max.array()).all() && (b.min.array() < a.max.array()).all();
}

TEST(FilmMarks, AreSixAndMoreInEveryMarginThatCanHoldThem) {
  for (const Vec2& size :
       {Vec2(210, 297), Vec2(297, 210), Vec2(215.9, 279.4), Vec2(297, 420), Vec2(130, 140)})
    for (const double margin : {6.0, 10.0, 15.0, 25.0}) {
      const auto marks = film_marks(size.x(), size.y(), margin);
      SCOPED_TRACE(::testing::Message() << size.transpose() << ", " << margin);
      EXPECT_GE(marks.size(), 8U);
      std::set<int> ids;
      for (const MarkPlace& mark : marks) {
        ids.insert(mark.id);
        EXPECT_LT(mark.id, kFirstBoardTag);
        const Box2 outline = mark_outline(mark);
        // On the sheet, and off the free film.
        EXPECT_TRUE((outline.max.cwiseAbs().array() < 0.5 * size.array()).all());
        EXPECT_TRUE((outline.min.cwiseAbs().array() < 0.5 * size.array()).all());
        const Vec2 free = 0.5 * size - Vec2(margin, margin);
        EXPECT_FALSE(overlap(outline, {-free, free}));
        for (const MarkPlace& other : marks)
          if (other.id != mark.id) {
            EXPECT_FALSE(overlap(outline, mark_outline(other)));
          }
      }
      EXPECT_EQ(ids.size(), marks.size());
    }
  EXPECT_TRUE(film_marks(210, 297, 5).empty());
  EXPECT_TRUE(film_marks(100, 80, 10).empty());
}

TEST(FilmMarks, CannotBeTakenForThemselvesInAnyOtherWay) {
  // Neither turned nor mirrored do as many as four of them lie where they lay.
  const auto marks = film_marks(210, 297, 10);
  const std::array<Mat2, 5> motions = {Mat2{{-1, 0}, {0, -1}}, Mat2{{0, -1}, {1, 0}},
                                       Mat2{{0, 1}, {-1, 0}}, Mat2{{-1, 0}, {0, 1}},
                                       Mat2{{1, 0}, {0, -1}}};
  for (const Mat2& motion : motions)
    for (const MarkPlace& mark : marks)
      EXPECT_GT((motion * mark.corner - mark.corner).norm(), 20) << mark.id;
}

TEST(FilmMarks, TextsGiveWay) {
  for (const Vec2& size : {Vec2(210, 297), Vec2(215.9, 279.4), Vec2(297, 210), Vec2(130, 140)})
    for (const bool up : {true, false}) {
      SheetOptions options;
      options.width_mm = size.x();
      options.height_mm = size.y();
      options.job_name = "A job with a rather long name, number 12345";
      options.alarm = "DO NOT DIP: the film tears over 12 % of the surface";
      options.camera_marks = true;
      options.ink_side_up = up;
      const Marks marks = make_marks(options, half_em);
      EXPECT_FALSE(marks.boxes.empty());
      EXPECT_TRUE(marks.warnings.empty());
      for (const Box2& box : marks.boxes) {
        for (const MarkText& text : marks.texts) {
          Box2 around;
          const double turn = text.quarter_turns * std::acos(0.0);
          const Vec2 along(std::cos(turn), std::sin(turn)), upright(-along.y(), along.x());
          for (const double a : {0.0, text.length_mm})
            for (const double b : {-0.5, 2.0}) around.add(text.start + a * along + b * upright);
          EXPECT_FALSE(overlap(box, around)) << text.text;
        }
        for (const MarkLine& line : marks.lines) {
          Box2 around;
          around.add(line.from);
          around.add(line.to);
          around.min -= Vec2(0.2, 0.2);
          around.max += Vec2(0.2, 0.2);
          EXPECT_FALSE(overlap(box, around));
        }
        for (const MarkBand& band : marks.bands) EXPECT_FALSE(overlap(box, band.box));
      }
    }
}

// The page as another program draws it.
class PrintedMarks : public fixtures::InFolder {
 protected:
  static constexpr int kDpi = 254;  // whole pixels to the page
  GrayImage page(const SheetOptions& options) {
    const auto path = folder_ / "print.pdf";
    write_print_pdf(path, blank_image(options), srgb_profile(), options, RunContext());
    return gray_of(rasterised(path, kDpi, 0, 0, int(std::lround(options.width_mm * kDpi / 25.4)),
                              int(std::lround(options.height_mm * kDpi / 25.4))));
  }
  // Film coordinate of a place on that page.
  static Vec2 on_film(const Vec2& px, const SheetOptions& options) {
    return {px.x() * 25.4 / kDpi - 0.5 * options.width_mm,
            0.5 * options.height_mm - px.y() * 25.4 / kDpi};
  }
  static SheetOptions a4() {
    SheetOptions options = fixtures::sheet(210, 297, 10, 72);
    options.camera_marks = true;
    return options;
  }
};

TEST_F(PrintedMarks, AreFoundInTheirPlaces) {
  if (!has_tool("pdftoppm")) GTEST_SKIP() << "needs pdftoppm";
  SheetOptions options = a4();
  for (const bool up : {true, false}) {
    options.ink_side_up = up;
    GrayImage seen = page(options);
    // A sheet that lies ink side down is seen from its back.
    if (!up) seen = mirrored(seen);
    const auto found = find_marks(seen, RunContext());
    const auto marks = film_marks(210, 297, 10);
    ASSERT_EQ(found.size(), marks.size());
    for (std::size_t i = 0; i < marks.size(); ++i) {
      EXPECT_EQ(found[i].id, marks[i].id);
      // The other program draws rectangles to whole pixels.
      EXPECT_LT((on_film(found[i].corner_px, options) - marks[i].corner).norm(), 0.06);
    }
  }
}

TEST_F(PrintedMarks, ComeOutTrueFromAPrinterThatIsNot) {
  if (!has_tool("pdftoppm")) GTEST_SKIP() << "needs pdftoppm";
  SheetOptions options = a4();
  options.printer = {1.0052, 0.9961, 0.0031};
  Mat2 prints;
  prints << options.printer.x, options.printer.skew, 0, options.printer.y;
  const auto found = find_marks(page(options), RunContext());
  const auto marks = film_marks(210, 297, 10);
  ASSERT_EQ(found.size(), marks.size());
  std::vector<Vec2> paper;
  for (const SeenMark& mark : found) paper.push_back(prints * on_film(mark.corner_px, options));
  // Any length, the longest some 250 mm.
  double longest = 0;
  for (std::size_t i = 0; i < marks.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double length = (marks[i].corner - marks[j].corner).norm();
      longest = std::max(longest, length);
      EXPECT_NEAR((paper[i] - paper[j]).norm(), length, 0.05);
    }
  EXPECT_GT(longest, 250);
}

}  // namespace
}  // namespace hydrodip
