#include "studio/bundle.h"

#include <bit>
#include <cstring>

namespace hydrodip {

static_assert(std::endian::native == std::endian::little, "arrays are sent as they lie");

template <class Value>
void Bundle::add_as(const char* type, const std::string& name, std::span<const Value> values,
                    std::size_t width) {
  constexpr std::size_t kAlign = 8;
  head_["arrays"][name] = {
      {"type", type}, {"width", width}, {"count", values.size() / width}, {"offset", data_.size()}};
  const std::size_t bytes = values.size() * sizeof(Value), at = data_.size();
  data_.resize(at + (bytes + kAlign - 1) / kAlign * kAlign);
  if (bytes > 0) std::memcpy(data_.data() + at, values.data(), bytes);
}

void Bundle::add(const std::string& name, std::span<const float> values, std::size_t width) {
  add_as("f32", name, values, width);
}
void Bundle::add(const std::string& name, std::span<const std::uint32_t> values,
                 std::size_t width) {
  add_as("u32", name, values, width);
}
void Bundle::add(const std::string& name, std::span<const std::uint8_t> values, std::size_t width) {
  add_as("u8", name, values, width);
}
void Bundle::add(const std::string& name, std::span<const std::int8_t> values, std::size_t width) {
  add_as("i8", name, values, width);
}

std::vector<std::uint8_t> Bundle::finish() const {
  std::string head = text_of(head_);
  while (head.size() % 8 != 0) head += ' ';
  const auto length = std::uint32_t(head.size());
  std::vector<std::uint8_t> bytes = {'H', 'D', 'B', '1'};
  for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(std::uint8_t(length >> shift));
  bytes.reserve(bytes.size() + head.size() + data_.size());
  bytes.insert(bytes.end(), head.begin(), head.end());
  bytes.insert(bytes.end(), data_.begin(), data_.end());
  return bytes;
}

}  // namespace hydrodip
