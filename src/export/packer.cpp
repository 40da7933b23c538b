#include "export/packer.h"

#include <zlib.h>

#include <stdexcept>

namespace hydrodip {

template <class Value>
Packer::Place Packer::add_planes(const std::vector<Value>& values, std::size_t delta) {
  const Place place{data_.size(), values.size(), sizeof(Value), delta};
  data_.resize(data_.size() + sizeof(Value) * values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto difference = Value(values[i] - (i < delta ? Value(0) : values[i - delta]));
    for (std::size_t plane = 0; plane < sizeof(Value); ++plane) {
      data_[place.offset + plane * values.size() + i] = std::uint8_t(difference >> (8 * plane));
    }
  }
  return place;
}

Packer::Place Packer::add(const std::vector<std::uint8_t>& values, std::size_t delta) {
  return add_planes(values, delta);
}

Packer::Place Packer::add(const std::vector<std::uint16_t>& values, std::size_t delta) {
  return add_planes(values, delta);
}

Packer::Place Packer::add(const std::vector<std::uint32_t>& values, std::size_t delta) {
  return add_planes(values, delta);
}

std::string Packer::finish() const {
  uLongf size = compressBound(uLong(data_.size()));
  std::vector<std::uint8_t> packed(size);
  if (compress2(packed.data(), &size, data_.data(), uLong(data_.size()), 6) != Z_OK) {
    throw std::runtime_error("zlib could not compress the report's scene");
  }
  packed.resize(size);
  return base64(packed);
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

}  // namespace hydrodip
