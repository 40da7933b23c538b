// TIFF pictures; the only place in this folder that knows libtiff (what is printed:
// sheet/tiff.cpp).
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>

#include "base/run_scope.h"
#include "image/decoders.h"
#include "image/picture_file.h"

namespace hydrodip {

namespace {

struct TiffSource {
  const PictureBytes& bytes;
  std::size_t at = 0;
  char message[256] = {};
};

extern "C" {

static tsize_t tiff_read(thandle_t handle, tdata_t out, tsize_t count) {
  auto* source = static_cast<TiffSource*>(handle);
  const std::size_t left = source->bytes.size() - std::min(source->at, source->bytes.size());
  const std::size_t taken = std::min(std::size_t(std::max<tsize_t>(count, 0)), left);
  if (taken > 0) std::memcpy(out, source->bytes.data() + source->at, taken);
  source->at += taken;
  return tsize_t(taken);
}

static tsize_t tiff_no_write(thandle_t, tdata_t, tsize_t) { return 0; }

static toff_t tiff_seek(thandle_t handle, toff_t offset, int whence) {
  auto* source = static_cast<TiffSource*>(handle);
  const toff_t base = whence == SEEK_CUR   ? source->at
                      : whence == SEEK_END ? source->bytes.size()
                                           : 0;
  source->at = std::size_t(base + offset);
  return source->at;
}

static int tiff_close(thandle_t) { return 0; }

static toff_t tiff_size(thandle_t handle) { return static_cast<TiffSource*>(handle)->bytes.size(); }

static int tiff_map(thandle_t, tdata_t*, toff_t*) { return 0; }

static void tiff_unmap(thandle_t, tdata_t, toff_t) {}

static int tiff_keep_error(TIFF*, void* user, const char*, const char* format, va_list arguments) {
  auto* source = static_cast<TiffSource*>(user);
  std::vsnprintf(source->message, sizeof source->message, format, arguments);
  return 1;
}

static int tiff_ignore_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

}  // extern "C"

struct CloseTiff {
  void operator()(TIFF* file) const { TIFFClose(file); }
};
using Tiff = std::unique_ptr<TIFF, CloseTiff>;

Tiff open(TiffSource& source) {
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, tmsize_t(1) << 30);
  TIFFOpenOptionsSetErrorHandlerExtR(options, tiff_keep_error, &source);
  TIFFOpenOptionsSetWarningHandlerExtR(options, tiff_ignore_warning, nullptr);
  Tiff file(TIFFClientOpenExt("picture", "rm", &source, tiff_read, tiff_no_write, tiff_seek,
                              tiff_close, tiff_size, tiff_map, tiff_unmap, options));
  TIFFOpenOptionsFree(options);
  return file;
}

// libtiff's reader of all kinds of pixels.
class RgbaReader {
 public:
  RgbaReader(TIFF* file, const std::string& name) {
    char why[1024] = {};
    if (!TIFFRGBAImageOK(file, why) || !TIFFRGBAImageBegin(&image_, file, 1, why))
      refuse_picture(name, "TIFF", why);
    // As stored: libtiff only mirrors, and leaves rows rows that should be columns.
    image_.req_orientation = image_.orientation = ORIENTATION_TOPLEFT;
    // Whole strips or tiles at a time: parts of one would be unpacked again and again.
    std::uint32_t block = 0;
    TIFFGetFieldDefaulted(file, TIFFIsTiled(file) ? TIFFTAG_TILELENGTH : TIFFTAG_ROWSPERSTRIP,
                          &block);
    if (block == 0 || block >= image_.height)
      band_rows_ = image_.height;
    else
      band_rows_ = (kBandRows + block - 1) / block * block;
  }
  ~RgbaReader() { TIFFRGBAImageEnd(&image_); }
  RgbaReader(const RgbaReader&) = delete;
  RgbaReader& operator=(const RgbaReader&) = delete;

  // False if the file is damaged.
  bool read(Image& to) {
    std::vector<std::uint32_t> raster;
    std::uint8_t* out = to.rgba.data();
    for (std::uint32_t row = 0; row < image_.height; row += band_rows_) {
      check_cancelled();
      const std::uint32_t rows = std::min(band_rows_, image_.height - row);
      raster.assign(std::size_t(image_.width) * rows, 0);
      image_.row_offset = int(row);
      if (!TIFFRGBAImageGet(&image_, raster.data(), image_.width, rows)) return false;
      for (const std::uint32_t pixel : raster) {
        *out++ = std::uint8_t(TIFFGetR(pixel));
        *out++ = std::uint8_t(TIFFGetG(pixel));
        *out++ = std::uint8_t(TIFFGetB(pixel));
        *out++ = std::uint8_t(TIFFGetA(pixel));
      }
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kBandRows = 64;
  TIFFRGBAImage image_{};
  std::uint32_t band_rows_ = 0;
};

// libtiff multiplies colours by alpha.
void make_straight(Image& image) {
  CheckEvery check(1 << 20);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    check();
    const int alpha = image.rgba[i + 3];
    if (alpha == 255 || alpha == 0) continue;
    for (std::size_t c = 0; c < 3; ++c)
      image.rgba[i + c] =
          std::uint8_t(std::min(255, (image.rgba[i + c] * 255 + alpha / 2) / alpha));
  }
}

PictureBytes profile_of(TIFF* file) {
  std::uint32_t size = 0;
  void* profile = nullptr;
  if (!TIFFGetField(file, TIFFTAG_ICCPROFILE, &size, &profile)) return {};
  const auto* begin = static_cast<const std::uint8_t*>(profile);
  return {begin, begin + size};
}

// How many bytes a pixel has if rows of such pixels lie one after another; 0 if they do not.
int bytes_a_pixel(TIFF* file) {
  std::uint16_t bits = 0, samples = 0, planes = 0;
  TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(file, TIFFTAG_PLANARCONFIG, &planes);
  const bool in_rows = bits == 8 && planes == PLANARCONFIG_CONTIG && !TIFFIsTiled(file);
  return in_rows ? samples : 0;
}

// Four inks of 8 bits in rows, with a profile that says what they show. Of others libtiff makes RGB
// by a plain formula.
bool has_known_inks(TIFF* file, std::uint16_t photometric, const PictureBytes& profile) {
  return photometric == PHOTOMETRIC_SEPARATED && bytes_a_pixel(file) == 4 &&
         is_ink_profile(profile);
}

// Red, green, blue or one grey in a single strip, which can be read row by row: libtiff's reader of
// all kinds of pixels unpacks it as a whole, deaf to a cancel.
bool is_one_plain_strip(TIFF* file, std::uint16_t photometric) {
  return TIFFNumberOfStrips(file) == 1 &&
         ((photometric == PHOTOMETRIC_RGB && bytes_a_pixel(file) == 3) ||
          (photometric == PHOTOMETRIC_MINISBLACK && bytes_a_pixel(file) == 1));
}

// Whether what libtiff makes of it is still in the file's own colour space.
bool keeps_its_space(std::uint16_t photometric) {
  switch (photometric) {
    case PHOTOMETRIC_RGB:
    case PHOTOMETRIC_YCBCR:
    case PHOTOMETRIC_PALETTE:
    case PHOTOMETRIC_MINISBLACK:
    case PHOTOMETRIC_MINISWHITE:
      return true;
    default:
      return false;
  }
}

// False if the file is damaged.
bool read_rows(TIFF* file, Image& to) {
  const auto bytes = std::size_t(bytes_a_pixel(file));
  const std::size_t width = std::size_t(to.width_px);
  std::vector<std::uint8_t> row(bytes * width);
  if (TIFFScanlineSize(file) != tmsize_t(row.size())) return false;
  for (int y = 0; y < to.height_px; ++y) {
    check_cancelled();
    if (TIFFReadScanline(file, row.data(), std::uint32_t(y), 0) != 1) return false;
    std::uint8_t* out = to.pixel(0, y);
    for (std::size_t x = 0; x < width; ++x, out += 4) {
      const std::uint8_t* in = &row[bytes * x];
      for (std::size_t c = 0; c < 3; ++c) out[c] = in[bytes == 1 ? 0 : c];
      out[3] = bytes == 4 ? in[3] : 255;
    }
  }
  return true;
}

}  // namespace

double recorded_tiff_dpi(const PictureBytes& bytes) {
  TiffSource source{bytes};
  const Tiff file = open(source);
  float across = 0, along = 0;
  std::uint16_t unit = RESUNIT_INCH;
  if (!file || TIFFGetField(file.get(), TIFFTAG_XRESOLUTION, &across) != 1 ||
      TIFFGetField(file.get(), TIFFTAG_YRESOLUTION, &along) != 1)
    return 0;
  TIFFGetFieldDefaulted(file.get(), TIFFTAG_RESOLUTIONUNIT, &unit);
  // Without a unit they are an aspect ratio alone.
  if (unit == RESUNIT_NONE || !(across > 0) || across != along) return 0;
  return unit == RESUNIT_CENTIMETER ? 2.54 * double(across) : double(across);
}

namespace {

// What a pixel takes in the file at the least.
double least_bytes_a_pixel(TIFF* file) {
  std::uint16_t bits = 0, samples = 0, compression = 0;
  TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(file, TIFFTAG_COMPRESSION, &compression);
  // Colours of YCbCr may stand for four pixels each: half of the three samples.
  const double plain = double(bits) * samples / 8 / 2;
  switch (compression) {
    case COMPRESSION_NONE:
      return plain;
    case COMPRESSION_PACKBITS:  // two bytes for a run of 128
      return plain / 64;
    case COMPRESSION_LZW:  // nine bits for 4096 bytes
      return plain / 4096 * 9 / 8;
    case COMPRESSION_DEFLATE:
    case COMPRESSION_ADOBE_DEFLATE:
      return plain / 1040;
    case COMPRESSION_CCITTRLE:
    case COMPRESSION_CCITTRLEW:
    case COMPRESSION_CCITTFAX3:
    case COMPRESSION_CCITTFAX4:  // a bit for a row of up to 2^15 that is like the one above
      return 1.0 / 8 / 32768;
    default:
      return 0;
  }
}

}  // namespace

StoredPicture decode_tiff(const PictureBytes& bytes, const std::string& name) {
  TiffSource source{bytes};
  const Tiff file = open(source);
  if (!file) refuse_picture(name, "TIFF", source.message);
  std::uint32_t width = 0, height = 0;
  std::uint16_t photometric = PHOTOMETRIC_RGB;
  TIFFGetField(file.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(file.get(), TIFFTAG_IMAGELENGTH, &height);
  TIFFGetField(file.get(), TIFFTAG_PHOTOMETRIC, &photometric);
  check_picture_size(name, "TIFF", width, height,
                     double(width) * height * least_bytes_a_pixel(file.get()), bytes.size());
  StoredPicture picture;
  picture.image = Image(int(width), int(height));
  picture.profile = profile_of(file.get());
  std::uint16_t orientation = ORIENTATION_TOPLEFT;
  TIFFGetFieldDefaulted(file.get(), TIFFTAG_ORIENTATION, &orientation);
  picture.orientation = orientation;  // numbered as EXIF's
  picture.inks = has_known_inks(file.get(), photometric, picture.profile);
  const bool by_rows = picture.inks || is_one_plain_strip(file.get(), photometric);
  if (by_rows ? !read_rows(file.get(), picture.image)
              : !RgbaReader(file.get(), name).read(picture.image))
    refuse_picture(name, "TIFF", source.message);
  if (picture.inks) return picture;
  make_straight(picture.image);
  if (!keeps_its_space(photometric)) picture.profile.clear();
  return picture;
}

}  // namespace hydrodip
