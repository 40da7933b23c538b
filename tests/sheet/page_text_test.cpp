#include "sheet/page_text.h"

#include <gtest/gtest.h>

#include "contains.h"

namespace hydrodip {
namespace {

using Letters = std::vector<std::string>;

// Places of Unicode that no font will ever have letters for.
std::string nobodys(int number) { return "\xf4\x8f\xbf" + std::string(1, char(0xbd - number)); }

TEST(PageText, WhatThePdfFontsHaveStaysAsItIs) {
  const PageText text = page_text("Größe 7 mm");
  EXPECT_EQ(text.shown, "Größe 7 mm");
  EXPECT_TRUE(text.lost.empty());
}

TEST(PageText, LettersThatNoFontHasAreReplacedWhereverTheyStand) {
  const std::string none = nobodys(0), other = nobodys(1);
  const PageText text = page_text(none + "ß" + other + "-" + none);
  EXPECT_EQ(text.shown, "?ß?-?");
  EXPECT_EQ(text.lost, (Letters{none, other}));
}

TEST(PageText, LostLettersAreWarnedOfAndNotAllOfMany) {
  const auto told = [](int letters) {
    const RunContext context;
    std::string name;
    for (int i = 0; i < letters; ++i) name += nobodys(i);
    warn_of_lost_letters("the job's name", name, "print.pdf", context);
    return context.warnings();
  };
  EXPECT_TRUE(told(0).empty());
  ASSERT_EQ(told(1).size(), 1U);
  EXPECT_TRUE(contains(told(1)[0], "letters " + nobodys(0) + " of the job's name")) << told(1)[0];
  EXPECT_TRUE(contains(told(1)[0], "stands as '?' in print.pdf")) << told(1)[0];
  ASSERT_EQ(told(20).size(), 1U);
  EXPECT_TRUE(contains(told(20)[0], nobodys(7) + "... of")) << told(20)[0];
  EXPECT_FALSE(contains(told(20)[0], nobodys(8) + "...")) << told(20)[0];
}

}  // namespace
}  // namespace hydrodip
