#include "sheet/page_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "artwork/fonts.h"
#include "sheet/winansi.h"

namespace hydrodip {
namespace {

constexpr const char* kFamily = "Helvetica";

std::string replaced(std::string text, const std::string& letter, const std::string& by) {
  for (std::size_t at = text.find(letter); at != std::string::npos;
       at = text.find(letter, at + by.size()))
    text.replace(at, letter.size(), by);
  return text;
}

}  // namespace

PageText page_text(const std::string& utf8) {
  PageText text{tidy_utf8(utf8), {}};
  if (is_winansi(text.shown)) return text;
  text.lost = letters_without_font(text.shown, {kFamily}, "a page's text");
  // Those of the PDF fonts need no other.
  std::erase_if(text.lost, is_winansi);
  for (const std::string& letter : text.lost)
    text.shown = replaced(text.shown, letter, to_winansi(letter));
  return text;
}

void warn_of_lost_letters(const std::string& what, const std::string& utf8, const std::string& file,
                          const RunContext& context) {
  constexpr std::size_t kMostNamed = 8;
  const PageText text = page_text(utf8);
  if (text.lost.empty()) return;
  std::string letters;
  for (std::size_t i = 0; i < std::min(kMostNamed, text.lost.size()); ++i) letters += text.lost[i];
  context.warn(fmt::format(
      "No font on this machine has the letters {}{} of {}, which stands as '{}' in {}; install a "
      "font that has them (on Debian, for Chinese, Japanese and Korean: fonts-noto-cjk; for most "
      "others: fonts-dejavu-core).",
      letters, text.lost.size() > kMostNamed ? "..." : "", what, text.shown, file));
}

std::optional<DrawnLine> set_line(const std::string& shown, bool bold) {
  if (!has_fonts()) return {};  // what is left is not seen
  return Drawing::of_line(shown, bold ? std::string(kFamily) + " bold" : kFamily);
}

}  // namespace hydrodip
