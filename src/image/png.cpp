// The only place that knows libpng. It reports errors by longjmp: what crosses that lives here,
// outside the frames it unwinds.
#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>
#include <span>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/math.h"
#include "base/run_scope.h"
#include "image/decoders.h"
#include "image/deflate_rows.h"
#include "image/files.h"
#include "image/picture_file.h"

namespace hydrodip {

namespace {

using Bytes = PictureBytes;

constexpr png_uint_32 kMaxSidePx = 1u << 15;  // check_picture_size says so first
constexpr std::uint8_t kPngSignature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kMessageSize = 256;

std::uint32_t big_endian32(const std::uint8_t* p) {
  return std::uint32_t(p[0]) << 24 | std::uint32_t(p[1]) << 16 | std::uint32_t(p[2]) << 8 | p[3];
}

// ---- reading ----

struct PngSource {
  const Bytes* bytes = nullptr;
  std::size_t offset = 0;
  char message[kMessageSize] = {};
};

extern "C" {

static void png_read_from_memory(png_structp png, png_bytep out, png_size_t count) {
  auto* source = static_cast<PngSource*>(png_get_io_ptr(png));
  if (count > source->bytes->size() - source->offset) png_error(png, "unexpected end of file");
  std::memcpy(out, source->bytes->data() + source->offset, count);
  source->offset += count;
}

static void png_keep_error(png_structp png, png_const_charp message) {
  auto* text = static_cast<char*>(png_get_error_ptr(png));
  std::snprintf(text, kMessageSize, "%s", message);
  png_longjmp(png, 1);
}

static void png_ignore_warning(png_structp, png_const_charp) {}

static void png_append(png_structp png, png_bytep data, png_size_t count) {
  auto* out = static_cast<Bytes*>(png_get_io_ptr(png));
  try {
    out->insert(out->end(), data, data + count);
  } catch (const std::bad_alloc&) {
    png_error(png, "out of memory");
  }
}

static void png_no_flush(png_structp) {}

}  // extern "C"

// Everything becomes 8-bit RGBA; sample values are taken as sRGB, whatever gamma the file states.
bool png_decode_rows(png_structp png, png_infop info, Image& image) {
  if (setjmp(png_jmpbuf(png))) return false;
  const int passes = png_set_interlace_handling(png);
  for (int pass = 0; pass < passes; ++pass)
    for (int y = 0; y < image.height_px; ++y) {
      check_cancelled();
      png_read_row(png, image.pixel(0, y), nullptr);
    }
  png_read_end(png, info);
  return true;
}

bool png_read_header(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_info(png, info);
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  return true;
}

struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  explicit PngReader(PngSource& source) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, source.message, png_keep_error,
                                 png_ignore_warning);
    if (!png) throw std::bad_alloc();
    info = png_create_info_struct(png);
    png_set_read_fn(png, &source, png_read_from_memory);
    // Text and the like are of no use here, and are where decompression bombs hide; profiles are
    // read by read_png_colors.
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER,
                                reinterpret_cast<png_const_bytep>("iCCP"), 1);
    png_set_chunk_malloc_max(png, 1 << 22);
    png_set_user_limits(png, kMaxSidePx, kMaxSidePx);
  }
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
};

// Calls visit(type, data) for a PNG's chunks, as far as they are whole, until it returns false.
template <typename Visit>
void for_each_chunk(const Bytes& bytes, Visit visit) {
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::size_t length = big_endian32(&bytes[at]);
    if (length > bytes.size() - at - 12) return;
    const std::string_view type(reinterpret_cast<const char*>(&bytes[at + 4]), 4);
    if (!visit(type, std::span(bytes).subspan(at + 8, length))) return;
    at += length + 12;
  }
}

// The profile of an iCCP chunk: behind its name and a zero that stands for deflate. Empty if it is
// damaged, or larger than any.
Bytes png_profile(std::span<const std::uint8_t> chunk) {
  constexpr std::size_t kLongestName = 79, kLargest = std::size_t(1) << 25;
  const auto end = std::find(chunk.begin(), chunk.end(), std::uint8_t(0));
  const auto name = std::size_t(end - chunk.begin());
  if (name > kLongestName || chunk.size() < name + 2 || chunk[name + 1] != 0) return {};
  const std::span packed = chunk.subspan(name + 2);
  Bytes profile;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  stream.next_in = const_cast<Bytef*>(packed.data());
  stream.avail_in = uInt(packed.size());
  int status = Z_OK;
  while (status == Z_OK && profile.size() < kLargest) {
    constexpr std::size_t kPiece = std::size_t(1) << 16;
    const std::size_t had = profile.size();
    profile.resize(had + kPiece);
    stream.next_out = profile.data() + had;
    stream.avail_out = uInt(kPiece);
    status = inflate(&stream, Z_NO_FLUSH);
    profile.resize(profile.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  return status == Z_STREAM_END ? profile : Bytes();
}

// A profile counts whether or not the file calls itself sRGB too: libpng would take the first.
void read_png_colors(const Bytes& bytes, StoredPicture& picture) {
  for_each_chunk(bytes, [&](std::string_view type, std::span<const std::uint8_t> data) {
    if (type == "cICP" && data.size() == 4) picture.cicp = {data[0], data[1], data[2], data[3]};
    if (type == "eXIf") picture.orientation = exif_orientation(data);
    if (type == "acTL") picture.has_more = true;  // animated
    if (type == "iCCP") {
      picture.profile = png_profile(data);
      picture.profile_lost = picture.profile.empty();
    }
    return true;
  });
}

// pHYs counts whole pixels per metre: 300 dpi is stored as 299.9994.
double dpi_of(double per_m) {
  const double dpi = per_m * kMmPerInch / 1000;
  const double whole = std::round(dpi);
  return std::round(whole * 1000 / kMmPerInch) == per_m ? whole : dpi;
}

// ---- writing ----

bool opaque(const Image& image) {
  CheckEvery check(1 << 16);
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    check();
    if (image.rgba[i] != 255) return false;
  }
  return true;
}

struct PngWriter {
  png_structp png = nullptr;
  png_infop info = nullptr;
  explicit PngWriter(char* message) {
    png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, message, png_keep_error, png_ignore_warning);
    if (!png) throw std::bad_alloc();
    info = png_create_info_struct(png);
    if (!info) {
      png_destroy_write_struct(&png, &info);
      throw std::bad_alloc();
    }
  }
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
};

// A row's pixels, from the right if mirrored: then in `turned`.
const std::uint8_t* row_of(const Image& image, int y, bool mirrored, Bytes& turned) {
  const std::uint8_t* row = image.pixel(0, y);
  if (!mirrored) return row;
  const std::size_t width = std::size_t(image.width_px);
  turned.resize(4 * width);
  for (std::size_t x = 0; x < width; ++x)
    std::copy_n(row + 4 * (width - 1 - x), 4, turned.data() + 4 * x);
  return turned.data();
}

// Of so many of each pixel's four channels.
void store_differences(const std::uint8_t* here, const std::uint8_t* above, std::size_t width,
                       std::size_t channels, std::uint8_t* out) {
  if (channels == 4) {
    for (std::size_t i = 0; i < 4 * width; ++i) out[i] = std::uint8_t(here[i] - above[i]);
    return;
  }
  for (std::size_t x = 0; x < width; ++x, here += 4, above += 4)
    for (std::size_t k = 0; k < channels; ++k) *out++ = std::uint8_t(here[k] - above[k]);
}

// Each row begins with its filter's number and holds differences to the row above.
std::vector<Bytes> png_rows(const Image& image, bool mirrored, bool drop_alpha) {
  constexpr std::uint8_t kUp = 2;
  const std::size_t channels = drop_alpha ? 3 : 4, width = std::size_t(image.width_px);
  return deflate_rows(
      std::size_t(image.height_px), 1 + channels * width, [&](std::size_t y, std::uint8_t* out) {
        *out++ = kUp;
        Bytes turned, turned_above;
        const std::uint8_t* here = row_of(image, int(y), mirrored, turned);
        if (y == 0) turned_above.assign(4 * width, 0);
        const std::uint8_t* above =
            y == 0 ? turned_above.data() : row_of(image, int(y) - 1, mirrored, turned_above);
        store_differences(here, above, width, channels, out);
      });
}

bool png_encode(PngWriter& writer, const Image& image, bool drop_alpha, double dpi,
                std::vector<Bytes>& rows, Bytes& out) {
  png_structp png = writer.png;
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, &out, png_append, png_no_flush);
  png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
  png_set_IHDR(png, writer.info, png_uint_32(image.width_px), png_uint_32(image.height_px), 8,
               drop_alpha ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, writer.info, PNG_sRGB_INTENT_RELATIVE);
  if (dpi > 0) {
    const auto per_m = png_uint_32(std::lround(dpi * 1000 / kMmPerInch));
    png_set_pHYs(png, writer.info, per_m, per_m, PNG_RESOLUTION_METER);
  }
  png_write_info(png, writer.info);
  for (Bytes& piece : rows) {
    png_write_chunk(png, reinterpret_cast<png_const_bytep>("IDAT"), piece.data(), piece.size());
    Bytes().swap(piece);  // all of them may be large
  }
  png_write_chunk(png, reinterpret_cast<png_const_bytep>("IEND"), nullptr, 0);
  return true;
}

}  // namespace

bool is_png(const Bytes& bytes) {
  return bytes.size() >= 8 && std::memcmp(bytes.data(), kPngSignature, 8) == 0;
}

StoredPicture decode_png(const Bytes& bytes, const std::string& name) {
  if (bytes.size() < 33 || std::memcmp(bytes.data() + 12, "IHDR", 4) != 0) {
    refuse_picture(name, "PNG", "it has no header");
  }
  const std::uint32_t width = big_endian32(bytes.data() + 16);
  const std::uint32_t height = big_endian32(bytes.data() + 20);
  // Deflate shrinks at most 1032 to 1, and a pixel has at least one bit.
  check_picture_size(name, "PNG", width, height, double(width) * height / 8 / 1040, bytes.size());
  PngSource source{&bytes, 0, {}};
  PngReader reader(source);
  if (!reader.info || !png_read_header(reader.png, reader.info)) {
    refuse_picture(name, "PNG", source.message);
  }
  if (png_get_rowbytes(reader.png, reader.info) != std::size_t(4) * width) {
    refuse_picture(name, "PNG", "unusual pixel layout");
  }
  StoredPicture picture;
  picture.image = Image(int(width), int(height));
  if (!png_decode_rows(reader.png, reader.info, picture.image))
    refuse_picture(name, "PNG", source.message);
  read_png_colors(bytes, picture);
  return picture;
}

bool png_says_more(const Bytes& bytes) {
  bool more = false;
  for_each_chunk(bytes, [&](std::string_view type, std::span<const std::uint8_t> data) {
    more = type == "iCCP" || type == "cICP" || (type == "eXIf" && exif_orientation(data) != 1);
    return !more;
  });
  return more;
}

Resolution png_resolution(const Bytes& bytes) {
  Resolution found;
  for_each_chunk(bytes, [&](std::string_view type, std::span<const std::uint8_t> data) {
    if (type == "IDAT") return false;
    if (type != "pHYs" || data.size() != 9) return true;
    if (data[8] == 1)  // else only an aspect ratio
      found = {dpi_of(big_endian32(data.data())), dpi_of(big_endian32(data.data() + 4))};
    return false;
  });
  return found;
}

Bytes encode_png(const Image& image, double dpi, bool mirrored) {
  if (image.width_px <= 0 || image.height_px <= 0) {
    throw InputError("An image without pixels cannot be written as PNG.");
  }
  const bool drop_alpha = opaque(image);
  std::vector<Bytes> rows = png_rows(image, mirrored, drop_alpha);
  Bytes out;
  char message[kMessageSize] = {};
  PngWriter writer(message);
  if (!png_encode(writer, image, drop_alpha, dpi, rows, out)) {
    throw InputError(fmt::format("The image could not be written as PNG: {}.", message));
  }
  return out;
}

}  // namespace hydrodip
