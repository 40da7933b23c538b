// Some of the pixels of an image, a bit each.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/blank_array.h"

namespace hydrodip {

// Where nothing is, it takes no memory.
class PixelSet {
 public:
  PixelSet() = default;
  PixelSet(int width_px, int height_px)  // none of them
      : words_per_row_((std::size_t(width_px) + kBits - 1) / kBits),
        words_(words_per_row_ * std::size_t(height_px)) {}

  bool contains(int x, int y) const { return (words_[word(x, y)] >> bit(x) & 1U) != 0; }
  // Different rows may be written to at the same time.
  void insert(int x, int y) { words_[word(x, y)] |= std::uint64_t(1) << bit(x); }

  std::size_t bytes() const { return words_.size() * sizeof(std::uint64_t); }

 private:
  static constexpr std::size_t kBits = 64;
  std::size_t word(int x, int y) const {
    return std::size_t(y) * words_per_row_ + std::size_t(x) / kBits;
  }
  static std::size_t bit(int x) { return std::size_t(x) % kBits; }

  std::size_t words_per_row_ = 0;
  BlankArray<std::uint64_t> words_;
};

}  // namespace hydrodip
