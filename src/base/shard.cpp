#include "base/shard.h"

#include <fmt/format.h>

#include <charconv>

#include "base/error.h"

namespace hydrodip {

Shard parse_shard(const std::string& text) {
  constexpr int kMost = 100000;
  Shard shard;
  if (text.empty()) return shard;
  const char* end = text.data() + text.size();
  const auto [slash, first] = std::from_chars(text.data(), end, shard.number);
  if (first == std::errc() && slash != end && *slash == '/') {
    const auto [rest, second] = std::from_chars(slash + 1, end, shard.of);
    if (second == std::errc() && rest == end && shard.number >= 1 && shard.number <= shard.of &&
        shard.of <= kMost)
      return shard;
  }
  throw InputError(
      fmt::format("--shard '{}': give the part and the number of parts, as in 2/4", text));
}

}  // namespace hydrodip
