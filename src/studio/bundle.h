// A binary answer: JSON, and arrays that a page can use as they lie. docs/studio-api.md.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "studio/json.h"

namespace hydrodip {

class Bundle {
 public:
  explicit Bundle(Json head) : head_(std::move(head)) { head_["arrays"] = Json::object(); }

  void add(const std::string& name, std::span<const float> values, std::size_t width);
  void add(const std::string& name, std::span<const std::uint32_t> values, std::size_t width);
  void add(const std::string& name, std::span<const std::uint8_t> values, std::size_t width);
  void add(const std::string& name, std::span<const std::int8_t> values, std::size_t width);

  std::vector<std::uint8_t> finish() const;

 private:
  template <class Value>
  void add_as(const char* type, const std::string& name, std::span<const Value> values,
              std::size_t width);

  Json head_;
  std::vector<std::uint8_t> data_;
};

}  // namespace hydrodip
