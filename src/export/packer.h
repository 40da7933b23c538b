// Arrays of whole numbers for a web page: differences, byte planes, deflate, base64. Neighbouring
// values are alike, so that little is left of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hydrodip {

class Packer {
 public:
  // Where the array lies, for the page's reader (viewer/scene.js): byte offset, count, bytes per
  // value, and the distance back to the value that was subtracted.
  struct Place {
    std::size_t offset = 0, count = 0, bytes = 1, delta = 1;
  };

  Place add(const std::vector<std::uint8_t>& values, std::size_t delta = 1);
  Place add(const std::vector<std::uint16_t>& values, std::size_t delta = 1);
  Place add(const std::vector<std::uint32_t>& values, std::size_t delta = 1);

  // Everything added so far, deflated (zlib format), in base64.
  std::string finish() const;

 private:
  template <class Value>
  Place add_planes(const std::vector<Value>& values, std::size_t delta);

  std::vector<std::uint8_t> data_;
};

std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace hydrodip
