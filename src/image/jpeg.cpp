// The only place that knows libjpeg. It reports errors by longjmp, as libpng does.
// jpeglib.h needs size_t and FILE first, jerror.h what jpeglib.h defines: its numbers hang on that.
#include <cstdio>

#include <jpeglib.h>

#include <jerror.h>

#include <fmt/format.h>

#include <algorithm>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/math.h"
#include "base/run_scope.h"
#include "image/decoders.h"
#include "image/files.h"
#include "image/picture_file.h"

namespace hydrodip {

namespace {

using Bytes = PictureBytes;

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

}  // namespace

bool is_jpeg(const Bytes& bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
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

}  // namespace hydrodip
