#include "sheet/marks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hydrodip {
namespace {

// Half an em a letter: about Helvetica.
double half_em(const std::string& text) { return 0.5 * double(text.size()); }

SheetOptions sheet(double width_mm, double height_mm, double margin_mm) {
  SheetOptions options;
  options.width_mm = width_mm;
  options.height_mm = height_mm;
  options.margin_mm = margin_mm;
  options.job_name = "A job with a rather long name, number 12345, of the twelfth of December";
  return options;
}

const MarkText* find_text(const Marks& marks, const std::string& part) {
  for (const MarkText& text : marks.texts) {
    if (text.text.find(part) != std::string::npos) return &text;
  }
  return nullptr;
}

// A text that has to be there; one that lies nowhere if it is not.
const MarkText& text(const Marks& marks, const std::string& part) {
  static const MarkText nowhere = {"", Vec2(-1e9, -1e9), 0, 0, 0};
  const MarkText* found = find_text(marks, part);
  EXPECT_NE(found, nullptr) << "there is no mark '" << part << "'";
  return found ? *found : nowhere;
}

// What a text covers, from its descenders to its capitals.
Box2 box_of(const MarkText& text) {
  const double size = text.size_pt * kMmPerPt;
  const double turn = text.quarter_turns * std::acos(0.0);
  const Vec2 along(std::cos(turn), std::sin(turn));
  const Vec2 up(-along.y(), along.x());
  Box2 box;
  for (const double a : {0.0, text.length_mm}) {
    for (const double u : {-0.22 * size, 0.73 * size}) box.add(text.start + a * along + u * up);
  }
  return box;
}

Box2 box_of(const MarkLine& line, double width) {
  Box2 box;
  for (const double side : {-0.5 * width, 0.5 * width}) {
    box.add(line.from + Vec2(side, side));
    box.add(line.to + Vec2(side, side));
  }
  return box;
}

bool overlap(const Box2& a, const Box2& b) {
  return (a.min.array() < b.max.array()).all() && (b.min.array() < a.max.array()).all();
}

// A line may end at the page's edge, where its square end sticks out of the page.
void expect_in_margin(const Box2& box, const SheetOptions& options, double slack,
                      const std::string& what) {
  const Box2 page{Vec2(-slack, -slack), Vec2(options.width_mm + slack, options.height_mm + slack)};
  EXPECT_TRUE((box.min.array() >= page.min.array()).all()) << what;
  EXPECT_TRUE((box.max.array() <= page.max.array()).all()) << what;
  const double margin = options.margin_mm + 1e-9;
  const Box2 film{Vec2(margin, margin),
                  Vec2(options.width_mm - margin, options.height_mm - margin)};
  EXPECT_FALSE(overlap(box, film)) << what;
}

TEST(Marks, StayInTheMarginAndOffEachOther) {
  const std::array<Vec2, 8> sizes = {Vec2(210, 297),     Vec2(215.9, 279.4), Vec2(297, 420),
                                     Vec2(60, 60),       Vec2(124, 80),      Vec2(125, 125),
                                     Vec2(1000.5, 40.1), Vec2(45, 300)};
  for (const Vec2& size : sizes) {
    for (const double margin : {1.0, 2.0, 3.5, 4.6, 5.0, 6.0, 7.0, 10.0, 15.0, 19.0}) {
      for (const bool up : {true, false}) {
        SheetOptions options = sheet(size.x(), size.y(), margin);
        options.ink_side_up = up;
        const Marks marks = make_marks(options, half_em);
        SCOPED_TRACE(::testing::Message() << size.transpose() << " margin " << margin);
        for (const MarkLine& line : marks.lines) {
          expect_in_margin(box_of(line, marks.line_mm), options, marks.line_mm, "line");
        }
        for (const auto& corners : marks.filled) {
          Box2 box;
          for (const Vec2& corner : corners) box.add(corner);
          expect_in_margin(box, options, 0, "arrow");
        }
        for (std::size_t i = 0; i < marks.texts.size(); ++i) {
          const Box2 box = box_of(marks.texts[i]);
          expect_in_margin(box, options, 0, marks.texts[i].text);
          EXPECT_GE(marks.texts[i].size_pt, 3.5) << marks.texts[i].text;
          for (std::size_t j = 0; j < i; ++j) {
            EXPECT_FALSE(overlap(box, box_of(marks.texts[j])))
                << marks.texts[i].text << " / " << marks.texts[j].text;
          }
          for (const MarkLine& line : marks.lines) {
            EXPECT_FALSE(overlap(box, box_of(line, marks.line_mm))) << marks.texts[i].text;
          }
        }
      }
    }
  }
}

TEST(Marks, AnA4SheetHasEverything) {
  const Marks marks = make_marks(sheet(210, 297, 10), half_em);
  EXPECT_TRUE(marks.warnings.empty());
  for (const char* text : {"TOP: this side up", "this edge left", "this edge right",
                           "Print at 100 %, no scaling", "Film 210 x 297 mm", "A job with"}) {
    const MarkText* found = find_text(marks, text);
    ASSERT_NE(found, nullptr) << text;
    EXPECT_GE(found->size_pt, 6) << text;
    EXPECT_LE(found->size_pt, 7) << text;
  }
  EXPECT_TRUE(marks.dashed.empty());
}

TEST(Marks, OrientationStandsAtTheEdgesItNames) {
  SheetOptions options = sheet(210, 297, 10);
  Marks marks = make_marks(options, half_em);
  EXPECT_LT(text(marks, "this edge left").start.x(), 10);
  EXPECT_GT(text(marks, "this edge right").start.x(), 200);
  EXPECT_GT(text(marks, "TOP").start.y(), 287);
  // Turned over about its vertical axis, the printed page's right edge comes to lie left.
  options.ink_side_up = false;
  marks = make_marks(options, half_em);
  EXPECT_GT(text(marks, "this edge left").start.x(), 200);
  EXPECT_LT(text(marks, "this edge right").start.x(), 10);
  EXPECT_GT(text(marks, "TOP").start.y(), 287);
  EXPECT_NE(find_text(marks, "this side down, image mirrored"), nullptr);
  EXPECT_EQ(find_text(marks, "this side up"), nullptr);
}

// Whichever side is up, the arrow beside TOP points to the top edge.
TEST(Marks, TheArrowPointsUp) {
  for (const bool up : {true, false}) {
    SheetOptions options = sheet(210, 297, 10);
    options.ink_side_up = up;
    const Marks marks = make_marks(options, half_em);
    ASSERT_EQ(marks.filled.size(), 1U);
    std::vector<Vec2> corners(marks.filled[0].begin(), marks.filled[0].end());
    std::sort(corners.begin(), corners.end(),
              [](const Vec2& a, const Vec2& b) { return a.y() < b.y(); });
    EXPECT_EQ(corners[0].y(), corners[1].y());
    EXPECT_GT(corners[2].y(), corners[1].y() + 1);
    EXPECT_NEAR(corners[2].x(), 0.5 * (corners[0].x() + corners[1].x()), 1e-12);
    // Beside the text, not in it.
    EXPECT_LT(corners[2].x(), text(marks, "TOP").start.x());
  }
}

// Lengths of the ruler's ticks by position, from the vertical lines in the bottom margin.
std::vector<double> ruler_ticks(const Marks& marks, const SheetOptions& options) {
  std::vector<double> x;
  for (const MarkLine& line : marks.lines) {
    const bool vertical = line.from.x() == line.to.x();
    const bool in_bottom = std::max(line.from.y(), line.to.y()) < options.margin_mm;
    const bool centre_tick = std::min(line.from.y(), line.to.y()) == 0 ||
                             std::max(line.from.y(), line.to.y()) > options.margin_mm - 0.2;
    if (vertical && in_bottom && !centre_tick) x.push_back(line.from.x());
  }
  std::sort(x.begin(), x.end());
  return x;
}

TEST(Marks, TheRulerIsCentredAndHasATickPerMillimetre) {
  const SheetOptions options = sheet(210, 297, 10);
  const std::vector<double> x = ruler_ticks(make_marks(options, half_em), options);
  ASSERT_EQ(x.size(), 101u);
  for (int i = 0; i <= 100; ++i) EXPECT_NEAR(x[std::size_t(i)], 55 + i, 1e-12);
}

TEST(Marks, NarrowSheetsHaveAShorterRulerThatSaysSo) {
  for (const auto& [width, length] : {std::pair{125.0, 100}, {124.9, 90}, {60.0, 30}, {36.0, 10}}) {
    const SheetOptions options = sheet(width, 200, 10);
    const Marks marks = make_marks(options, half_em);
    const std::vector<double> x = ruler_ticks(marks, options);
    ASSERT_EQ(x.size(), std::size_t(length) + 1) << width;
    EXPECT_EQ(ruler_mm(width, 10), length);
    EXPECT_NEAR(x.back() - x.front(), length, 1e-12);
    EXPECT_NE(find_text(marks, std::to_string(length) + " mm"), nullptr) << width;
    EXPECT_EQ(find_text(marks, "ruler " + std::to_string(length)) != nullptr, length < 100);
  }
}

TEST(Marks, ASheetTooNarrowForARulerHasNoneAndSaysSo) {
  const SheetOptions options = sheet(34, 200, 10);
  const Marks marks = make_marks(options, half_em);
  EXPECT_EQ(ruler_mm(34, 10), 0);
  ASSERT_FALSE(marks.warnings.empty());
  EXPECT_NE(marks.warnings.front().find("no room for a ruler"), std::string::npos);
}

TEST(Marks, TheDiscsRimIsDrawnJustOutsideTheFreeFilm) {
  SheetOptions options = sheet(210, 297, 10);
  options.disc = true;
  const Marks marks = make_marks(options, half_em);
  ASSERT_EQ(marks.dashed.size(), 1u);
  EXPECT_EQ(marks.dashed[0].center, Vec2(105, 148.5));
  EXPECT_NEAR(marks.dashed[0].radius_mm - 0.5 * marks.line_mm, 95, 1e-12);
}

TEST(Marks, LongNamesEndInAnEllipsis) {
  SheetOptions options = sheet(210, 297, 10);
  options.job_name = std::string(5000, 'x');
  Marks marks = make_marks(options, half_em);
  const MarkText* name = find_text(marks, "xxx");
  ASSERT_NE(name, nullptr);
  EXPECT_TRUE(name->text.ends_with("x\u2026"));
  EXPECT_GE(name->size_pt, 6);
  // No letter is cut in two.
  for (std::size_t ahead = 0; ahead < 3; ++ahead) {
    options.job_name = std::string(ahead, 'x');
    for (int i = 0; i < 200; ++i) options.job_name += "\u65e5";
    const std::string cut = text(make_marks(options, half_em), "\u65e5").text;
    ASSERT_TRUE(cut.ends_with("\u65e5\u2026")) << cut;
    EXPECT_EQ((cut.size() - ahead) % 3, 0u);
  }
  options.job_name = "";
  marks = make_marks(options, half_em);
  for (const MarkText& text : marks.texts) EXPECT_FALSE(text.text.empty());
}

TEST(Marks, WhatANarrowMarginCannotHoldIsLeftOutWithAWarning) {
  EXPECT_TRUE(make_marks(sheet(210, 297, 5), half_em).warnings.empty());
  const Marks narrow = make_marks(sheet(210, 297, 3), half_em);
  EXPECT_EQ(narrow.warnings.size(), 1u);
  EXPECT_TRUE(narrow.texts.empty());
  EXPECT_FALSE(narrow.lines.empty());
  const Marks none = make_marks(sheet(210, 297, 0), half_em);
  EXPECT_EQ(none.warnings.size(), 1u);
  EXPECT_TRUE(none.lines.empty());
}

TEST(Alarm, StandsInABandOfTheMarginAndPushesNothingOut) {
  for (const double margin : {7.0, 10.0, 20.0}) {
    SheetOptions options = sheet(210, 297, margin);
    const std::size_t before = make_marks(options, half_em).texts.size();
    EXPECT_TRUE(make_marks(options, half_em).bands.empty());
    options.alarm = "DO NOT DIP: 17 % of the object covered, 39.0 % of the film that meets it torn";
    const Marks marks = make_marks(options, half_em);
    ASSERT_EQ(marks.bands.size(), 1U);
    EXPECT_GE(marks.texts.size() + 1, before);
    const MarkBand& band = marks.bands[0];
    EXPECT_TRUE(band.text.text.starts_with("DO NOT DIP"));
    // In the margin's left or right strip, and around its text.
    EXPECT_TRUE((band.box.min.x() > 0 && band.box.max.x() < margin) ||
                (band.box.min.x() > 210 - margin && band.box.max.x() < 210));
    EXPECT_GT(band.box.min.y(), 0);
    EXPECT_LT(band.box.max.y(), 297);
    EXPECT_GT(band.box.max.y() - band.box.min.y(), band.text.length_mm);
  }
}

// The narrower the sheet, the more texts share its long edges.
TEST(Alarm, LeavesEveryTextAPlaceOfItsOwn) {
  for (double width_mm = 16; width_mm <= 120; width_mm += 4)
    for (const char* alarm :
         {"", "DO NOT DIP: 17 % of the object covered, 39.0 % of the film torn"}) {
      SheetOptions options = sheet(width_mm, 300, 7);
      options.alarm = alarm;
      const Marks marks = make_marks(options, half_em);
      std::vector<Box2> boxes;
      for (const MarkText& text : marks.texts) boxes.push_back(box_of(text));
      for (const MarkBand& band : marks.bands) boxes.push_back(band.box);
      for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
          EXPECT_FALSE(overlap(boxes[i], boxes[k])) << width_mm << " mm, " << i << " and " << k;
    }
}

TEST(Alarm, IsShortenedOrMissedWithAWarningWhereThereIsNoRoom) {
  SheetOptions options = sheet(60, 60, 10);
  options.alarm = "DO NOT DIP: 17 % of the object covered, 39.0 % of the film that meets it torn";
  const Marks marks = make_marks(options, half_em);
  if (marks.bands.empty()) {
    EXPECT_FALSE(marks.warnings.empty());
  } else {
    EXPECT_EQ(marks.bands[0].text.text, "DO NOT DIP");
  }
}

}  // namespace
}  // namespace hydrodip
