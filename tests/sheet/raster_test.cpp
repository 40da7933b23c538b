#include <gtest/gtest.h>
#include <tiffio.h>

#include <algorithm>
#include <fstream>

#include "base/error.h"
#include "base/file.h"
#include "ink/device.h"
#include "sheet/sheet.h"
#include "sheet/sheet_testing.h"

namespace hydrodip {
namespace {

using testing::blank_image;
using testing::has_tool;
using testing::patterned_image;
using testing::run_tool;
using testing::sheet;

class PrintRaster : public testing::ScratchFolder {};

// Every byte of a CMYK file, rows from the top.
std::vector<std::uint8_t> read_tiff(const std::filesystem::path& path, const Image& image,
                                    double dpi) {
  TIFF* tiff = TIFFOpen(path.c_str(), "r");
  EXPECT_NE(tiff, nullptr);
  std::uint32_t width = 0, height = 0;
  std::uint16_t samples = 0, bits = 0, photometric = 0, ink_set = 0, unit = 0;
  float x_dpi = 0, y_dpi = 0;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
  TIFFGetField(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetField(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  TIFFGetField(tiff, TIFFTAG_INKSET, &ink_set);
  TIFFGetField(tiff, TIFFTAG_RESOLUTIONUNIT, &unit);
  TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &x_dpi);
  TIFFGetField(tiff, TIFFTAG_YRESOLUTION, &y_dpi);
  EXPECT_EQ(int(width), image.width_px);
  EXPECT_EQ(int(height), image.height_px);
  EXPECT_EQ(samples, 4);
  EXPECT_EQ(bits, 8);
  EXPECT_EQ(photometric, PHOTOMETRIC_SEPARATED);
  EXPECT_EQ(ink_set, INKSET_CMYK);
  EXPECT_EQ(unit, RESUNIT_INCH);
  EXPECT_FLOAT_EQ(x_dpi, float(dpi));
  EXPECT_FLOAT_EQ(y_dpi, float(dpi));
  std::vector<std::uint8_t> bytes(std::size_t(4) * width * height);
  for (std::uint32_t y = 0; y < height; ++y) {
    EXPECT_EQ(TIFFReadScanline(tiff, bytes.data() + std::size_t(4) * width * y, y, 0), 1);
  }
  TIFFClose(tiff);
  return bytes;
}

TEST_F(PrintRaster, TheTiffHoldsTheDeviceFormulaOfEveryPixel) {
  for (const bool up : {true, false}) {
    SheetOptions options = sheet(52, 61, 5, 150);
    options.ink_side_up = up;
    const Image image = patterned_image(options);
    write_print_tiff(folder_ / "print.tif", image, options);
    const auto bytes = read_tiff(folder_ / "print.tif", image, 150);
    std::size_t at = 0;
    std::size_t wrong = 0;
    for (int y = 0; y < image.height_px; ++y) {
      for (int x = 0; x < image.width_px; ++x) {
        const std::uint8_t* pixel = image.pixel(up ? x : image.width_px - 1 - x, y);
        const auto ink = device_cmyk(pixel[0], pixel[1], pixel[2], pixel[3]);
        for (const std::uint8_t amount : ink) wrong += bytes[at++] != amount;
      }
    }
    EXPECT_EQ(wrong, 0u) << "up " << up;
  }
}

TEST_F(PrintRaster, TiffinfoAcceptsTheTiff) {
  if (!has_tool("tiffinfo")) GTEST_SKIP() << "needs tiffinfo";
  const SheetOptions options = sheet(210, 297, 10, 72);
  write_print_tiff(folder_ / "print.tif", patterned_image(options), options);
  const auto [status, said] = run_tool("tiffinfo -D " + (folder_ / "print.tif").string());
  EXPECT_EQ(status, 0) << said;
  EXPECT_EQ(said.find("Warning"), std::string::npos) << said;
  EXPECT_NE(said.find("Resolution: 72, 72 pixels/inch"), std::string::npos) << said;
  EXPECT_NE(said.find("separated"), std::string::npos) << said;
}

TEST_F(PrintRaster, TheSameInputGivesTheSameTiff) {
  const SheetOptions options = sheet(52, 61, 5, 150);
  write_print_tiff(folder_ / "a.tif", patterned_image(options), options);
  write_print_tiff(folder_ / "b.tif", patterned_image(options), options);
  EXPECT_EQ(read_file(folder_ / "a.tif"), read_file(folder_ / "b.tif"));
}

TEST_F(PrintRaster, ThePngIsTheImageWithItsDpi) {
  SheetOptions options = sheet(52, 61, 5, 150);
  const Image image = patterned_image(options);
  write_print_png(folder_ / "print.png", image, options);
  const auto bytes = read_file(folder_ / "print.png");
  EXPECT_EQ(recorded_dpi(bytes), 150);
  EXPECT_EQ(decode_image(bytes, "print.png").rgba, image.rgba);

  options.ink_side_up = false;
  write_print_png(folder_ / "mirror.png", image, options);
  const Image mirror = load_image(folder_ / "mirror.png");
  ASSERT_EQ(mirror.width_px, image.width_px);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      ASSERT_TRUE(std::equal(image.pixel(x, y), image.pixel(x, y) + 4,
                             mirror.pixel(image.width_px - 1 - x, y)));
    }
  }
}

TEST_F(PrintRaster, FilesThatCannotBeWrittenAreNamed) {
  const SheetOptions options = sheet(80, 90, 10, 72);
  const Image image = patterned_image(options);
  std::ofstream(folder_ / "file") << "x";
  for (const std::filesystem::path& path :
       {folder_ / "missing" / "print", folder_ / "file" / "print", folder_}) {
    for (const auto writer : {write_print_tiff, write_print_png}) {
      try {
        writer(path, image, options);
        FAIL() << path;
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
        EXPECT_EQ(std::string(error.what()).find("()"), std::string::npos) << error.what();
      }
    }
  }
}

TEST_F(PrintRaster, AFullDiskIsNoticed) {
  if (!std::filesystem::is_character_file("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  for (const double size : {40.0, 300.0}) {
    const SheetOptions options = sheet(size, size, 10, 72);
    const Image image = patterned_image(options);
    EXPECT_THROW(write_print_tiff("/dev/full", image, options), InputError);
    EXPECT_THROW(write_print_png("/dev/full", image, options), InputError);
  }
}

TEST_F(PrintRaster, ImagesOfAnotherSheetAreRefused) {
  const SheetOptions options = sheet(80, 90, 10, 72);
  const Image image = blank_image(sheet(80, 100, 10, 72));
  EXPECT_THROW(write_print_tiff(folder_ / "x.tif", image, options), InputError);
  EXPECT_THROW(write_print_png(folder_ / "x.png", image, options), InputError);
}

}  // namespace
}  // namespace hydrodip
