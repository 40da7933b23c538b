// TIFF pictures; the only place in this folder that knows libtiff (what is printed:
// sheet/tiff.cpp).
#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/math.h"
#include "base/run_scope.h"
#include "image/decoders.h"
#include "image/picture_file.h"

namespace hydrodip {

namespace {

struct TiffSource {
  const PictureBytes& bytes;
  std::size_t at = 0;
  char message[256] = {};  // the last error
  bool in_pixels = false;  // these are read now
  // What warnings told, and errors that libtiff went on after.
  bool profile_lost = false, pixels_damaged = false, jpeg_cut = false;
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
  if (source->in_pixels) source->pixels_damaged = true;
  return 1;
}

// Of a field that cannot be read libtiff says no more than that, and goes on without it; of pixels
// that do not come out as they should, too.
static int tiff_note_warning(TIFF*, void* user, const char* module, const char* format,
                             va_list arguments) {
  auto* source = static_cast<TiffSource*>(user);
  char text[256] = {};
  std::vsnprintf(text, sizeof text, format, arguments);
  const std::string_view said(text);
  const std::string_view from(module ? module : "");
  // Which is how some write them.
  const bool is_old = said.find("Old-style LZW") != said.npos || from.starts_with("OJPEG");
  if (source->in_pixels && !is_old) source->pixels_damaged = true;
  if (from == "JPEGLib") {
    source->pixels_damaged = true;
    if (said.find("remature end") != said.npos) source->jpeg_cut = true;
  }
  if (said.find("ICC Profile") != said.npos) source->profile_lost = true;
  return 1;
}

}  // extern "C"

struct CloseTiff {
  void operator()(TIFF* file) const { TIFFClose(file); }
};
using Tiff = std::unique_ptr<TIFF, CloseTiff>;

Tiff open(TiffSource& source) {
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, tmsize_t(1) << 30);
  TIFFOpenOptionsSetErrorHandlerExtR(options, tiff_keep_error, &source);
  TIFFOpenOptionsSetWarningHandlerExtR(options, tiff_note_warning, &source);
  Tiff file(TIFFClientOpenExt("picture", "rm", &source, tiff_read, tiff_no_write, tiff_seek,
                              tiff_close, tiff_size, tiff_map, tiff_unmap, options));
  TIFFOpenOptionsFree(options);
  return file;
}

[[noreturn]] void refuse_tiff_kind(const std::string& name, const std::string& what) {
  throw InputError(fmt::format(
      "{}: a TIFF picture with {} is not read; save it as RGB with 8 bits a channel.", name, what));
}

// What its pixels are.
struct TiffPixels {
  int width = 0, height = 0;
  std::uint16_t bits = 0, samples = 0, planes = 0, compression = 0, photometric = 0;
  std::uint16_t format = SAMPLEFORMAT_UINT, ink_set = INKSET_CMYK;
  std::vector<std::uint16_t> extra;  // what the last samples are
  int colors = 0;  // the first samples, where these are colours to be read as they are stored

  bool in_planes() const { return planes == PLANARCONFIG_SEPARATE && samples > 1; }
  bool is_lab() const {
    return photometric == PHOTOMETRIC_CIELAB || photometric == PHOTOMETRIC_ICCLAB;
  }
  // Which sample is transparency, or -1: only what the file says is such.
  int alpha() const {
    for (std::size_t i = 0; i < extra.size(); ++i)
      if (extra[i] == EXTRASAMPLE_ASSOCALPHA || extra[i] == EXTRASAMPLE_UNASSALPHA)
        return int(samples - extra.size() + i);
    return -1;
  }
  // Whether colours are stored multiplied by it.
  bool is_premultiplied() const {
    const int sample = alpha();
    return sample >= 0 &&
           extra[std::size_t(sample) + extra.size() - samples] == EXTRASAMPLE_ASSOCALPHA;
  }
};

int colors_of(std::uint16_t photometric) {
  switch (photometric) {
    case PHOTOMETRIC_MINISBLACK:
    case PHOTOMETRIC_MINISWHITE:
      return 1;
    case PHOTOMETRIC_RGB:
    case PHOTOMETRIC_CIELAB:
    case PHOTOMETRIC_ICCLAB:
      return 3;
    case PHOTOMETRIC_SEPARATED:
      return 4;
    default:
      return 0;
  }
}

TiffPixels pixels_of(TIFF* file) {
  TiffPixels pixels;
  std::uint32_t width = 0, height = 0;
  TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(file, TIFFTAG_IMAGELENGTH, &height);
  pixels.width = int(width);
  pixels.height = int(height);
  TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &pixels.bits);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &pixels.samples);
  TIFFGetFieldDefaulted(file, TIFFTAG_PLANARCONFIG, &pixels.planes);
  TIFFGetFieldDefaulted(file, TIFFTAG_COMPRESSION, &pixels.compression);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLEFORMAT, &pixels.format);
  TIFFGetFieldDefaulted(file, TIFFTAG_INKSET, &pixels.ink_set);
  std::uint16_t count = 0;
  std::uint16_t* kinds = nullptr;
  if (TIFFGetField(file, TIFFTAG_EXTRASAMPLES, &count, &kinds) && count < pixels.samples)
    pixels.extra.assign(kinds, kinds + count);
  if (!TIFFGetField(file, TIFFTAG_PHOTOMETRIC, &pixels.photometric))
    pixels.photometric =
        pixels.samples - pixels.extra.size() < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB;
  const bool in_bytes = pixels.bits == 8 || pixels.bits == 16;
  if (in_bytes && pixels.compression != COMPRESSION_OJPEG)
    pixels.colors = colors_of(pixels.photometric);
  return pixels;
}

[[noreturn]] void refuse_unknown_inks(const std::string& name) {
  refuse_tiff_kind(name, "other inks than cyan, magenta, yellow and black");
}

// Throws for those of which colours would be wrong, or only guessed.
void require_known(const TiffPixels& pixels, const std::string& name) {
  const auto refuse = [&](const std::string& what) { refuse_tiff_kind(name, what); };
  const bool is_signed = pixels.format == SAMPLEFORMAT_INT && !pixels.is_lab();
  if (pixels.photometric == PHOTOMETRIC_LOGL || pixels.photometric == PHOTOMETRIC_LOGLUV)
    refuse("colours of a high dynamic range");
  if (pixels.photometric == PHOTOMETRIC_ITULAB) refuse("colours of a fax (ITU Lab)");
  if (is_signed) refuse("signed numbers");
  if (pixels.format != SAMPLEFORMAT_UINT && pixels.format != SAMPLEFORMAT_INT &&
      pixels.format != SAMPLEFORMAT_VOID)
    refuse("floating-point numbers");
  const bool one_sample = pixels.samples == 1;
  const bool few_bits = pixels.bits == 1 || pixels.bits == 2 || pixels.bits == 4;
  if (pixels.bits != 8 && pixels.bits != 16 && !(few_bits && one_sample))
    refuse(fmt::format("{} bits a channel", pixels.bits));
  if (pixels.photometric == PHOTOMETRIC_PALETTE && !one_sample)
    refuse("a palette and further channels");
  if (pixels.is_lab() && pixels.is_premultiplied())
    refuse("Lab colours multiplied by their transparency");
  const auto stored = int(pixels.samples - pixels.extra.size());
  if (pixels.photometric == PHOTOMETRIC_SEPARATED &&
      (stored < 4 || (stored > 4 && pixels.ink_set != INKSET_CMYK)))
    refuse_unknown_inks(name);
  if (stored < pixels.colors) refuse(fmt::format("{} channels of colour", stored));
}

// libtiff's reader of all kinds of pixels, for those without transparency that take working out.
class RgbaReader {
 public:
  RgbaReader(TIFF* file, const std::string& name) {
    char why[1024] = {};
    if (!TIFFRGBAImageOK(file, why) || !TIFFRGBAImageBegin(&image_, file, 1, why))
      throw InputError(fmt::format(
          "{}: a TIFF picture of a kind that is not read ({}); save it as RGB with 8 bits a "
          "channel.",
          name, why));
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

PictureBytes profile_of(TIFF* file) {
  std::uint32_t size = 0;
  void* profile = nullptr;
  if (!TIFFGetField(file, TIFFTAG_ICCPROFILE, &size, &profile)) return {};
  const auto* begin = static_cast<const std::uint8_t*>(profile);
  return {begin, begin + size};
}

using ByteOf = std::vector<std::uint8_t>;  // of each value that a sample may have

// A value from the least on: the axes of TIFF's own Lab have a sign.
std::size_t from_least(const TiffPixels& pixels, int color, std::size_t value) {
  const bool has_sign = pixels.photometric == PHOTOMETRIC_CIELAB && color > 0;
  return has_sign ? value ^ (std::size_t(1) << (pixels.bits - 1)) : value;
}

// A colour's byte.
ByteOf byte_of(const TiffPixels& pixels, int color) {
  ByteOf bytes(std::size_t(1) << pixels.bits);
  for (std::size_t value = 0; value < bytes.size(); ++value) {
    const std::size_t level = from_least(pixels, color, value);
    bytes[value] = std::uint8_t(pixels.bits == 16 ? (level + 128) / 257 : level);
  }
  return bytes;
}

// Lab of 16 bits as StoredPicture::wide_lab has it.
std::uint16_t wide_lab_of(const TiffPixels& pixels, int color, std::uint16_t value) {
  const std::size_t level = from_least(pixels, color, value);
  const bool is_full = pixels.photometric == PHOTOMETRIC_CIELAB && color == 0;  // 100 is 0xffff
  return std::uint16_t(is_full ? (level * 0xff00 + 0x7fff) / 0xffff : level);
}

// Takes samples as they are stored to where they belong.
class SampleSink {
 public:
  SampleSink(const TiffPixels& pixels, StoredPicture& picture)
      : wide_(pixels.bits == 16), width_(pixels.width) {
    std::uint8_t* image = picture.image.rgba.data();
    if (wide_ && pixels.is_lab())
      take_wide_lab(pixels, picture);
    else
      for (int color = 0; color < pixels.colors; ++color)
        channels_.push_back({color, image + color, 4, byte_of(pixels, color)});
    if (pixels.colors == 1)
      for (const int other : {1, 2}) channels_.push_back({0, image + other, 4, byte_of(pixels, 0)});
    const int alpha = pixels.alpha();
    if (alpha < 0) return;
    TiffPixels grey;
    grey.bits = pixels.bits;
    const ByteOf as_grey = byte_of(grey, 0);
    if (picture.stored != Stored::kInks) {
      channels_.push_back({alpha, image + 3, 4, as_grey});
    } else {
      picture.ink_alpha.resize(picture.image.rgba.size() / 4);
      channels_.push_back({alpha, picture.ink_alpha.data(), 1, as_grey});
    }
  }

  // Whether any of the samples from `first` on, a run of them, is taken.
  bool takes(int first, int run) const {
    const auto taken = [&](const auto& channel) {
      return channel.sample >= first && channel.sample < first + run;
    };
    return std::any_of(channels_.begin(), channels_.end(), taken) ||
           std::any_of(axes_.begin(), axes_.end(), taken);
  }

  // Of so many pixels of a row from (x, y) on, a run of samples each, the first of which is
  // `first`.
  void put(int x, int y, int count, int first, int run, const std::uint8_t* from) {
    const std::size_t at = std::size_t(y) * std::size_t(width_) + std::size_t(x);
    const auto each = [&](const auto& channels, const auto& put_one) {
      const std::size_t size = wide_ ? 2 : 1;
      for (const auto& channel : channels) {
        if (channel.sample < first || channel.sample >= first + run) continue;
        const std::uint8_t* in = from + std::size_t(channel.sample - first) * size;
        auto* out = channel.out + std::size_t(channel.step) * at;
        for (int i = 0; i < count; ++i, in += std::size_t(run) * size, out += channel.step)
          *out = put_one(channel, value(in));
      }
    };
    each(channels_, [](const Channel& channel, std::size_t of) { return channel.byte_of[of]; });
    each(axes_, [](const Axis& axis, std::size_t of) { return axis.word_of[of]; });
  }

 private:
  struct Channel {
    int sample;         // of a pixel in the file
    std::uint8_t* out;  // of the picture's first pixel
    int step;           // from pixel to pixel
    ByteOf byte_of;
  };

  // Of Lab with 16 bits.
  struct Axis {
    int sample;
    std::uint16_t* out;
    int step;
    std::vector<std::uint16_t> word_of;  // each value that a sample may have
  };

  void take_wide_lab(const TiffPixels& pixels, StoredPicture& picture) {
    picture.wide_lab.resize(picture.image.rgba.size() / 4 * 3);
    for (int color = 0; color < 3; ++color) {
      Axis axis{color, picture.wide_lab.data() + color, 3, {}};
      axis.word_of.resize(std::size_t(1) << 16);
      for (std::size_t of = 0; of < axis.word_of.size(); ++of)
        axis.word_of[of] = wide_lab_of(pixels, color, std::uint16_t(of));
      axes_.push_back(std::move(axis));
    }
  }

  std::size_t value(const std::uint8_t* in) const {
    if (!wide_) return *in;
    std::uint16_t sample = 0;
    std::memcpy(&sample, in, sizeof sample);
    return sample;
  }

  bool wide_;
  int width_;
  std::vector<Channel> channels_;
  std::vector<Axis> axes_;
};

// Of a row or a tile.
constexpr std::size_t kLargestPiece = std::size_t(1) << 30;

// False if the file is damaged, as are the next two.
bool read_rows(TIFF* file, const TiffPixels& pixels, SampleSink& sink) {
  const int run = pixels.in_planes() ? 1 : pixels.samples;
  const std::size_t row_bytes = std::size_t(run) * pixels.bits / 8 * std::size_t(pixels.width);
  if (TIFFScanlineSize(file) != tmsize_t(row_bytes) || row_bytes > kLargestPiece) return false;
  std::vector<std::uint8_t> row(row_bytes);
  for (int first = 0; first < pixels.samples; first += run)
    for (int y = 0; sink.takes(first, run) && y < pixels.height; ++y) {
      check_cancelled();
      if (TIFFReadScanline(file, row.data(), std::uint32_t(y), std::uint16_t(first)) != 1)
        return false;
      sink.put(0, y, pixels.width, first, run, row.data());
    }
  return true;
}

bool read_tiles(TIFF* file, const TiffPixels& pixels, SampleSink& sink) {
  std::uint32_t wide = 0, high = 0;
  TIFFGetField(file, TIFFTAG_TILEWIDTH, &wide);
  TIFFGetField(file, TIFFTAG_TILELENGTH, &high);
  const int run = pixels.in_planes() ? 1 : pixels.samples;
  const std::size_t row_bytes = std::size_t(run) * pixels.bits / 8 * wide;
  const tmsize_t size = TIFFTileSize(file);
  if (wide == 0 || high == 0 || size < 1 || std::size_t(size) > kLargestPiece ||
      std::size_t(size) / high != row_bytes)
    return false;
  // Not cleared: a damaged file may claim immense ones.
  const auto tile = std::make_unique_for_overwrite<std::uint8_t[]>(std::size_t(size));
  for (int first = 0; first < pixels.samples; first += run)
    for (int top = 0; sink.takes(first, run) && top < pixels.height; top += int(high))
      for (int left = 0; left < pixels.width; left += int(wide)) {
        check_cancelled();
        if (TIFFReadTile(file, tile.get(), std::uint32_t(left), std::uint32_t(top), 0,
                         std::uint16_t(first)) != size)
          return false;
        for (int y = 0; y < std::min(int(high), pixels.height - top); ++y)
          sink.put(left, top + y, std::min(int(wide), pixels.width - left), first, run,
                   tile.get() + std::size_t(y) * row_bytes);
      }
  return true;
}

bool read_samples(TIFF* file, const TiffPixels& pixels, StoredPicture& picture) {
  SampleSink sink(pixels, picture);
  if (!(TIFFIsTiled(file) ? read_tiles(file, pixels, sink) : read_rows(file, pixels, sink)))
    return false;
  const bool inks = picture.stored == Stored::kInks, has_alpha = pixels.alpha() >= 0;
  const bool premultiplied = pixels.is_premultiplied();
  const bool inverted = pixels.photometric == PHOTOMETRIC_MINISWHITE;
  if (inks ? !premultiplied : has_alpha && !premultiplied && !inverted) return true;
  CheckEvery check(1 << 16);
  std::uint8_t* pixel = picture.image.rgba.data();
  for (std::size_t i = 0; i < picture.image.rgba.size() / 4; ++i, pixel += 4) {
    check();
    if (!inks && !has_alpha) pixel[3] = 255;
    if (premultiplied) divide_by_alpha(pixel, inks ? 4 : 3, inks ? picture.ink_alpha[i] : pixel[3]);
    for (int c = 0; inverted && c < 3; ++c) pixel[c] = std::uint8_t(255 - pixel[c]);
  }
  return true;
}

}  // namespace

Resolution tiff_resolution(const PictureBytes& bytes) {
  TiffSource source{bytes};
  const Tiff file = open(source);
  float across = 0, along = 0;
  std::uint16_t unit = RESUNIT_INCH;
  if (!file || TIFFGetField(file.get(), TIFFTAG_XRESOLUTION, &across) != 1 ||
      TIFFGetField(file.get(), TIFFTAG_YRESOLUTION, &along) != 1)
    return {};
  TIFFGetFieldDefaulted(file.get(), TIFFTAG_RESOLUTIONUNIT, &unit);
  // Without a unit they are an aspect ratio alone.
  if (unit == RESUNIT_NONE || !(across > 0) || !(along > 0)) return {};
  const double per_unit = unit == RESUNIT_CENTIMETER ? kMmPerInch / 10 : 1;
  return {double(across) * per_unit, double(along) * per_unit};
}

namespace {

// Whether there are pages after this one; the same picture in small, or a mask for it, is none.
bool goes_on(TIFF* file) {
  while (TIFFReadDirectory(file)) {
    check_cancelled();
    std::uint32_t kind = 0;
    TIFFGetFieldDefaulted(file, TIFFTAG_SUBFILETYPE, &kind);
    if ((kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0) return true;
  }
  return false;
}

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
  TIFFGetField(file.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(file.get(), TIFFTAG_IMAGELENGTH, &height);
  check_picture_size(name, "TIFF", width, height,
                     double(width) * height * least_bytes_a_pixel(file.get()), bytes.size());
  const TiffPixels pixels = pixels_of(file.get());
  require_known(pixels, name);
  StoredPicture picture;
  picture.image = Image(pixels.width, pixels.height);
  std::uint16_t orientation = ORIENTATION_TOPLEFT;
  TIFFGetFieldDefaulted(file.get(), TIFFTAG_ORIENTATION, &orientation);
  picture.orientation = orientation;  // numbered as EXIF's
  if (pixels.photometric == PHOTOMETRIC_SEPARATED) picture.stored = Stored::kInks;
  if (pixels.is_lab()) picture.stored = Stored::kLab;
  source.in_pixels = true;
  if (pixels.colors > 0 ? !read_samples(file.get(), pixels, picture)
                        : !RgbaReader(file.get(), name).read(picture.image))
    refuse_picture(name, "TIFF", source.message);
  source.in_pixels = false;
  if (source.jpeg_cut) refuse_picture(name, "TIFF", "it ends too early");
  if (pixels.colors > 0)
    warn_of_left_out(pixels.samples - pixels.colors - (pixels.alpha() >= 0 ? 1 : 0), name);
  picture.damaged = source.pixels_damaged;
  if (picture.stored == Stored::kInks) take_ink_profile(picture, profile_of(file.get()));
  if (picture.stored == Stored::kInks && pixels.ink_set != INKSET_CMYK && picture.profile.empty())
    refuse_unknown_inks(name);
  if (picture.stored == Stored::kColors) picture.profile = profile_of(file.get());
  if (source.profile_lost && picture.stored != Stored::kLab) picture.profile_lost = true;
  picture.has_more = goes_on(file.get());
  return picture;
}

}  // namespace hydrodip
