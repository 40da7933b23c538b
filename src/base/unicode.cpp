#include "base/unicode.h"

#include "base/run_scope.h"

namespace hydrodip {
namespace {

// Two bytes a unit; the mark is one unit, and a text goes on with a plain character.
enum class Utf16 { kNone, kLittle, kBig };

Utf16 utf16_of(const std::vector<std::uint8_t>& bytes) {
  if (bytes.size() < 4) return Utf16::kNone;
  const auto is_plain = [](int low, int high) { return high == 0 && low > 0 && low < 0x80; };
  if (bytes[0] == 0xff && bytes[1] == 0xfe && is_plain(bytes[2], bytes[3])) return Utf16::kLittle;
  if (bytes[0] == 0xfe && bytes[1] == 0xff && is_plain(bytes[3], bytes[2])) return Utf16::kBig;
  return Utf16::kNone;
}

}  // namespace

std::vector<std::uint8_t> in_utf8(std::vector<std::uint8_t> bytes) {
  constexpr std::uint32_t kUnknown = 0xfffd;  // stands for half a pair
  const Utf16 kind = utf16_of(bytes);
  if (kind == Utf16::kNone) return bytes;
  const auto unit = [&](std::size_t at) {
    const std::uint32_t first = bytes[at], second = bytes[at + 1];
    return kind == Utf16::kLittle ? first | second << 8 : first << 8 | second;
  };
  CheckEvery check(1 << 20);
  std::vector<std::uint8_t> out;
  out.reserve(bytes.size() / 2);
  for (std::size_t at = 2; at + 2 <= bytes.size(); at += 2) {
    check();
    std::uint32_t point = unit(at);
    const bool leads = point >= 0xd800 && point < 0xdc00;
    const std::uint32_t next = leads && at + 4 <= bytes.size() ? unit(at + 2) : 0;
    if (leads && next >= 0xdc00 && next < 0xe000) {
      point = 0x10000 + ((point - 0xd800) << 10) + (next - 0xdc00);
      at += 2;
    } else if (point >= 0xd800 && point < 0xe000) {
      point = kUnknown;
    }
    append_utf8(point, out);
  }
  return out;
}

std::string cut_utf8(std::string text, std::size_t most_bytes) {
  if (text.size() <= most_bytes) return text;
  std::size_t end = most_bytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  text.resize(end);
  return text;
}

}  // namespace hydrodip
