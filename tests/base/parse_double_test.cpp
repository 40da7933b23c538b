#include "base/parse_double.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>

namespace hydrodip {
namespace {

// What this standard library's own std::from_chars says: an independent reader.
void expect_as_from_chars(const std::string& text) {
  double own = 17, other = 17;
  const char* const first = text.data();
  const char* const last = first + text.size();
  const std::from_chars_result expected = std::from_chars(first, last, own);
  const std::from_chars_result got = parse_double_by_strtod(first, last, other);
  EXPECT_EQ(got.ec, expected.ec) << text;
  EXPECT_EQ(got.ptr - first, expected.ptr - first) << text;
  if (std::isnan(own))
    EXPECT_TRUE(std::isnan(other)) << text;
  else
    EXPECT_EQ(std::memcmp(&own, &other, sizeof own), 0) << text;
}

TEST(ParseDouble, WithoutTheLibraryIsAsTheLibrarys) {
  for (const char* text : {"0",
                           "-0",
                           "1",
                           "-1.5",
                           ".5",
                           "5.",
                           "-.5",
                           ".",
                           "-",
                           "",
                           "+1",
                           " 1",
                           "1 ",
                           "1e5",
                           "1e",
                           "1e+",
                           "1e-7x",
                           "1E+02",
                           "0x10",
                           "inf",
                           "-INF",
                           "infinit",
                           "nan",
                           "nanx",
                           "1e999",
                           "-1e999",
                           "1e-999",
                           "4.9e-324",
                           "2.2250738585072011e-308",
                           "1.7976931348623157e308",
                           "0e999",
                           "0.0e-999",
                           "1,5",
                           "123456789012345678901234567890",
                           "e5",
                           "-e5",
                           "--1",
                           "1.2.3",
                           "1e5.5"})
    expect_as_from_chars(text);
}

TEST(ParseDouble, WithoutTheLibraryIsRoundedAsTheLibrarys) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    char text[64];
    std::snprintf(text, sizeof text, i % 2 == 0 ? "%.17g" : "%.25g", value);
    expect_as_from_chars(text);
  }
}

}  // namespace
}  // namespace hydrodip
