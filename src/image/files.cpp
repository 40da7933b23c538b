#include "image/files.h"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

// jpeglib.h needs size_t and FILE first, jerror.h what jpeglib.h defines: its numbers hang on that.
#include <cstdio>

#include <jpeglib.h>

#include <jerror.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <span>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/math.h"
#include "base/run_scope.h"
#include "image/decoders.h"
#include "image/deflate_rows.h"
#include "image/picture_file.h"

namespace hydrodip {

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr png_uint_32 kMaxSidePx = 1u << 15;  // check_picture_size says so first
constexpr std::uint8_t kPngSignature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kMessageSize = 256;

bool is_png(const Bytes& bytes) {
  return bytes.size() >= 8 && std::memcmp(bytes.data(), kPngSignature, 8) == 0;
}

bool is_jpeg(const Bytes& bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

std::uint32_t big_endian32(const std::uint8_t* p) {
  return std::uint32_t(p[0]) << 24 | std::uint32_t(p[1]) << 16 | std::uint32_t(p[2]) << 8 | p[3];
}

// ---- PNG ----------------------------------------------------------------------------------------

// libpng reports errors by longjmp: what crosses it lives here, outside the frames it unwinds.
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
    if (type == "iCCP") {
      picture.profile = png_profile(data);
      picture.profile_lost = picture.profile.empty();
    }
    return true;
  });
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

// pHYs counts whole pixels per metre: 300 dpi is stored as 299.9994.
double dpi_of(double per_m) {
  const double dpi = per_m * kMmPerInch / 1000;
  const double whole = std::round(dpi);
  return std::round(whole * 1000 / kMmPerInch) == per_m ? whole : dpi;
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

// Each row begins with its filter's number and holds differences to the row above.
std::vector<Bytes> png_rows(const Image& image, bool mirrored, bool drop_alpha) {
  constexpr std::uint8_t kUp = 2;
  const std::size_t channels = drop_alpha ? 3 : 4, width = std::size_t(image.width_px);
  return deflate_rows(std::size_t(image.height_px), 1 + channels * width,
                      [&](std::size_t y, std::uint8_t* out) {
                        *out++ = kUp;
                        Bytes turned, turned_above;
                        const std::uint8_t* here = row_of(image, int(y), mirrored, turned);
                        const std::uint8_t* above =
                            y > 0 ? row_of(image, int(y) - 1, mirrored, turned_above) : nullptr;
                        for (std::size_t x = 0; x < width; ++x)
                          for (std::size_t k = 0; k < channels; ++k)
                            *out++ = std::uint8_t(here[4 * x + k] - (above ? above[4 * x + k] : 0));
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

// ---- JPEG ---------------------------------------------------------------------------------------

// For what C calls, through which nothing may be thrown.
bool is_cancelled() {
  try {
    check_cancelled();
    return false;
  } catch (const Cancelled&) {
    return true;
  }
}

struct JpegErrors {
  jpeg_error_mgr manager;  // first: libjpeg hands back a pointer to it
  std::jmp_buf jump;
  char message[JMSG_LENGTH_MAX];
  bool truncated, damaged, bad_profile;
  jpeg_progress_mgr progress;
};

extern "C" {

static void jpeg_keep_error(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  errors->manager.format_message(info, errors->message);
  std::longjmp(errors->jump, 1);
}

// Pictures in several scans are read as a whole before their first row comes.
// A scan of a few bytes costs as much time as a whole one: very many are made to hang a reader.
static void jpeg_watch(j_common_ptr info) {
  constexpr int kMostScans = 200;
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number > kMostScans) {
    std::snprintf(errors->message, sizeof errors->message, "it comes in more than %d scans",
                  kMostScans);
    std::longjmp(errors->jump, 1);
  }
  if (is_cancelled()) std::longjmp(errors->jump, 1);
}

static void jpeg_note_warning(j_common_ptr info, int level) {
  if (level >= 0) return;
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  switch (errors->manager.msg_code) {
    case JWRN_JPEG_EOF:
    case JWRN_HIT_MARKER:
      errors->truncated = true;
      break;
    case JWRN_BOGUS_ICC:
      errors->bad_profile = true;
      break;
    case JWRN_ADOBE_XFORM:
    case JWRN_JFIF_MAJOR:
    case JWRN_NOT_SEQUENTIAL:
    case JWRN_TOO_MUCH_DATA:
      break;  // nothing that changes a pixel
    default:
      errors->damaged = true;
  }
}

}  // extern "C"

constexpr int kExifMarker = JPEG_APP0 + 1, kProfileMarker = JPEG_APP0 + 2;

struct JpegReader {
  jpeg_decompress_struct info{};
  JpegErrors errors{};
  explicit JpegReader(const Bytes& bytes) {
    info.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = jpeg_keep_error;
    errors.manager.emit_message = jpeg_note_warning;
    jpeg_create_decompress(&info);
    errors.progress.progress_monitor = jpeg_watch;
    info.progress = &errors.progress;
    jpeg_mem_src(&info, bytes.data(), static_cast<unsigned long>(bytes.size()));
  }
  ~JpegReader() { jpeg_destroy_decompress(&info); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  bool read_header() {
    if (setjmp(errors.jump)) return false;
    jpeg_save_markers(&info, kExifMarker, 0xffff);
    jpeg_save_markers(&info, kProfileMarker, 0xffff);
    jpeg_read_header(&info, TRUE);
    const bool four_inks = info.jpeg_color_space == JCS_CMYK || info.jpeg_color_space == JCS_YCCK;
    info.out_color_space = four_inks ? JCS_CMYK : JCS_RGB;
    return true;
  }

  // Its ICC profile, to be freed.
  bool read_profile(JOCTET** profile, unsigned* size) {
    if (setjmp(errors.jump)) return false;
    return jpeg_read_icc_profile(&info, profile, size) != 0;
  }

  // Press files hold CMYK.
  bool has_inks() const { return info.out_color_space == JCS_CMYK; }

  // row: scratch space for one row of up to four channels.
  bool read_rows(Image& image, std::uint8_t* row);
};

bool JpegReader::read_rows(Image& image, std::uint8_t* row) {
  if (setjmp(errors.jump)) return false;
  jpeg_start_decompress(&info);
  const bool inks = has_inks();
  while (info.output_scanline < info.output_height) {
    check_cancelled();
    std::uint8_t* out = image.pixel(0, int(info.output_scanline));
    jpeg_read_scanlines(&info, &row, 1);
    const std::uint8_t* in = row;
    for (int x = 0; x < image.width_px; ++x, out += 4, in += inks ? 4 : 3) {
      if (inks) {
        // Adobe's are inverted.
        for (int c = 0; c < 4; ++c)
          out[c] = std::uint8_t(info.saw_Adobe_marker ? 255 - in[c] : in[c]);
      } else {
        std::copy_n(in, 3, out);
        out[3] = 255;
      }
    }
  }
  jpeg_finish_decompress(&info);
  return true;
}

void read_jpeg_colors(JpegReader& reader, StoredPicture& picture) {
  for (const auto* marker = reader.info.marker_list; marker; marker = marker->next) {
    const std::span data(marker->data, marker->data_length);
    if (marker->marker == kExifMarker && data.size() > 6 &&
        std::memcmp(data.data(), "Exif\0", 6) == 0)
      picture.orientation = exif_orientation(data.subspan(6));
  }
  if (reader.has_inks()) picture.stored = Stored::kInks;
  JOCTET* data = nullptr;
  unsigned size = 0;
  if (!reader.read_profile(&data, &size)) {
    picture.profile_lost = reader.errors.bad_profile;
    return;
  }
  Bytes profile(data, data + size);
  std::free(data);
  if (reader.has_inks())
    take_ink_profile(picture, std::move(profile));
  else
    picture.profile = std::move(profile);
}

StoredPicture decode_jpeg(const Bytes& bytes, const std::string& name) {
  JpegReader reader(bytes);
  if (!reader.read_header()) refuse_picture(name, "JPEG", reader.errors.message);
  const std::uint32_t width = reader.info.image_width;
  const std::uint32_t height = reader.info.image_height;
  // A block of 64 pixels takes about a bit at the least.
  check_picture_size(name, "JPEG", width, height, double(width) * height / 1024, bytes.size());
  StoredPicture picture;
  picture.image = Image(int(width), int(height));
  std::vector<std::uint8_t> row(std::size_t(4) * width);
  read_jpeg_colors(reader, picture);
  if (!reader.read_rows(picture.image, row.data())) {
    check_cancelled();
    refuse_picture(name, "JPEG", reader.errors.message);
  }
  if (reader.errors.truncated) refuse_picture(name, "JPEG", "it ends too early");
  picture.damaged = reader.errors.damaged;
  return picture;
}

struct JpegWriter {
  jpeg_compress_struct info{};
  JpegErrors errors{};
  unsigned char* data = nullptr;  // grown by libjpeg with malloc
  unsigned long size = 0;
  JpegWriter() {
    info.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = jpeg_keep_error;
    errors.manager.emit_message = jpeg_note_warning;
    jpeg_create_compress(&info);
    jpeg_mem_dest(&info, &data, &size);
  }
  ~JpegWriter() {
    // The memory moves as it grows, which libjpeg says only here.
    info.dest->term_destination(&info);
    jpeg_destroy_compress(&info);
    std::free(data);
  }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  // row: scratch space for one row of three channels.
  bool write(const Image& image, int quality, std::uint8_t* row) {
    if (setjmp(errors.jump)) return false;
    info.image_width = JDIMENSION(image.width_px);
    info.image_height = JDIMENSION(image.height_px);
    info.input_components = 3;
    info.in_color_space = JCS_RGB;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, quality, TRUE);
    jpeg_start_compress(&info, TRUE);
    while (info.next_scanline < info.image_height) {
      check_cancelled();
      const std::uint8_t* in = image.pixel(0, int(info.next_scanline));
      for (int x = 0; x < image.width_px; ++x) std::copy_n(in + 4 * x, 3, row + 3 * x);
      jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    return true;
  }
};

// What EXIF data have before them in a JPEG.
constexpr std::string_view kExifMark("Exif\0\0", 6);

// Without unpacking anything. JFIF's goes before EXIF's.
Resolution jpeg_resolution(const Bytes& bytes) {
  constexpr std::string_view kJfif("JFIF\0", 5);
  Resolution found;
  for (std::size_t at = 2; at + 4 <= bytes.size() && bytes[at] == 0xff;) {
    const int marker = bytes[at + 1];
    const std::size_t length = std::size_t(bytes[at + 2]) << 8 | bytes[at + 3];
    if (marker < JPEG_APP0 || marker > kProfileMarker || length < 2 ||
        length > bytes.size() - at - 2)
      break;
    const auto data = std::span(bytes).subspan(at + 4, length - 2);
    const auto is = [&](std::string_view mark) {
      return data.size() >= mark.size() && std::memcmp(data.data(), mark.data(), mark.size()) == 0;
    };
    if (is(kJfif) && data.size() >= 12 && (data[7] == 1 || data[7] == 2)) {
      const double per_unit = data[7] == 2 ? kMmPerInch / 10 : 1;
      return {(data[8] * 256 + data[9]) * per_unit, (data[10] * 256 + data[11]) * per_unit};
    }
    if (is(kExifMark)) found = exif_resolution(data.subspan(kExifMark.size()));
    at += 2 + length;
  }
  return found;
}

}  // namespace

namespace {

bool begins(const Bytes& bytes, std::string_view mark, std::size_t at = 0) {
  return bytes.size() >= at + mark.size() && std::memcmp(&bytes[at], mark.data(), mark.size()) == 0;
}

bool is_tiff(const Bytes& bytes) {
  return begins(bytes, std::string_view("II*\0", 4)) ||
         begins(bytes, std::string_view("MM\0*", 4)) ||
         begins(bytes, std::string_view("II+\0", 4)) || begins(bytes, std::string_view("MM\0+", 4));
}

// Kinds that people have and that are not read.
const char* foreign_kind(const Bytes& bytes) {
  if (begins(bytes, "8BPS")) return "a Photoshop file";
  if (begins(bytes, "\xabKTX 20")) return "a KTX2 (Basis Universal) texture";
  if (begins(bytes, "DDS ")) return "a DDS texture";
  if (begins(bytes, "ftypheic", 4) || begins(bytes, "ftypmif1", 4)) return "a HEIC picture";
  if (begins(bytes, "ftypavif", 4)) return "an AVIF picture";
  if (begins(bytes, "\x76\x2f\x31\x01")) return "an OpenEXR picture";
  if (begins(bytes, "#?RADIANCE")) return "a Radiance HDR picture";
  if (begins(bytes, "\xff\x0a") || begins(bytes, "JXL ", 4)) return "a JPEG XL picture";
  if (begins(bytes, "<svg") || begins(bytes, "<?xml")) return "an SVG drawing";
  if (begins(bytes, "\x1f\x8b")) return "a file packed by gzip";
  return bytes.empty() ? "an empty file" : nullptr;
}

[[noreturn]] void refuse_kind(const Bytes& bytes, const std::string& name) {
  const char* foreign = foreign_kind(bytes);
  throw InputError(fmt::format("{}: {}; give a PNG, JPEG, WebP, TIFF, GIF, BMP or TGA file.", name,
                               foreign ? fmt::format("{}, which is not read", foreign)
                                       : "not a picture of a kind that is read"));
}

bool is_webp(const Bytes& bytes) { return begins(bytes, "RIFF") && begins(bytes, "WEBP", 8); }

// By its first bytes; TGA has no mark.
bool may_be_picture(const Bytes& bytes) {
  return is_png(bytes) || is_jpeg(bytes) || is_webp(bytes) || begins(bytes, "GIF8") ||
         is_tiff(bytes) || begins(bytes, "BM") ||
         (foreign_kind(bytes) == nullptr && looks_like_tga(bytes));
}

StoredPicture decode_any(const Bytes& bytes, const std::string& name) {
  if (is_png(bytes)) return decode_png(bytes, name);
  if (is_jpeg(bytes)) return decode_jpeg(bytes, name);
  if (is_webp(bytes)) return decode_webp(bytes, name);
  if (begins(bytes, "GIF8")) return decode_gif(bytes, name);
  if (is_tiff(bytes)) return decode_tiff(bytes, name);
  if (begins(bytes, "BM")) return decode_bmp(bytes, name);
  if (foreign_kind(bytes) == nullptr && looks_like_tga(bytes)) return decode_tga(bytes, name);
  refuse_kind(bytes, name);
}

void bring_inks_to_srgb(StoredPicture& picture) {
  if (picture.profile.empty())
    bring_inks_to_srgb(picture.image);
  else
    bring_inks_to_srgb(picture.image, picture.profile);
  CheckEvery check(1 << 16);
  for (std::size_t i = 0; i < picture.ink_alpha.size(); ++i) {
    check();
    picture.image.rgba[4 * i + 3] = picture.ink_alpha[i];
  }
}

// PNG's cICP goes before a profile. What cannot be used is told.
void bring_colors_to_srgb(StoredPicture& picture, const std::string& name) {
  if (picture.cicp) {
    if (bring_to_srgb(picture.image, *picture.cicp)) {
      picture.profile_lost = false;
      return;
    }
    if (picture.profile.empty())
      warn(fmt::format(
          "{}: its colours are coded in a way that is not read (cICP {}, {}, {}, {}) "
          "and are taken as sRGB; save it as sRGB from an image editor.",
          name, (*picture.cicp)[0], (*picture.cicp)[1], (*picture.cicp)[2], (*picture.cicp)[3]));
  }
  if (!picture.profile.empty() && !bring_to_srgb(picture.image, picture.profile))
    picture.profile_lost = true;
}

void bring_to_srgb(StoredPicture& picture, const std::string& name) {
  switch (picture.stored) {
    case Stored::kColors:
      bring_colors_to_srgb(picture, name);
      break;
    case Stored::kInks:
      bring_inks_to_srgb(picture);
      break;
    case Stored::kLab:
      bring_lab_to_srgb(picture.image);
      break;
  }
  if (picture.profile_lost)
    warn(
        fmt::format("{}: its colour profile is damaged or does not fit such a picture, and is not "
                    "used: {}; save it as sRGB from an image editor.",
                    name,
                    picture.stored == Stored::kInks ? "its inks show what a plain formula makes of "
                                                      "them"
                                                    : "its colours are taken as sRGB"));
}

}  // namespace

Image decode_image(const Bytes& bytes, const std::string& name) {
  try {
    StoredPicture picture = decode_any(bytes, name);
    if (picture.damaged)
      warn(
          fmt::format("{}: its data are damaged, and parts of the picture may be wrong; take it "
                      "anew from where it came from.",
                      name));
    bring_to_srgb(picture, name);
    return oriented(std::move(picture.image), picture.orientation);
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: not enough memory for this image; scale it down.", name));
  }
}

std::vector<std::uint8_t> read_picture(const std::filesystem::path& path) {
  // 2^28 pixels of four 16-bit values, stored plainly, and some room.
  constexpr std::uintmax_t kLargest = (std::uintmax_t(1) << 31) + (std::uintmax_t(1) << 26);
  constexpr std::size_t kFirst = 4096;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return read_file(path);
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  std::ifstream file(path, std::ios::binary);
  Bytes first(kFirst);
  file.read(reinterpret_cast<char*>(first.data()), kFirst);
  first.resize(std::size_t(std::max<std::streamsize>(file.gcount(), 0)));
  // What cannot be opened is said by read_file.
  if (!first.empty() && !may_be_picture(first)) refuse_kind(first, path.string());
  if (size > kLargest)
    throw InputError(
        fmt::format("{}: has {:.1f} GB, more than any picture that is read; scale it "
                    "down.",
                    path.string(), double(size) / 1e9));
  return read_file(path);
}

Image load_image(const std::filesystem::path& path) {
  return decode_image(read_picture(path), path.string());
}

Resolution recorded_resolution(const Bytes& bytes) {
  if (is_png(bytes)) return png_resolution(bytes);
  if (is_jpeg(bytes)) return jpeg_resolution(bytes);
  return is_tiff(bytes) ? tiff_resolution(bytes) : Resolution();
}

double scan_dpi(const Bytes& bytes) {
  const Resolution found = recorded_resolution(bytes);
  return found.is_one() ? found.across_dpi : 0;
}

double recorded_dpi(const Bytes& bytes) {
  return is_tiff(bytes) ? 0 : recorded_resolution(bytes).across_dpi;
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

Bytes encode_jpeg(const Image& image, int quality) {
  if (image.width_px <= 0 || image.height_px <= 0) {
    throw InputError("An image without pixels cannot be written as JPEG.");
  }
  JpegWriter writer;
  std::vector<std::uint8_t> row(std::size_t(3) * std::size_t(image.width_px));
  if (!writer.write(image, quality, row.data())) {
    throw InputError(
        fmt::format("The image could not be written as JPEG: {}.", writer.errors.message));
  }
  return {writer.data, writer.data + writer.size};
}

void save_png(const std::filesystem::path& path, const Image& image, double dpi, bool mirrored) {
  const Bytes bytes = encode_png(image, dpi, mirrored);
  write_file(path, bytes.data(), bytes.size());
}

}  // namespace hydrodip
