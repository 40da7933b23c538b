// Little-endian bytes of a binary file, the same on every machine.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace hydrodip {

class Bytes {
 public:
  void add_u8(std::uint8_t value) { data_.push_back(value); }
  void add_u32(std::uint32_t value) {
    data_.insert(data_.end(), {std::uint8_t(value), std::uint8_t(value >> 8U),
                               std::uint8_t(value >> 16U), std::uint8_t(value >> 24U)});
  }
  void add_f32(float value) { add_u32(std::bit_cast<std::uint32_t>(value)); }
  void add(const std::string& text) { data_.insert(data_.end(), text.begin(), text.end()); }
  void add(const std::vector<std::uint8_t>& bytes) {
    data_.insert(data_.end(), bytes.begin(), bytes.end());
  }
  // Fills up to a multiple of four.
  void pad(std::uint8_t filler) {
    while (data_.size() % 4 != 0) add_u8(filler);
  }
  std::size_t size() const { return data_.size(); }
  const std::vector<std::uint8_t>& data() const { return data_; }

 private:
  std::vector<std::uint8_t> data_;
};

}  // namespace hydrodip
