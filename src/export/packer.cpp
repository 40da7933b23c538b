#include "export/packer.h"

#include <zlib.h>

#include <algorithm>
#include <memory>
#include <new>
#include <stdexcept>

#include "base/run_scope.h"

namespace hydrodip {

template <class Value>
Packer::Place Packer::add_planes(const std::vector<Value>& values, std::size_t delta) {
  const Place place{data_.size(), values.size(), sizeof(Value), delta};
  data_.resize(data_.size() + sizeof(Value) * values.size());
  CheckEvery check(1 << 16);
  for (std::size_t i = 0; i < values.size(); ++i) {
    check();
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
  constexpr std::size_t kPiece = std::size_t(1) << 18;  // some milliseconds
  std::vector<std::uint8_t> packed(compressBound(uLong(data_.size())));
  z_stream stream{};
  if (deflateInit(&stream, 6) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, deflateEnd);
  stream.next_out = packed.data();
  int result = Z_OK;
  for (std::size_t begin = 0; result == Z_OK; begin += kPiece) {
    check_cancelled();
    const std::size_t count = std::min(kPiece, data_.size() - begin);
    stream.next_in = const_cast<std::uint8_t*>(data_.data() + begin);  // zlib's, which reads it
    stream.avail_in = uInt(count);
    // Never more than 4 GB at once.
    stream.avail_out = uInt(std::min<std::size_t>(packed.size() - stream.total_out, 1U << 31));
    result = deflate(&stream, begin + count == data_.size() ? Z_FINISH : Z_NO_FLUSH);
  }
  if (result != Z_STREAM_END)
    throw std::runtime_error("zlib could not compress the report's scene");
  packed.resize(stream.total_out);
  return base64(packed);
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  CheckEvery check(1 << 16);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    check();
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
