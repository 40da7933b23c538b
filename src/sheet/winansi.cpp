#include "sheet/winansi.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "base/unicode.h"

namespace hydrodip {

namespace {

constexpr char32_t kInvalid = 0xFFFD;

// What Windows-1252 keeps at 0x80 to 0x9F (0: nothing).
constexpr std::array<char32_t, 32> kWindows1252 = {
    0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

// The plain letters of U+0100 to U+017F, in order.
constexpr std::string_view kLatinExtendedA =
    "AaAaAaCcCcCcCcDdDdEeEeEeEeEeGgGgGgGgHhHhIiIiIiIiIiIiJjKkkLlLlLlLlLlNnNnNnnNnOoOoOoOoRrRrRr"
    "SsSsSsSsTtTtTtUuUuUuUuUuUuWwYyYZzZzZzs";
static_assert(kLatinExtendedA.size() == 128);

int continuation_bytes(unsigned char lead) {
  if (lead < 0x80) return 0;
  if (lead >= 0xC2 && lead <= 0xDF) return 1;
  if (lead >= 0xE0 && lead <= 0xEF) return 2;
  if (lead >= 0xF0 && lead <= 0xF4) return 3;
  return -1;
}

// The code point at `at`, which moves past it; past one byte only if the sequence is broken.
char32_t next_code_point(const std::string& utf8, std::size_t& at) {
  const auto lead = static_cast<unsigned char>(utf8[at++]);
  const int count = continuation_bytes(lead);
  if (count == 0) return lead;
  if (count < 0 || utf8.size() - at < std::size_t(count)) return kInvalid;
  char32_t code = lead & (0x3F >> count);
  for (int i = 0; i < count; ++i) {
    const auto byte = static_cast<unsigned char>(utf8[at + std::size_t(i)]);
    if ((byte & 0xC0) != 0x80) return kInvalid;
    code = (code << 6) | (byte & 0x3F);
  }
  constexpr std::array<char32_t, 4> kLeast = {0, 0x80, 0x800, 0x10000};
  const bool half_a_pair = code >= 0xD800 && code < 0xE000;
  if (code < kLeast[std::size_t(count)] || half_a_pair || code > 0x10FFFF) return kInvalid;
  at += std::size_t(count);
  return code;
}

bool is_control(char32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

// Line ends and what turns a line's direction around; XML and fonts make nothing of them.
bool governs_lines(char32_t code) {
  return (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF;
}

bool is_no_character(char32_t code) {
  return code == kInvalid || (code & 0xFFFE) == 0xFFFE || (code >= 0xFDD0 && code <= 0xFDEF);
}

bool vanishes(char32_t code) {
  const bool combining_accent = code >= 0x0300 && code <= 0x036F;
  return is_control(code) || combining_accent;
}

bool is_latin1(char32_t code) { return code < 0x80 || (code >= 0xA0 && code <= 0xFF); }

bool is_windows1252(char32_t code) {
  return is_latin1(code) || (code != 0 && std::find(kWindows1252.begin(), kWindows1252.end(),
                                                    code) != kWindows1252.end());
}

char winansi(char32_t code) {
  if (is_latin1(code)) return static_cast<char>(code);
  for (std::size_t i = 0; i < kWindows1252.size(); ++i) {
    if (kWindows1252[i] == code) return static_cast<char>(0x80 + i);
  }
  if (code >= 0x100 && code < 0x180) return kLatinExtendedA[code - 0x100];
  return '?';
}

}  // namespace

std::string tidy_utf8(const std::string& utf8) {
  std::string text;
  for (std::size_t at = 0; at < utf8.size();) {
    const char32_t code = next_code_point(utf8, at);
    if (is_control(code) || governs_lines(code)) continue;
    append_utf8(is_no_character(code) ? U'?' : code, text);
  }
  return text;
}

bool is_winansi(const std::string& tidy) {
  for (std::size_t at = 0; at < tidy.size();)
    if (!is_windows1252(next_code_point(tidy, at))) return false;
  return true;
}

std::string to_winansi(const std::string& utf8) {
  std::string text;
  for (std::size_t at = 0; at < utf8.size();) {
    const char32_t code = next_code_point(utf8, at);
    if (!vanishes(code)) text += winansi(code);
  }
  return text;
}

std::string to_utf16(const std::string& tidy) {
  std::string text = "\xFE\xFF";
  const auto append = [&](char32_t unit) {
    text += static_cast<char>(unit >> 8);
    text += static_cast<char>(unit & 0xFF);
  };
  for (std::size_t at = 0; at < tidy.size();) {
    const char32_t code = next_code_point(tidy, at);
    if (code < 0x10000) {
      append(code);
    } else {
      append(0xD800 + ((code - 0x10000) >> 10));
      append(0xDC00 + (code & 0x3FF));
    }
  }
  return text;
}

}  // namespace hydrodip
