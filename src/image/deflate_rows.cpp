#include "image/deflate_rows.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>
#include <stdexcept>

#include "base/parallel.h"

namespace hydrodip {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Film images are large and mostly flat: a low level is nearly as small and several times faster.
constexpr int kLevel = 3;
// Of uncompressed rows, at least: much more than the 32 kB that deflate looks back, which every
// piece has to do without.
constexpr std::size_t kPieceBytes = std::size_t(1) << 19U;

struct Piece {
  Bytes compressed;
  uLong adler = 0;
  std::size_t size = 0;  // before
};

class Deflater {
 public:
  Deflater() {
    constexpr int kRawDeflate = -15, kMemory = 8;
    if (deflateInit2(&stream_, kLevel, Z_DEFLATED, kRawDeflate, kMemory, Z_DEFAULT_STRATEGY) !=
        Z_OK)
      throw std::bad_alloc();
  }
  ~Deflater() { deflateEnd(&stream_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  // Ends at a whole byte, so that another piece may follow, or where the stream ends.
  Bytes compress(const Bytes& bytes, bool is_last) {
    Bytes out(deflateBound(&stream_, uLong(bytes.size())) + 16);
    stream_.next_in = const_cast<Bytef*>(bytes.data());
    stream_.avail_in = uInt(bytes.size());
    stream_.next_out = out.data();
    stream_.avail_out = uInt(out.size());
    const int done = deflate(&stream_, is_last ? Z_FINISH : Z_SYNC_FLUSH);
    if (done != (is_last ? Z_STREAM_END : Z_OK) || stream_.avail_in != 0)
      throw std::runtime_error("a picture could not be compressed");
    out.resize(out.size() - stream_.avail_out);
    out.shrink_to_fit();
    return out;
  }

 private:
  z_stream stream_{};
};

}  // namespace

std::vector<std::vector<std::uint8_t>> deflate_rows(
    std::size_t rows, std::size_t row_bytes,
    const std::function<void(std::size_t row, std::uint8_t* out)>& fill) {
  const std::size_t rows_in_piece =
      std::max<std::size_t>(1, (kPieceBytes + row_bytes - 1) / std::max<std::size_t>(1, row_bytes));
  const std::size_t count = std::max<std::size_t>(1, (rows + rows_in_piece - 1) / rows_in_piece);
  std::vector<Piece> pieces(count);
  parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t first = n * rows_in_piece, last = std::min(rows, first + rows_in_piece);
      Bytes bytes((last - first) * row_bytes);
      for (std::size_t row = first; row < last; ++row) {
        check_cancelled();
        fill(row, bytes.data() + (row - first) * row_bytes);
      }
      pieces[n] = {Deflater().compress(bytes, n + 1 == count),
                   adler32(adler32(0, nullptr, 0), bytes.data(), uInt(bytes.size())), bytes.size()};
    }
  });

  constexpr std::array<std::uint8_t, 2> kHeader = {0x78, 0x5E};  // deflate, 32 kB, fast
  std::vector<Bytes> stream{{kHeader.begin(), kHeader.end()}};
  uLong adler = adler32(0, nullptr, 0);
  for (Piece& piece : pieces) {
    adler = adler32_combine(adler, piece.adler, z_off_t(piece.size));
    stream.push_back(std::move(piece.compressed));
  }
  for (const int shift : {24, 16, 8, 0}) stream.back().push_back(std::uint8_t(adler >> shift));
  return stream;
}

}  // namespace hydrodip
