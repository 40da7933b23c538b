#include "sheet/winansi.h"

#include <array>
#include <cstddef>
#include <string_view>

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
  at += std::size_t(count);
  return code;
}

bool vanishes(char32_t code) {
  const bool control = code < 0x20 || (code >= 0x7F && code < 0xA0);
  const bool combining_accent = code >= 0x0300 && code <= 0x036F;
  return control || combining_accent;
}

char winansi(char32_t code) {
  if (code < 0x80 || (code >= 0xA0 && code <= 0xFF)) return static_cast<char>(code);
  for (std::size_t i = 0; i < kWindows1252.size(); ++i) {
    if (kWindows1252[i] == code) return static_cast<char>(0x80 + i);
  }
  if (code >= 0x100 && code < 0x180) return kLatinExtendedA[code - 0x100];
  return '?';
}

}  // namespace

std::string to_winansi(const std::string& utf8) {
  std::string text;
  for (std::size_t at = 0; at < utf8.size();) {
    const char32_t code = next_code_point(utf8, at);
    if (!vanishes(code)) text += winansi(code);
  }
  return text;
}

}  // namespace hydrodip
