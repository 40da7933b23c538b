#include "image/files.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>

#include <jpeglib.h>

#include <cstdlib>
#include <random>

#include "base/error.h"
#include "base/file.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

using Bytes = std::vector<std::uint8_t>;

Image random_image(int width, int height, bool opaque) {
  std::mt19937 random(3);
  Image image(width, height);
  for (auto& byte : image.rgba) byte = std::uint8_t(random());
  for (std::size_t i = 3; opaque && i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

// A PNG of any kind, written by libpng straight from packed rows.
struct PngKind {
  int color_type = PNG_COLOR_TYPE_RGB;
  int bit_depth = 8;
  int interlace = PNG_INTERLACE_NONE;
  std::vector<png_color> palette;
  Bytes palette_alpha;
};

Bytes raw_png(int width, int height, const PngKind& kind, std::vector<Bytes> rows) {
  Bytes out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp p, png_bytep data, png_size_t size) {
        auto* bytes = static_cast<Bytes*>(png_get_io_ptr(p));
        bytes->insert(bytes->end(), data, data + size);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), kind.bit_depth, kind.color_type,
               kind.interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!kind.palette.empty()) {
    png_set_PLTE(png, info, kind.palette.data(), int(kind.palette.size()));
  }
  if (!kind.palette_alpha.empty()) {
    png_set_tRNS(png, info, kind.palette_alpha.data(), int(kind.palette_alpha.size()), nullptr);
  }
  std::vector<png_bytep> pointers;
  for (Bytes& row : rows) pointers.push_back(row.data());
  png_write_info(png, info);
  png_write_image(png, pointers.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

Bytes jpeg_of(const Image& image, int quality, int dpi) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &data, &size);
  info.image_width = JDIMENSION(image.width_px);
  info.image_height = JDIMENSION(image.height_px);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  info.density_unit = 1;
  info.X_density = info.Y_density = UINT16(dpi);
  jpeg_start_compress(&info, TRUE);
  for (int y = 0; y < image.height_px; ++y) {
    Bytes row;
    for (int x = 0; x < image.width_px; ++x) {
      row.insert(row.end(), image.pixel(x, y), image.pixel(x, y) + 3);
    }
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&info, &pointer, 1);
  }
  jpeg_finish_compress(&info);
  const Bytes out(data, data + size);
  jpeg_destroy_compress(&info);
  std::free(data);
  return out;
}

std::array<int, 4> rgba_at(const Image& image, int x, int y) {
  const std::uint8_t* p = image.pixel(x, y);
  return {p[0], p[1], p[2], p[3]};
}

TEST(Png, RoundTripWithAndWithoutAlpha) {
  for (const bool opaque : {false, true}) {
    const Image image = random_image(37, 21, opaque);
    const Bytes bytes = encode_png(image, 300);
    EXPECT_EQ(bytes[25], opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA);
    const Image back = decode_image(bytes, "memory");
    EXPECT_EQ(back.width_px, 37);
    EXPECT_EQ(back.height_px, 21);
    EXPECT_EQ(back.rgba, image.rgba);
    EXPECT_EQ(encode_png(image, 300), bytes);
  }
}

TEST(Png, RecordsDpiAndSrgb) {
  const Image image = random_image(2, 2, true);
  for (const double dpi : {72.0, 96.0, 150.0, 300.0, 600.0, 1200.0}) {
    EXPECT_EQ(recorded_dpi(encode_png(image, dpi)), dpi);
  }
  EXPECT_EQ(recorded_dpi(encode_png(image)), 0);
  const Bytes bytes = encode_png(image);
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_NE(text.find("sRGB"), std::string::npos);
  EXPECT_EQ(text.find("tIME"), std::string::npos);
}

TEST(Png, SavesToAFileAndLoads) {
  const TemporaryFolder folder;
  const auto path = folder / "image.png";
  const Image image = random_image(5, 4, false);
  save_png(path, image, 300);
  EXPECT_EQ(load_image(path).rgba, image.rgba);
  EXPECT_EQ(recorded_dpi(read_file(path)), 300);
  std::filesystem::remove(path);
  EXPECT_THROW(load_image(path), InputError);
  EXPECT_THROW(save_png(path / "no" / "folder.png", image), InputError);
}

TEST(Png, SixteenBitIsReducedByRounding) {
  PngKind kind;
  kind.bit_depth = 16;
  const Bytes row = {0xff, 0xff, 0x80, 0x80, 0x12, 0xf0};
  const Image image = decode_image(raw_png(1, 1, kind, {row}), "memory");
  // 0x12f0 / 257 = 18.87
  EXPECT_EQ(rgba_at(image, 0, 0), (std::array<int, 4>{255, 128, 19, 255}));
}

TEST(Png, PaletteWithTransparency) {
  PngKind kind;
  kind.color_type = PNG_COLOR_TYPE_PALETTE;
  kind.bit_depth = 2;
  kind.palette = {{10, 20, 30}, {40, 50, 60}, {70, 80, 90}};
  kind.palette_alpha = {255, 100};
  const Image image = decode_image(raw_png(3, 1, kind, {{0b00011000}}), "memory");
  EXPECT_EQ(rgba_at(image, 0, 0), (std::array<int, 4>{10, 20, 30, 255}));
  EXPECT_EQ(rgba_at(image, 1, 0), (std::array<int, 4>{40, 50, 60, 100}));
  EXPECT_EQ(rgba_at(image, 2, 0), (std::array<int, 4>{70, 80, 90, 255}));
}

TEST(Png, GreyOfOneBitAndGreyWithAlpha) {
  PngKind kind;
  kind.color_type = PNG_COLOR_TYPE_GRAY;
  kind.bit_depth = 1;
  const Image bits = decode_image(raw_png(2, 1, kind, {{0b01000000}}), "memory");
  EXPECT_EQ(rgba_at(bits, 0, 0), (std::array<int, 4>{0, 0, 0, 255}));
  EXPECT_EQ(rgba_at(bits, 1, 0), (std::array<int, 4>{255, 255, 255, 255}));
  kind.color_type = PNG_COLOR_TYPE_GRAY_ALPHA;
  kind.bit_depth = 8;
  const Image grey = decode_image(raw_png(1, 1, kind, {{77, 88}}), "memory");
  EXPECT_EQ(rgba_at(grey, 0, 0), (std::array<int, 4>{77, 77, 77, 88}));
}

TEST(Png, InterlacedEqualsPlain) {
  const Image image = random_image(19, 23, true);
  std::vector<Bytes> rows;
  for (int y = 0; y < 23; ++y) {
    Bytes row;
    for (int x = 0; x < 19; ++x) {
      row.insert(row.end(), image.pixel(x, y), image.pixel(x, y) + 3);
    }
    rows.push_back(row);
  }
  PngKind kind;
  kind.interlace = PNG_INTERLACE_ADAM7;
  EXPECT_EQ(decode_image(raw_png(19, 23, kind, rows), "memory").rgba, image.rgba);
}

TEST(Jpeg, PlainColoursAndDpi) {
  Image image(16, 8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) {
      const std::uint8_t pixel[4] = {200, 100, 50, 255};
      std::copy_n(pixel, 4, image.pixel(x, y));
    }
  }
  const Bytes bytes = jpeg_of(image, 95, 240);
  EXPECT_EQ(recorded_dpi(bytes), 240);
  const Image back = decode_image(bytes, "memory");
  ASSERT_EQ(back.width_px, 16);
  ASSERT_EQ(back.height_px, 8);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    EXPECT_NEAR(back.rgba[i], image.rgba[i], 3);
  }
}

TEST(Decode, RefusesWhatIsNoImage) {
  EXPECT_THROW(decode_image({}, "empty"), InputError);
  EXPECT_THROW(decode_image({'G', 'I', 'F', '8', '9', 'a'}, "gif"), InputError);
  std::mt19937 random(5);
  Bytes noise(1000);
  for (auto& byte : noise) byte = std::uint8_t(random());
  try {
    decode_image(noise, "noise.png");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("noise.png"), std::string::npos);
  }
}

TEST(Decode, RefusesEveryTruncation) {
  const Image image = random_image(13, 11, true);
  for (const Bytes& whole : {encode_png(image, 300), jpeg_of(image, 90, 300)}) {
    // A JPEG without its two last bytes, the end marker, still shows every pixel.
    for (std::size_t size = 0; size + 4 < whole.size(); ++size) {
      const Bytes cut(whole.begin(), whole.begin() + std::ptrdiff_t(size));
      EXPECT_THROW(decode_image(cut, "cut"), InputError) << size << " of " << whole.size();
    }
  }
}

TEST(Decode, DamageEndsInAnImageOrARefusal) {
  const Image image = random_image(31, 17, false);
  std::mt19937 random(11);
  for (const Bytes& whole : {encode_png(image, 300), jpeg_of(image, 50, 300)}) {
    for (int i = 0; i < 500; ++i) {
      Bytes bytes = whole;
      bytes[random() % bytes.size()] ^= std::uint8_t(1 + random() % 255);
      bytes[random() % bytes.size()] = std::uint8_t(random());
      try {
        const Image back = decode_image(bytes, "damaged");
        EXPECT_EQ(back.rgba.size(), 4 * std::size_t(back.width_px) * std::size_t(back.height_px));
      } catch (const InputError&) {
      }
      EXPECT_GE(recorded_dpi(bytes), 0);
    }
  }
}

TEST(Decode, RefusesForgedSizes) {
  Bytes bytes = encode_png(random_image(4, 4, true));
  bytes[18] = 0x7f;  // 32,516 px wide, for a file of a hundred bytes
  EXPECT_THROW(decode_image(bytes, "forged"), InputError);
  bytes[16] = 0x10;
  EXPECT_THROW(decode_image(bytes, "forged"), InputError);
}

TEST(Jpeg, WrittenAndReadAgainLooksTheSame) {
  Image image(37, 21);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      std::uint8_t* p = image.pixel(x, y);
      p[0] = std::uint8_t(6 * x), p[1] = std::uint8_t(10 * y), p[2] = 90, p[3] = 255;
    }
  }
  const Image again = decode_image(encode_jpeg(image, 95), "again.jpg");
  ASSERT_EQ(again.width_px, 37);
  ASSERT_EQ(again.height_px, 21);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) ASSERT_NEAR(again.rgba[i], image.rgba[i], 12);
  EXPECT_LT(encode_jpeg(image, 40).size(), encode_jpeg(image, 95).size());
  EXPECT_THROW(encode_jpeg(Image(), 90), InputError);
}

}  // namespace
}  // namespace hydrodip
