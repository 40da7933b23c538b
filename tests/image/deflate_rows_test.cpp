#include "image/deflate_rows.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "base/parallel.h"

namespace hydrodip {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::uint8_t byte_of(std::size_t row, std::size_t column) {
  return std::uint8_t(row % 50 < 30 ? 0 : (row * 31 + column * column) >> 3U);
}

Bytes stream_of(std::size_t rows, std::size_t row_bytes) {
  Bytes stream;
  for (const Bytes& piece : deflate_rows(rows, row_bytes, [&](std::size_t row, std::uint8_t*out) {
         for (std::size_t i = 0; i < row_bytes; ++i) out[i] = byte_of(row, i);
       }))
    stream.insert(stream.end(), piece.begin(), piece.end());
  return stream;
}

// zlib reads it as one stream, and finds its checksum right.
TEST(DeflateRows, ComesBackFromZlib) {
  for (const auto& [rows, row_bytes] :
       {std::pair<std::size_t, std::size_t>{1, 1}, {1, 700000}, {3000, 1000}, {700, 3001}}) {
    const Bytes stream = stream_of(rows, row_bytes);
    Bytes back(rows * row_bytes + 1);
    uLongf size = back.size();
    ASSERT_EQ(uncompress(back.data(), &size, stream.data(), stream.size()), Z_OK);
    ASSERT_EQ(size, rows * row_bytes);
    for (std::size_t i = 0; i < size; ++i)
      ASSERT_EQ(back[i], byte_of(i / row_bytes, i % row_bytes)) << i;
  }
}

TEST(DeflateRows, ThreadsDoNotChangeAByte) {
  const Bytes many = stream_of(3000, 2000);
  const ThreadLimit one(1);
  EXPECT_EQ(stream_of(3000, 2000), many);
}

}  // namespace
}  // namespace hydrodip
