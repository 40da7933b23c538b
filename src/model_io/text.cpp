#include "model_io/text.h"

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

}  // namespace

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
