#include "image/image.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hydrodip {

namespace {

double decode(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double encode(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::array<float, 256> make_decode_table() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) table[std::size_t(i)] = float(decode(i / 255.0));
  return table;
}

// The way back without a power per pixel: a table gives the byte at the cell's lower end, and the
// threshold half-way to the next byte, of which no cell holds two, settles the rest.
struct EncodeTable {
  static constexpr int kCells = 4096;
  std::array<std::uint8_t, kCells + 1> first{};
  // The smallest linear value that rounds to this byte; none does to 256.
  std::array<float, 257> lower{};

  EncodeTable() {
    for (int i = 1; i < 256; ++i) lower[std::size_t(i)] = float(decode((i - 0.5) / 255.0));
    lower[256] = std::numeric_limits<float>::infinity();
    for (int c = 0; c <= kCells; ++c) {
      const float value = float(c) / float(kCells);
      const auto next = std::upper_bound(lower.begin() + 1, lower.end() - 1, value);
      first[std::size_t(c)] = std::uint8_t(next - lower.begin() - 1);
    }
  }
};

}  // namespace

float srgb_to_linear(float encoded) { return float(decode(encoded)); }

float linear_to_srgb(float linear) { return float(encode(linear)); }

const std::array<float, 256>& srgb8_table() {
  static const std::array<float, 256> table = make_decode_table();
  return table;
}

float srgb8_to_linear(std::uint8_t encoded) { return srgb8_table()[encoded]; }

std::uint8_t linear_to_srgb8(float linear) {
  static const EncodeTable table;
  if (!(linear > 0)) return 0;  // also not-a-number
  if (linear >= 1) return 255;
  const std::uint8_t byte = table.first[std::size_t(linear * float(EncodeTable::kCells))];
  return std::uint8_t(byte + (linear >= table.lower[byte + 1U] ? 1 : 0));
}

}  // namespace hydrodip
