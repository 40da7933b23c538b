#include "model_io/text.h"

#include "base/run_scope.h"

namespace hydrodip {

namespace {

constexpr std::size_t kMostDigits = 18;    // of a whole part that fits 64 bits
constexpr std::size_t kMostDecimals = 15;  // the rest is below a float's precision
constexpr double kTenths[] = {0,    1e-1, 1e-2,  1e-3,  1e-4,  1e-5,  1e-6,  1e-7,
                              1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15};

std::string_view take_digits(std::string_view& rest) {
  std::size_t count = 0;
  while (count < rest.size() && rest[count] >= '0' && rest[count] <= '9') ++count;
  const std::string_view digits = rest.substr(0, count);
  rest.remove_prefix(count);
  return digits;
}

std::uint64_t value_of(std::string_view digits) {
  std::uint64_t value = 0;
  for (const char digit : digits) value = value * 10 + std::uint64_t(digit - '0');
  return value;
}

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

bool parse_coordinate(std::string_view word, float& value) {
  double exact = 0;
  if (!parse_number(word, exact)) return false;
  const bool negative = word.front() == '-';
  if (negative || word.front() == '+') word.remove_prefix(1);
  const std::string_view whole = take_digits(word);
  value = float(exact);
  if (whole.size() > kMostDigits) return true;
  float sum = float(value_of(whole));
  if (!word.empty() && word.front() == '.') {
    word.remove_prefix(1);
    const std::string_view decimals = take_digits(word).substr(0, kMostDecimals);
    if (!decimals.empty()) sum += float(double(value_of(decimals)) * kTenths[decimals.size()]);
  }
  if (!word.empty()) {  // "e-5"
    word.remove_prefix(1);
    double exponent = 0;
    if (!parse_number(word, exponent)) return true;
    sum *= std::pow(10.0F, float(exponent));
  }
  if (std::isfinite(sum)) value = negative ? -sum : sum;
  return true;
}

}  // namespace hydrodip
