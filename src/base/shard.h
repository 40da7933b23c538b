// One of N equal parts of much independent work.
#pragma once

#include <cstddef>
#include <string>

namespace hydrodip {

// Of tasks counted from 0 it has those that leave the rest `number` - 1 when divided by `of`.
struct Shard {
  int number = 1, of = 1;

  bool has(std::size_t task) const { return int(task % std::size_t(of)) == number - 1; }
};

// "3/8" as given to --shard; all of it if empty. Throws InputError.
Shard parse_shard(const std::string& text);

}  // namespace hydrodip
