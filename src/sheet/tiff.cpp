// The only place that knows libtiff.
#include <fmt/format.h>
#include <tiffio.h>

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "ink/device.h"
#include "sheet/page.h"
#include "sheet/sheet.h"

namespace hydrodip {

namespace {

constexpr int kRowsPerStrip = 64;
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

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, CloseTiff>;

Tiff open_tiff(const std::filesystem::path& path, bool big, std::string& message) {
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options, keep_message, &message);
  TIFFOpenOptionsSetWarningHandlerExtR(options, ignore_message, nullptr);
  Tiff tiff(TIFFOpenExt(path.c_str(), big ? "w8" : "w", options));
  TIFFOpenOptionsFree(options);
  return tiff;
}

// LZW because every raster image processor of the last thirty years reads it.
void describe(TIFF* tiff, const Image& image, double dpi) {
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
}

void fill_row(const Image& image, int y, bool mirror, std::vector<std::uint8_t>& row) {
  for (int x = 0; x < image.width_px; ++x) {
    const std::uint8_t* pixel = image.pixel(mirror ? image.width_px - 1 - x : x, y);
    const auto ink = device_cmyk(pixel[0], pixel[1], pixel[2], pixel[3]);
    std::copy(ink.begin(), ink.end(), row.begin() + 4 * std::ptrdiff_t(x));
  }
}

bool write_rows(TIFF* tiff, const Image& image, bool mirror) {
  std::vector<std::uint8_t> row(std::size_t(4) * std::size_t(image.width_px));
  for (int y = 0; y < image.height_px; ++y) {
    fill_row(image, y, mirror, row);
    if (TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0) != 1) return false;
  }
  return TIFFFlush(tiff) == 1;
}

}  // namespace

void write_print_tiff(const std::filesystem::path& path, const Image& image,
                      const SheetOptions& options) {
  check_sheet(image, options);
  std::string message;
  const bool big = 4.0 * image.width_px * image.height_px > kClassicTiffBytes;
  Tiff tiff = open_tiff(path, big, message);
  bool written = tiff != nullptr;
  if (written) {
    describe(tiff.get(), image, options.dpi);
    written = write_rows(tiff.get(), image, !options.ink_side_up);
    tiff.reset();  // may still write, and complain
  }
  if (!written || !message.empty()) {
    throw InputError(fmt::format("{}: cannot be written ({}); choose another folder or free space.",
                                 path.string(), message));
  }
}

}  // namespace hydrodip
