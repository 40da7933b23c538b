// One zlib stream of a picture's rows, which several threads compress.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace hydrodip {

// The stream in pieces, to be written one after the other: the same bytes with any number of
// threads. `fill(row, out)` writes a row's `row_bytes` bytes, on any thread. Throws Cancelled, and
// what `fill` throws.
std::vector<std::vector<std::uint8_t>> deflate_rows(
    std::size_t rows, std::size_t row_bytes,
    const std::function<void(std::size_t row, std::uint8_t* out)>& fill);

}  // namespace hydrodip
