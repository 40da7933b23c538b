// TIFFs of inks, written and read.
#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/run_scope.h"
#include "image/decoders.h"
#include "sheet/page.h"
#include "sheet/sheet.h"

namespace hydrodip {

namespace {

constexpr int kRowsPerStrip = 64;
constexpr std::uint32_t kLargestSide_px = 1 << 15;
constexpr double kClassicTiffBytes = 4e9;  // offsets have 32 bits; beyond, BigTIFF

// Keeps libtiff's first complaint instead of letting it print.
int keep_message(TIFF*, void* user, const char*, const char* format, va_list arguments) {
  auto& message = *static_cast<std::string*>(user);
  char text[256];
  std::vsnprintf(text, sizeof text, format, arguments);
  if (message.empty()) message = text;
  return 1;
}

int ignore_message(TIFF*, void*, const char*, const char*, va_list) { return 1; }

int note_warning(TIFF*, void* user, const char*, const char*, va_list) {
  *static_cast<bool*>(user) = true;
  return 1;
}

struct Complaints {
  std::string error;
  bool warned = false;
};

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, CloseTiff>;

Tiff open_tiff(const std::filesystem::path& path, const char* mode, Complaints& complaints) {
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options, keep_message, &complaints.error);
  TIFFOpenOptionsSetWarningHandlerExtR(options, note_warning, &complaints.warned);
  Tiff tiff(TIFFOpenExt(path.c_str(), mode, options));
  TIFFOpenOptionsFree(options);
  return tiff;
}

// LZW because every raster image processor of the last thirty years reads it.
void describe(TIFF* tiff, const InkImage& image, const std::vector<std::uint8_t>& profile,
              double dpi) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(image.width_px));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(image.height_px));
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 4);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_SEPARATED);
  TIFFSetField(tiff, TIFFTAG_INKSET, INKSET_CMYK);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, kRowsPerStrip);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
  TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
  TIFFSetField(tiff, TIFFTAG_XRESOLUTION, dpi);
  TIFFSetField(tiff, TIFFTAG_YRESOLUTION, dpi);
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, "hydrodip");
  if (!profile.empty())
    TIFFSetField(tiff, TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(profile.size()),
                 profile.data());
}

void fill_row(const InkImage& image, int y, bool mirror, std::vector<std::uint8_t>& row) {
  for (int x = 0; x < image.width_px; ++x)
    std::copy_n(image.pixel(mirror ? image.width_px - 1 - x : x, y), 4,
                row.begin() + 4 * std::ptrdiff_t(x));
}

// A file in memory, as far as libtiff needs one to write a strip.
struct MemoryFile {
  std::vector<std::uint8_t> bytes;
  std::size_t at = 0;
};

extern "C" {

static tmsize_t memory_read(thandle_t, void*, tmsize_t) { return 0; }

static tmsize_t memory_write(thandle_t handle, void* data, tmsize_t count) {
  auto& file = *static_cast<MemoryFile*>(handle);
  try {
    file.bytes.resize(std::max(file.bytes.size(), file.at + std::size_t(count)));
  } catch (const std::bad_alloc&) {
    return -1;
  }
  std::copy_n(static_cast<const std::uint8_t*>(data), count,
              file.bytes.begin() + std::ptrdiff_t(file.at));
  file.at += std::size_t(count);
  return count;
}

static toff_t memory_seek(thandle_t handle, toff_t offset, int from) {
  auto& file = *static_cast<MemoryFile*>(handle);
  if (from == SEEK_CUR) offset += file.at;
  if (from == SEEK_END) offset += file.bytes.size();
  file.at = std::size_t(offset);
  return offset;
}

static int memory_close(thandle_t) { return 0; }

static toff_t memory_size(thandle_t handle) {
  return static_cast<MemoryFile*>(handle)->bytes.size();
}

}  // extern "C"

// What libtiff makes of one strip; empty if it cannot.
std::vector<std::uint8_t> compressed_strip(const InkImage& image, int first_row, bool mirror) {
  const int rows = std::min(kRowsPerStrip, image.height_px - first_row);
  MemoryFile file;
  std::string message;
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options, keep_message, &message);
  TIFFOpenOptionsSetWarningHandlerExtR(options, ignore_message, nullptr);
  const Tiff tiff(TIFFClientOpenExt("strip", "w", &file, memory_read, memory_write, memory_seek,
                                    memory_close, memory_size, nullptr, nullptr, options));
  TIFFOpenOptionsFree(options);
  if (!tiff) return {};
  describe(tiff.get(), image, {}, 0);
  TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(rows));
  std::vector<std::uint8_t> row(std::size_t(4) * std::size_t(image.width_px));
  for (int y = 0; y < rows; ++y) {
    check_cancelled();
    fill_row(image, first_row + y, mirror, row);
    if (TIFFWriteScanline(tiff.get(), row.data(), static_cast<std::uint32_t>(y), 0) != 1) return {};
  }
  if (TIFFFlushData(tiff.get()) != 1) return {};
  const auto begin = file.bytes.begin() + std::ptrdiff_t(TIFFGetStrileOffset(tiff.get(), 0));
  return {begin, begin + std::ptrdiff_t(TIFFGetStrileByteCount(tiff.get(), 0))};
}

// Some strips at a time, which several threads compress.
bool write_strips(TIFF* tiff, const InkImage& image, bool mirror) {
  constexpr std::size_t kAtOnce = 32;
  const std::size_t count = (std::size_t(image.height_px) + kRowsPerStrip - 1) / kRowsPerStrip;
  for (std::size_t first = 0; first < count; first += kAtOnce) {
    std::vector<std::vector<std::uint8_t>> strips(std::min(kAtOnce, count - first));
    parallel_for(strips.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n)
        strips[n] = compressed_strip(image, kRowsPerStrip * int(first + n), mirror);
    });
    for (std::size_t n = 0; n < strips.size(); ++n)
      if (strips[n].empty() || TIFFWriteRawStrip(tiff, std::uint32_t(first + n), strips[n].data(),
                                                 tmsize_t(strips[n].size())) < 0)
        return false;
  }
  return TIFFFlush(tiff) == 1;
}

// libtiff's complaint, if it has one.
[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& message) {
  throw InputError(fmt::format("{}: is no CMYK TIFF with 8 bits per ink{}", path.string(),
                               message.empty() ? "" : " (" + message + ")"));
}

void check_cmyk(TIFF* tiff, const std::filesystem::path& path) {
  std::uint16_t samples = 0, bits = 0, photometric = 0, planes = 0;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &planes);
  if (samples != 4 || bits != 8 || photometric != PHOTOMETRIC_SEPARATED ||
      planes != PLANARCONFIG_CONTIG || TIFFIsTiled(tiff))
    refuse(path, "");
}

// As its orientation (numbered as EXIF's) wants it seen.
InkImage upright(InkImage inks, TIFF* tiff) {
  std::uint16_t orientation = ORIENTATION_TOPLEFT;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION, &orientation);
  Image pixels;
  pixels.width_px = inks.width_px;
  pixels.height_px = inks.height_px;
  pixels.rgba = std::move(inks.cmyk);
  pixels = oriented(std::move(pixels), orientation);
  inks.width_px = pixels.width_px;
  inks.height_px = pixels.height_px;
  inks.cmyk = std::move(pixels.rgba);
  return inks;
}

std::vector<std::uint8_t> embedded_profile(TIFF* tiff) {
  std::uint32_t size = 0;
  const std::uint8_t* bytes = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_ICCPROFILE, &size, &bytes) != 1) return {};
  return {bytes, bytes + size};
}

double recorded_tiff_dpi(TIFF* tiff) {
  float dpi = 0;
  std::uint16_t unit = RESUNIT_INCH;
  TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &dpi);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_RESOLUTIONUNIT, &unit);
  return unit == RESUNIT_CENTIMETER ? 2.54 * double(dpi) : double(dpi);
}

}  // namespace

bool is_ink_tiff(const std::filesystem::path& path) {
  Complaints ignored;
  const Tiff tiff = open_tiff(path, "r", ignored);
  std::uint16_t photometric = 0;
  return tiff && TIFFGetField(tiff.get(), TIFFTAG_PHOTOMETRIC, &photometric) == 1 &&
         photometric == PHOTOMETRIC_SEPARATED;
}

CmykFile read_cmyk_tiff(const std::filesystem::path& path) {
  Complaints complaints;
  const Tiff tiff = open_tiff(path, "r", complaints);
  if (!tiff) refuse(path, complaints.error);
  check_cmyk(tiff.get(), path);
  std::uint32_t width = 0, height = 0;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  if (width == 0 || height == 0 || width > kLargestSide_px || height > kLargestSide_px)
    refuse(path, fmt::format("{} x {} px", width, height));
  CmykFile file;
  file.dpi = recorded_tiff_dpi(tiff.get());
  try {
    file.inks = InkImage(int(width), int(height));  // a header alone takes no memory
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: not enough memory for its {} x {} px; scale it down.",
                                 path.string(), width, height));
  }
  std::vector<std::uint8_t> row(std::size_t(TIFFScanlineSize64(tiff.get())));
  if (row.size() < std::size_t(4) * width) refuse(path, complaints.error);
  // What libtiff says while it reads rows is of rows that do not come out as they should.
  complaints.warned = false;
  for (std::uint32_t y = 0; y < height; ++y) {
    check_cancelled();
    if (TIFFReadScanline(tiff.get(), row.data(), y, 0) != 1) refuse(path, complaints.error);
    std::copy_n(row.begin(), std::size_t(4) * width, file.inks.pixel(0, int(y)));
  }
  if (complaints.warned || !complaints.error.empty()) warn_of_damage(path.string());
  file.inks = upright(std::move(file.inks), tiff.get());
  file.profile = embedded_profile(tiff.get());
  return file;
}

void write_print_tiff(const std::filesystem::path& path, const InkImage& inks,
                      const std::vector<std::uint8_t>& profile, const SheetOptions& options) {
  check_sheet(inks, options);
  Complaints complaints;
  const bool big = 4.0 * inks.width_px * inks.height_px > kClassicTiffBytes;
  Tiff tiff = open_tiff(path, big ? "w8" : "w", complaints);
  bool written = tiff != nullptr;
  if (written) {
    describe(tiff.get(), inks, profile, options.dpi);
    written = write_strips(tiff.get(), inks, !options.ink_side_up);
    tiff.reset();  // may still write, and complain
  }
  if (!written || !complaints.error.empty()) refuse_write(path, complaints.error);
}

}  // namespace hydrodip
