#include "artwork/fonts.h"

#include <fmt/format.h>
#include <fontconfig/fontconfig.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "base/error.h"

namespace hydrodip {
namespace {

struct Destroy {
  void operator()(FcPattern* pattern) const { FcPatternDestroy(pattern); }
  void operator()(FcFontSet* set) const { FcFontSetDestroy(set); }
};
template <class Type>
using Owned = std::unique_ptr<Type, Destroy>;

// The families that mean any font of a kind, or what the machine takes for it.
constexpr std::array kGeneral = {"sans", "sans-serif", "serif",   "monospace",
                                 "mono", "cursive",    "fantasy", "system-ui"};

const FcChar8* as_fc(const std::string& text) {
  return reinterpret_cast<const FcChar8*>(text.c_str());
}

std::string text_of(FcPattern* font, const char* key, int n = 0) {
  FcChar8* value = nullptr;
  if (FcPatternGetString(font, key, n, &value) != FcResultMatch || !value) return "";
  return reinterpret_cast<const char*>(value);
}

// The best first, and those for letters that it lacks after it.
Owned<FcFontSet> sorted_fonts(const FontWish& wish) {
  const Owned<FcPattern> pattern(FcPatternCreate());
  FcPatternAddString(pattern.get(), FC_FAMILY, as_fc(wish.family));
  FcPatternAddInteger(pattern.get(), FC_WEIGHT, wish.bold ? FC_WEIGHT_BOLD : FC_WEIGHT_NORMAL);
  FcPatternAddInteger(pattern.get(), FC_SLANT, wish.italic ? FC_SLANT_ITALIC : FC_SLANT_ROMAN);
  FcConfigSubstitute(nullptr, pattern.get(), FcMatchPattern);
  FcDefaultSubstitute(pattern.get());
  FcResult result = FcResultMatch;
  return Owned<FcFontSet>(FcFontSort(nullptr, pattern.get(), FcTrue, nullptr, &result));
}

[[noreturn]] void refuse_without_fonts(const std::string& what) {
  throw InputError(what +
                   ": no fonts are installed on this machine; install some (on Debian: "
                   "fonts-dejavu-core), or convert the text to paths in an SVG");
}

bool is_of_family(FcPattern* font, const std::string& family) {
  for (int n = 0;; ++n) {
    const std::string name = text_of(font, FC_FAMILY, n);
    if (name.empty()) return false;
    if (FcStrCmpIgnoreCase(as_fc(name), as_fc(family)) == 0) return true;
  }
}

FontUse described(FcPattern* font, const FontWish& wish) {
  const bool any = std::find(kGeneral.begin(), kGeneral.end(), wish.family) != kGeneral.end();
  return {text_of(font, FC_FAMILY) + " " + text_of(font, FC_STYLE), text_of(font, FC_FILE),
          any || is_of_family(font, wish.family)};
}

// Blanks and what is not seen need no font.
bool is_drawn(FcChar32 letter) {
  return letter > 0x20 && letter != 0x7f && letter != 0xa0 && letter != 0x200b &&
         letter != 0x200c && letter != 0x200d && letter != 0xfeff &&
         !(letter >= 0xfe00 && letter <= 0xfe0f);
}

// The first that has it, or null.
FcPattern* font_with(const FcFontSet& fonts, FcChar32 letter) {
  for (int n = 0; n < fonts.nfont; ++n) {
    FcCharSet* letters = nullptr;
    if (FcPatternGetCharSet(fonts.fonts[n], FC_CHARSET, 0, &letters) == FcResultMatch &&
        FcCharSetHasChar(letters, letter))
      return fonts.fonts[n];
  }
  return nullptr;
}

// Calls visit(letter, its UTF-8) for every letter that needs a font.
template <class Visit>
void for_each_drawn(const std::string& text, const std::string& what, const Visit& visit) {
  for (std::size_t at = 0; at < text.size();) {
    FcChar32 letter = 0;
    const auto* rest = reinterpret_cast<const FcChar8*>(text.data() + at);
    const int length = FcUtf8ToUcs4(rest, &letter, int(text.size() - at));
    if (length <= 0) throw InputError(what + ": the text is not valid UTF-8");
    if (is_drawn(letter)) visit(letter, std::string_view(text).substr(at, std::size_t(length)));
    at += std::size_t(length);
  }
}

bool take_last_word(std::string& text, std::string_view word) {
  if (text.size() < word.size() || !text.ends_with(word)) return false;
  const std::size_t rest = text.size() - word.size();
  if (rest > 0 && text[rest - 1] != ' ') return false;
  text.resize(rest > 0 ? rest - 1 : 0);
  return true;
}

}  // namespace

FontWish parse_font(std::string font) {
  FontWish wish;
  for (bool found = true; found;) {
    found = take_last_word(font, "bold");
    wish.bold |= found;
    const bool slanted = take_last_word(font, "italic");
    wish.italic |= slanted;
    found |= slanted;
  }
  if (!font.empty() && font != "sans") wish.family = font;
  return wish;
}

std::vector<FontUse> fonts_for(const std::string& text, const FontWish& wish,
                               const std::string& what) {
  const Owned<FcFontSet> fonts = sorted_fonts(wish);
  if (!fonts || fonts->nfont == 0) refuse_without_fonts(what);
  std::vector<FontUse> used;
  for_each_drawn(text, what, [&](FcChar32 letter, std::string_view as_written) {
    FcPattern* with = font_with(*fonts, letter);
    if (!with)
      throw InputError(fmt::format(
          "{}: no font on this machine has the letter '{}' (U+{:04X}); install one that has it, "
          "or convert the text to paths in an SVG",
          what, as_written, letter));
    const FontUse use = described(with, wish);
    if (std::none_of(used.begin(), used.end(),
                     [&](const FontUse& other) { return other.file == use.file; }))
      used.push_back(use);
  });
  return used;
}

std::vector<std::string> letters_without_font(const std::string& text, const FontWish& wish,
                                              const std::string& what) {
  const Owned<FcFontSet> fonts = sorted_fonts(wish);
  std::vector<std::string> letters;
  for_each_drawn(text, what, [&](FcChar32 letter, std::string_view as_written) {
    if (fonts && font_with(*fonts, letter)) return;
    if (std::find(letters.begin(), letters.end(), as_written) == letters.end())
      letters.emplace_back(as_written);
  });
  return letters;
}

bool has_fonts() {
  const Owned<FcFontSet> fonts = sorted_fonts({});
  return fonts && fonts->nfont > 0;
}

void require_fonts(const std::string& what) {
  if (!has_fonts()) refuse_without_fonts(what);
}

}  // namespace hydrodip
