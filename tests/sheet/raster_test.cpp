#include <gtest/gtest.h>
#include <tiffio.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "base/error.h"
#include "base/file.h"
#include "base/run_scope.h"
#include "sheet/sheet.h"
#include "sheet/sheet_testing.h"

namespace hydrodip {
namespace {

using fixtures::blank_image;
using fixtures::device_profile;
using fixtures::has_tool;
using fixtures::patterned_image;
using fixtures::patterned_inks;
using fixtures::run_tool;
using fixtures::sheet;

class PrintRaster : public fixtures::InFolder {};

// Every byte of a CMYK file, rows from the top.
std::vector<std::uint8_t> read_tiff(const std::filesystem::path& path, const InkImage& image,
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

TEST_F(PrintRaster, TheTiffHoldsEveryInkAndItsProfile) {
  for (const bool up : {true, false}) {
    SheetOptions options = sheet(52, 61, 5, 150);
    options.ink_side_up = up;
    const InkImage inks = patterned_inks(options);
    write_print_tiff(folder_ / "print.tif", inks, device_profile(), options);
    const auto bytes = read_tiff(folder_ / "print.tif", inks, 150);
    std::size_t at = 0;
    std::size_t wrong = 0;
    for (int y = 0; y < inks.height_px; ++y) {
      for (int x = 0; x < inks.width_px; ++x) {
        const std::uint8_t* pixel = inks.pixel(up ? x : inks.width_px - 1 - x, y);
        for (int k = 0; k < 4; ++k) wrong += bytes[at++] != pixel[k];
      }
    }
    EXPECT_EQ(wrong, 0u) << "up " << up;
  }
}

TEST_F(PrintRaster, TheTiffIsReadBack) {
  const SheetOptions options = sheet(52, 61, 5, 150);
  const InkImage inks = patterned_inks(options);
  write_print_tiff(folder_ / "print.tif", inks, device_profile(), options);
  const CmykFile file = read_cmyk_tiff(folder_ / "print.tif");
  EXPECT_EQ(file.dpi, 150);
  EXPECT_EQ(file.inks.width_px, inks.width_px);
  EXPECT_EQ(file.inks.height_px, inks.height_px);
  EXPECT_EQ(file.inks.cmyk, inks.cmyk);
}

TEST_F(PrintRaster, ATiffIsSeenAsItsOrientationWantsIt) {
  const SheetOptions options = sheet(52, 61, 5, 150);
  const InkImage inks = patterned_inks(options);
  const std::string path = (folder_ / "print.tif").string();
  const auto turned_by = [&](int orientation) {
    write_print_tiff(path, inks, device_profile(), options);
    TIFF* tiff = TIFFOpen(path.c_str(), "r+");
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, orientation);
    TIFFRewriteDirectory(tiff);
    TIFFClose(tiff);
    return read_cmyk_tiff(path).inks;
  };
  const int right = inks.width_px - 1, bottom = inks.height_px - 1;
  const auto same = [&](const InkImage& a, int ax, int ay, int x, int y) {
    return std::equal(a.pixel(ax, ay), a.pixel(ax, ay) + 4, inks.pixel(x, y));
  };
  const InkImage half = turned_by(ORIENTATION_BOTRIGHT), quarter = turned_by(ORIENTATION_RIGHTTOP);
  ASSERT_EQ(quarter.width_px, inks.height_px);
  std::size_t wrong = 0;
  for (int y = 0; y <= bottom; ++y)
    for (int x = 0; x <= right; ++x) {
      wrong += !same(half, right - x, bottom - y, x, y);
      // Its first row is the picture's right side, its first column the top.
      wrong += !same(quarter, bottom - y, x, x, y);
    }
  EXPECT_EQ(wrong, 0U);
}

TEST_F(PrintRaster, TheTiffsProfileIsReadBack) {
  const SheetOptions options = sheet(52, 61, 5, 150);
  write_print_tiff(folder_ / "print.tif", patterned_inks(options), device_profile(), options);
  EXPECT_EQ(read_cmyk_tiff(folder_ / "print.tif").profile, device_profile());
}

TEST_F(PrintRaster, ResolutionsInCentimetresAreConverted) {
  const SheetOptions options = sheet(52, 61, 5, 150);
  const std::string path = (folder_ / "print.tif").string();
  write_print_tiff(path, patterned_inks(options), device_profile(), options);
  TIFF* tiff = TIFFOpen(path.c_str(), "r+");
  TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_CENTIMETER);
  TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 100.0F);
  TIFFSetField(tiff, TIFFTAG_YRESOLUTION, 100.0F);
  TIFFRewriteDirectory(tiff);
  TIFFClose(tiff);
  EXPECT_NEAR(read_cmyk_tiff(path).dpi, 254, 1e-3);
}

TEST_F(PrintRaster, ThreeOrFiveInksAreNotFour) {
  for (const int inks : {3, 5}) {
    const std::string path = (folder_ / "inks.tif").string();
    TIFF* tiff = TIFFOpen(path.c_str(), "w");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 4);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 3);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, inks);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_SEPARATED);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    std::uint8_t row[20] = {};
    for (std::uint32_t y = 0; y < 3; ++y) TIFFWriteScanline(tiff, row, y, 0);
    TIFFClose(tiff);
    EXPECT_THROW(read_cmyk_tiff(path), InputError) << inks;
  }
}

// Three rows of one run each, of which the second is told to be longer.
TEST_F(PrintRaster, RowsThatDoNotComeOutAreWarnedOf) {
  const std::string path = (folder_ / "inks.tif").string();
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 4);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 3);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 4);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_SEPARATED);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_PACKBITS);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 3);
  std::uint8_t row[16];
  for (std::uint32_t y = 0; y < 3; ++y) {
    std::fill(std::begin(row), std::end(row), std::uint8_t(10 * y));
    TIFFWriteScanline(tiff, row, y, 0);
  }
  TIFFClose(tiff);
  const auto warnings_of_reading = [&] {
    const RunContext context;
    const RunScope scope(context);
    EXPECT_EQ(read_cmyk_tiff(path).inks.pixel(3, 1)[3], 10);
    return context.warnings();
  };
  EXPECT_TRUE(warnings_of_reading().empty());
  auto bytes = read_file(path);
  constexpr std::size_t kSecondRun = 8 + 2;
  ASSERT_EQ(bytes[kSecondRun], 257 - 16);
  bytes[kSecondRun] = 257 - 20;
  write_file(path, bytes.data(), bytes.size());
  const auto warnings = warnings_of_reading();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("inks.tif: its data are damaged"), std::string::npos);
}

TEST_F(PrintRaster, OtherFilesAreNoInks) {
  const SheetOptions options = sheet(52, 61, 5, 150);
  std::ofstream(folder_ / "text.tif") << "II*";
  write_print_tiff(folder_ / "print.tif", patterned_inks(options), {}, options);
  auto bytes = read_file(folder_ / "print.tif");
  bytes.resize(bytes.size() / 2);
  std::ofstream(folder_ / "half.tif", std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  for (const char* name : {"text.tif", "half.tif", "missing.tif"})
    EXPECT_THROW(read_cmyk_tiff(folder_ / name), InputError) << name;
}

TEST_F(PrintRaster, TiffinfoAcceptsTheTiff) {
  if (!has_tool("tiffinfo")) GTEST_SKIP() << "needs tiffinfo";
  const SheetOptions options = sheet(210, 297, 10, 72);
  write_print_tiff(folder_ / "print.tif", patterned_inks(options), device_profile(), options);
  const auto [status, said] = run_tool("tiffinfo -D " + (folder_ / "print.tif").string());
  EXPECT_EQ(status, 0) << said;
  EXPECT_EQ(said.find("Warning"), std::string::npos) << said;
  EXPECT_NE(said.find("Resolution: 72, 72 pixels/inch"), std::string::npos) << said;
  EXPECT_NE(said.find("separated"), std::string::npos) << said;
  EXPECT_NE(said.find("ICC Profile: <present>"), std::string::npos) << said;
}

TEST_F(PrintRaster, ImageMagickFindsTheProfileInTheTiff) {
  if (!has_tool("identify")) GTEST_SKIP() << "needs identify";
  const SheetOptions options = sheet(52, 61, 5, 150);
  write_print_tiff(folder_ / "print.tif", patterned_inks(options), device_profile(), options);
  const auto [status, said] = run_tool("identify -format '%[colorspace] %x %[profile:icc]' " +
                                       (folder_ / "print.tif").string());
  EXPECT_EQ(status, 0) << said;
  EXPECT_NE(said.find("CMYK 150"), std::string::npos) << said;
  EXPECT_NE(said.find("hydrodip device formula"), std::string::npos) << said;
}

TEST_F(PrintRaster, TheSameInputGivesTheSameTiff) {
  const SheetOptions options = sheet(52, 61, 5, 150);
  write_print_tiff(folder_ / "a.tif", patterned_inks(options), device_profile(), options);
  write_print_tiff(folder_ / "b.tif", patterned_inks(options), device_profile(), options);
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
  const auto tiff = [&](const std::filesystem::path& path) {
    write_print_tiff(path, patterned_inks(options), {}, options);
  };
  const auto png = [&](const std::filesystem::path& path) {
    write_print_png(path, patterned_image(options), options);
  };
  std::ofstream(folder_ / "file") << "x";
  for (const std::filesystem::path& path :
       {folder_ / "missing" / "print", folder_ / "file" / "print", folder_.path()}) {
    for (const std::function<void(const std::filesystem::path&)>& writer :
         {std::function<void(const std::filesystem::path&)>(tiff),
          std::function<void(const std::filesystem::path&)>(png)}) {
      try {
        writer(path);
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
    EXPECT_THROW(write_print_tiff("/dev/full", patterned_inks(options), {}, options), InputError);
    EXPECT_THROW(write_print_png("/dev/full", image, options), InputError);
  }
}

TEST_F(PrintRaster, ImagesOfAnotherSheetAreRefused) {
  const SheetOptions options = sheet(80, 90, 10, 72);
  const Image image = blank_image(sheet(80, 100, 10, 72));
  EXPECT_THROW(
      write_print_tiff(folder_ / "x.tif", InkImage(image.width_px, image.height_px), {}, options),
      InputError);
  EXPECT_THROW(write_print_png(folder_ / "x.png", image, options), InputError);
}

}  // namespace
}  // namespace hydrodip
