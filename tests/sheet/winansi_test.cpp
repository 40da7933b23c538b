#include "sheet/winansi.h"

#include <gtest/gtest.h>

namespace hydrodip {
namespace {

TEST(WinAnsi, AsciiAndLatin1Survive) {
  EXPECT_EQ(to_winansi("Spot 80 mm, no. 3 (%)"), "Spot 80 mm, no. 3 (%)");
  EXPECT_EQ(to_winansi("Gr\u00f6\u00dfe \u00b5\u00a9"),
            "Gr\xf6\xdf"
            "e \xb5\xa9");
}

TEST(WinAnsi, PunctuationOfWindows1252Survives) {
  EXPECT_EQ(to_winansi("\u20ac\u2026\u2018\u2019\u201c\u201d\u2013\u2014\u2122\u0161\u0178"),
            "\x80\x85\x91\x92\x93\x94\x96\x97\x99\x9a\x9f");
}

TEST(WinAnsi, OtherLatinLettersLoseTheirAccents) {
  EXPECT_EQ(to_winansi("\u0141\u00f3d\u017a"),
            "L\xf3"
            "dz");
  EXPECT_EQ(to_winansi("\u010ce\u0161tina \u0151\u0171 \u011f\u0131 \u0100\u017f"),
            "Ce\x9atina ou gi As");
  EXPECT_EQ(to_winansi("e\u0301"), "e") << "combining accents vanish";
}

TEST(WinAnsi, OtherScriptsBecomeOneQuestionMarkEach) {
  EXPECT_EQ(to_winansi("a\u65e5\u672cb\U0001F600"), "a??b?");
}

TEST(WinAnsi, ControlCharactersVanish) {
  EXPECT_EQ(to_winansi("a\tb\nc\x7f"
                       "d\u0085"),
            "abcd");
  EXPECT_EQ(to_winansi(std::string("a\0b", 3)), "ab");
}

TEST(WinAnsi, BrokenUtf8NeverHidesWhatFollows) {
  EXPECT_EQ(to_winansi("\xff"
                       "a"),
            "?a");
  EXPECT_EQ(to_winansi("\xc3"), "?");
  EXPECT_EQ(to_winansi("\xe2\x82"), "??");
  EXPECT_EQ(to_winansi("\xc3(x"), "?(x");
  EXPECT_EQ(to_winansi("\xf5\x80"
                       "z"),
            "??z");
}

TEST(TidyUtf8, KeepsLettersAndNothingThatIsNone) {
  EXPECT_EQ(tidy_utf8("a\u00f6\u0142\u65e5\U0001F600e\u0301"),
            "a\u00f6\u0142\u65e5\U0001F600e\u0301");
  EXPECT_EQ(tidy_utf8("a\tb\n\x7f\u0085\u2028\u202e\ufeff"), "ab");
  // Bytes of Latin-1, cut letters, letters in more bytes than they need, halves of UTF-16's pairs,
  // beyond Unicode, and what stands for no character.
  EXPECT_EQ(tidy_utf8("Gr\xf6\xdf"
                      "e"),
            "Gr??e");
  EXPECT_EQ(tidy_utf8("\xe2\x82"), "??");
  EXPECT_EQ(tidy_utf8("\xe0\x80\x80\xed\xa0\x80\xf4\x90\x80\x80"), "??????????");
  EXPECT_EQ(tidy_utf8("\xef\xbf\xbf"), "?");
}

TEST(WinAnsi, SaysWhetherItHasAllLetters) {
  EXPECT_TRUE(is_winansi("Gr\u00f6\u00dfe 5 \u20ac \u2026 \u0160"));
  for (const char* text : {"\u0141\u00f3d\u017a", "e\u0301", "\u041c\u0430", "\u03a9", "\u65e5"})
    EXPECT_FALSE(is_winansi(text)) << text;
}

TEST(Utf16, BeginsWithItsMarkAndHasPairs) {
  EXPECT_EQ(to_utf16("A\u03a9"), std::string("\xfe\xff\0A\x03\xa9", 6));
  EXPECT_EQ(to_utf16("\U0001F600"), std::string("\xfe\xff\xd8\x3d\xde\0", 6));
}

}  // namespace
}  // namespace hydrodip
