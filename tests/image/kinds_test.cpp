// Pictures of every kind, with their profiles and orientations; written here or by the libraries.
#include <gtest/gtest.h>
#include <lcms2.h>
#include <png.h>
#include <tiffio.h>
#include <webp/encode.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>

#include "base/error.h"
#include "base/file.h"
#include "base/run_scope.h"
#include "image/files.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Rgba = std::array<int, 4>;

Rgba at(const Image& image, int x, int y) {
  const std::uint8_t* p = image.pixel(x, y);
  return {p[0], p[1], p[2], p[3]};
}

constexpr Rgba kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kBlue{0, 0, 255, 255},
    kWhite{255, 255, 255, 255};

// Red, green above blue, white.
void expect_four(const Image& image) {
  ASSERT_EQ(image.width_px, 2);
  ASSERT_EQ(image.height_px, 2);
  EXPECT_EQ(at(image, 0, 0), kRed);
  EXPECT_EQ(at(image, 1, 0), kGreen);
  EXPECT_EQ(at(image, 0, 1), kBlue);
  EXPECT_EQ(at(image, 1, 1), kWhite);
}

Image four() {
  Image image(2, 2);
  image.rgba = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};
  return image;
}

void expect_every_cut_refused(const Bytes& whole, std::size_t needed) {
  for (std::size_t size = 0; size < needed; ++size)
    EXPECT_THROW(decode_image({whole.begin(), whole.begin() + std::ptrdiff_t(size)}, "cut"),
                 InputError)
        << size;
}

TEST(Webp, LosslessWithAlpha) {
  Image image = four();
  image.rgba[3] = 77;
  std::uint8_t* data = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(image.rgba.data(), 2, 2, 8, &data);
  const Bytes bytes(data, data + size);
  WebPFree(data);
  EXPECT_EQ(decode_image(bytes, "a.webp").rgba, image.rgba);
  expect_every_cut_refused(bytes, bytes.size() - 1);
}

// Its decoder is done before the last byte. The byte that fills up an odd length is no part of it.
TEST(Webp, EveryCutIsRefused) {
  Image image(40, 30);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = i % 4 == 3 ? 255 : std::uint8_t(i * i / 7);
  for (const float quality : {30.F, 80.F, 81.F, 82.F, 83.F}) {
    std::uint8_t* data = nullptr;
    const std::size_t size = WebPEncodeRGBA(image.rgba.data(), image.width_px, image.height_px,
                                            4 * image.width_px, quality, &data);
    const Bytes bytes(data, data + size);
    WebPFree(data);
    const std::size_t odd = bytes[16] % 2;
    EXPECT_NO_THROW(decode_image(bytes, "a.webp"));
    EXPECT_NO_THROW(
        decode_image({bytes.begin(), bytes.end() - std::ptrdiff_t(odd)}, "unfilled.webp"));
    expect_every_cut_refused(bytes, bytes.size() - odd);
  }
}

TEST(Gif, WithPaletteAndTransparency) {
  Bytes bytes = {'G', 'I', 'F',  '8',  '9',  'a', 2,  0, 2,   0,   0x91, 0,   0,
                 255, 0,   0,    0,    255,  0,   0,  0, 255, 255, 255,  255,  // palette
                 ',', 0,   0,    0,    0,    2,   0,  2, 0,   0,               // the picture
                 2,   3,   0x44, 0x34, 0x05, 0,   ';'};
  expect_four(decode_image(bytes, "a.gif"));
  const Bytes control = {'!', 0xf9, 4, 1, 0, 0, 3, 0};  // white is transparent
  bytes.insert(bytes.begin() + 25, control.begin(), control.end());
  EXPECT_EQ(at(decode_image(bytes, "a.gif"), 1, 1)[3], 0);
  expect_every_cut_refused(bytes, bytes.size() - 3);
}

// Little-endian.
void put(Bytes& out, std::uint32_t value, int count) {
  for (; count > 0; --count, value >>= 8U) out.push_back(std::uint8_t(value));
}

Bytes bmp(std::uint32_t bits, int height, std::uint32_t compression, const Bytes& palette,
          const Bytes& data) {
  Bytes out = {'B', 'M'};
  put(out, 0, 8);
  put(out, std::uint32_t(54 + palette.size()), 4);
  put(out, 40, 4);
  put(out, 2, 4);
  put(out, std::uint32_t(height), 4);
  put(out, 1, 2);
  put(out, bits, 2);
  put(out, compression, 4);
  put(out, 0, 20);
  out.insert(out.end(), palette.begin(), palette.end());
  out.insert(out.end(), data.begin(), data.end());
  return out;
}

TEST(Bmp, OfEveryDepth) {
  const Bytes palette = {0, 0, 255, 0, 0, 255, 0, 0, 255, 0, 0, 0, 255, 255, 255, 0};
  Bytes padded = palette;
  padded.resize(4 * 256);
  const Bytes rows24 = {255, 0, 0, 255, 255, 255, 0, 0, 0, 0, 255, 0, 255, 0, 0, 0};
  expect_four(decode_image(bmp(24, 2, 0, {}, rows24), "a.bmp"));
  expect_every_cut_refused(bmp(24, 2, 0, {}, rows24), 54 + 16);
  expect_four(decode_image(bmp(8, 2, 0, padded, {2, 3, 0, 0, 0, 1, 0, 0}), "a.bmp"));
  // From the top, with channel masks for 5, 6 and 5 bits.
  const Bytes masks = {0, 0xf8, 0, 0, 0xe0, 7, 0, 0, 0x1f, 0, 0, 0};
  expect_four(
      decode_image(bmp(16, -2, 3, masks, {0, 0xf8, 0xe0, 7, 0x1f, 0, 0xff, 0xff}), "a.bmp"));
  // In runs: two literal ones and the end of the line, then one by one.
  expect_four(decode_image(bmp(8, 2, 1, padded, {1, 2, 1, 3, 0, 0, 1, 0, 1, 1, 0, 1}), "a.bmp"));
  Bytes palette16 = palette;
  palette16.resize(4 * 16);
  expect_four(decode_image(bmp(4, 2, 0, palette16, {0x23, 0, 0, 0, 0x01, 0, 0, 0}), "a.bmp"));
}

// Of steps to the right and up that come to more than an int holds, and a run behind them.
TEST(Bmp, NoRunLeavesThePicture) {
  Bytes palette(4 * 256, 255);
  std::fill_n(palette.begin(), 4, std::uint8_t(0));
  for (const Bytes& step : {Bytes{0, 2, 255, 0}, Bytes{0, 2, 0, 255}, Bytes{255, 1}}) {
    const std::size_t enough = (std::size_t(1) << 31U) / 255 + 2;
    Bytes data = step;
    data.reserve(step.size() * enough + 4);
    while (data.size() < step.size() * enough) {
      const std::size_t more = std::min(data.size(), step.size() * enough - data.size());
      data.insert(data.end(), data.begin(), data.begin() + std::ptrdiff_t(more));
    }
    data.insert(data.end(), {1, 1, 0, 1});
    const Image image = decode_image(bmp(8, 2, 1, palette, data), "a.bmp");
    EXPECT_EQ(at(image, 0, 0), (Rgba{0, 0, 0, 255}));
    EXPECT_EQ(at(image, 1, 1), step[0] == 255 ? kWhite : (Rgba{0, 0, 0, 255}));
  }
}

TEST(Tga, PlainAndInRunsFromEitherEdge) {
  Bytes plain = {0, 0,  2, 0,   0, 0, 0,   0,   0,   0, 0, 0,   2, 0,   2,
                 0, 24, 0, 255, 0, 0, 255, 255, 255, 0, 0, 255, 0, 255, 0};
  expect_four(decode_image(plain, "a.tga"));
  expect_every_cut_refused(plain, plain.size());
  const Bytes runs = {
      0,    0,   10, 0,    0,    0,    0,   0,   0,   0,  0,   0, 2,   0,
      2,    0,   32, 0x28, 0x01, 0,    0,   255, 255, 0,  255, 0, 255,  // red, green
      0x80, 255, 0,  0,    255,  0x80, 255, 255, 255, 255};             // blue, white
  expect_four(decode_image(runs, "a.tga"));
}

// Of 8 bits, red, green and blue, and a fourth sample as alpha, straight.
TIFF* new_tiff(const std::string& path, int width, int height, int samples) {
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  const std::uint16_t extra[] = {EXTRASAMPLE_UNASSALPHA};
  if (samples == 4) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, extra);
  return tiff;
}

TEST(Tiff, WithStraightAlphaAndProfileOfItsOwn) {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.tif").string();
  Image image = four();
  TIFF* tiff = new_tiff(path, 2, 2, 4);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
  for (std::uint32_t y = 0; y < 2; ++y) TIFFWriteScanline(tiff, image.pixel(0, int(y)), y, 0);
  TIFFClose(tiff);
  expect_four(load_image(path));
}

// Twelve entries and the rows behind them, each of a run and of pixels that differ.
struct PackedTiff {
  Bytes bytes;
  std::vector<std::size_t> lengths_at;  // of the bytes that say how long a run is
};
PackedTiff packed_tiff(int rows_per_strip) {
  constexpr std::uint32_t kWide = 40, kHigh = 6, kRowBytes = 23;
  const std::uint32_t strips = kHigh / std::uint32_t(rows_per_strip);
  PackedTiff tiff;
  Bytes& bytes = tiff.bytes;
  const auto put = [&](std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(std::uint8_t(value >> (8 * i)));
  };
  const std::uint32_t arrays = 8 + 2 + 9 * 12 + 4, data = arrays + (strips > 1 ? 8 * strips : 0);
  const std::uint32_t strip_bytes = kRowBytes * kHigh / strips;
  put(0x2a4949, 4);
  put(8, 4);
  put(9, 2);
  const auto entry = [&](std::uint32_t tag, std::uint32_t count, std::uint32_t value) {
    put(tag, 2);
    put(4, 2);
    put(count, 4);
    put(value, 4);
  };
  entry(TIFFTAG_IMAGEWIDTH, 1, kWide);
  entry(TIFFTAG_IMAGELENGTH, 1, kHigh);
  entry(TIFFTAG_BITSPERSAMPLE, 1, 8);
  entry(TIFFTAG_COMPRESSION, 1, COMPRESSION_PACKBITS);
  entry(TIFFTAG_PHOTOMETRIC, 1, PHOTOMETRIC_MINISBLACK);
  entry(TIFFTAG_STRIPOFFSETS, strips, strips > 1 ? arrays : data);
  entry(TIFFTAG_SAMPLESPERPIXEL, 1, 1);
  entry(TIFFTAG_ROWSPERSTRIP, 1, std::uint32_t(rows_per_strip));
  entry(TIFFTAG_STRIPBYTECOUNTS, strips, strips > 1 ? arrays + 4 * strips : strip_bytes);
  put(0, 4);
  if (strips > 1) {
    for (std::uint32_t i = 0; i < strips; ++i) put(data + i * strip_bytes, 4);
    for (std::uint32_t i = 0; i < strips; ++i) put(strip_bytes, 4);
  }
  for (std::uint32_t y = 0; y < kHigh; ++y) {
    tiff.lengths_at.insert(tiff.lengths_at.end(), {bytes.size(), bytes.size() + 2});
    put(257 - 20, 1);
    put(10 * y, 1);
    put(20 - 1, 1);
    for (std::uint32_t x = 0; x < 20; ++x) put(9 * x + y, 1);
  }
  return tiff;
}

TEST(Tiff, RunsThatDoNotFillTheirRowsAreNotTakenSilently) {
  for (const int rows : {6, 2}) {
    const PackedTiff whole = packed_tiff(rows);
    const Image image = decode_image(whole.bytes, "a.tif");
    EXPECT_EQ(at(image, 19, 3), (Rgba{30, 30, 30, 255}));
    EXPECT_EQ(at(image, 39, 3), (Rgba{9 * 19 + 3, 9 * 19 + 3, 9 * 19 + 3, 255}));
    expect_every_cut_refused(whole.bytes, whole.bytes.size());
    for (const std::size_t at : whole.lengths_at)
      for (int bit = 0; bit < 8; ++bit) {
        Bytes damaged = whole.bytes;
        damaged[at] = std::uint8_t(damaged[at] ^ 1 << bit);
        const RunContext context;
        const RunScope scope(context);
        try {
          decode_image(damaged, "a.tif");
          EXPECT_EQ(context.warnings().size(), 1U)
              << rows << " rows, byte " << at << " bit " << bit;
        } catch (const InputError&) {
          // Told even better.
        }
      }
  }
}

// A fax has no other sign of damage than rows of another length.
TEST(Tiff, FaxesWithRowsOfAnotherLengthAreWarnedOf) {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.tif").string();
  constexpr int kWide = 64, kHigh = 16;
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kWide);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kHigh);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISWHITE);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_CCITTFAX4);
  for (std::uint32_t y = 0; y < kHigh; ++y) {
    Bytes row(kWide / 8);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = std::uint8_t(37 * i * (y + 3));
    TIFFWriteScanline(tiff, row.data(), y, 0);
  }
  TIFFClose(tiff);
  const auto warnings_of = [](const Bytes& bytes) {
    const RunContext context;
    const RunScope scope(context);
    decode_image(bytes, "a.tif");
    return context.warnings();
  };
  Bytes bytes = read_file(path);
  EXPECT_TRUE(warnings_of(bytes).empty());
  for (std::size_t i = 20; i < 40; ++i) bytes[i] = std::uint8_t(0x5a * i);  // rows, behind 8 bytes
  ASSERT_EQ(warnings_of(bytes).size(), 1U);
  EXPECT_NE(warnings_of(bytes)[0].find("a.tif: its data are damaged"), std::string::npos);
}

// How large a picture of an orientation is stored, and where a pixel that is stored at (x, y) is
// seen: column and row.
struct Stored {
  int orientation, width, height;
  std::function<std::array<int, 2>(int x, int y)> seen_at;
};

TEST(Tiff, IsSeenAsItsOrientationSays) {
  constexpr int kWide = 3, kHigh = 2;
  const std::vector<Stored> ways = {{1, 3, 2,
                                     [](int x, int y) {
                                       return std::array{x, y};
                                     }},
                                    {2, 3, 2,
                                     [](int x, int y) {
                                       return std::array{kWide - 1 - x, y};
                                     }},
                                    {3, 3, 2,
                                     [](int x, int y) {
                                       return std::array{kWide - 1 - x, kHigh - 1 - y};
                                     }},
                                    {4, 3, 2,
                                     [](int x, int y) {
                                       return std::array{x, kHigh - 1 - y};
                                     }},
                                    // A stored row is a column that is seen: from the left, from
                                    // the right; from above, from below.
                                    {5, 2, 3,
                                     [](int x, int y) {
                                       return std::array{y, x};
                                     }},
                                    {6, 2, 3,
                                     [](int x, int y) {
                                       return std::array{kWide - 1 - y, x};
                                     }},
                                    {7, 2, 3,
                                     [](int x, int y) {
                                       return std::array{kWide - 1 - y, kHigh - 1 - x};
                                     }},
                                    {8, 2, 3, [](int x, int y) {
                                       return std::array{y, kHigh - 1 - x};
                                     }}};
  const TemporaryFolder folder;
  const std::string path = (folder / "a.tif").string();
  for (const Stored& way : ways)
    for (const int samples : {3, 4})
      for (const std::uint32_t rows : {1U, 3U}) {
        SCOPED_TRACE(testing::Message() << way.orientation << " " << samples << " " << rows);
        TIFF* tiff = new_tiff(path, way.width, way.height, samples);
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, rows);
        TIFFSetField(tiff, TIFFTAG_ORIENTATION, way.orientation);
        for (int y = 0; y < way.height; ++y) {
          Bytes row;
          for (int x = 0; x < way.width; ++x) {
            const auto [column, line] = way.seen_at(x, y);
            row.insert(row.end(), {std::uint8_t(50 * column), std::uint8_t(100 * line), 7});
            if (samples == 4) row.push_back(255);
          }
          TIFFWriteScanline(tiff, row.data(), std::uint32_t(y), 0);
        }
        TIFFClose(tiff);
        const Image image = load_image(path);
        ASSERT_EQ(image.width_px, kWide);
        ASSERT_EQ(image.height_px, kHigh);
        for (int y = 0; y < kHigh; ++y)
          for (int x = 0; x < kWide; ++x)
            EXPECT_EQ(at(image, x, y), (Rgba{50 * x, 100 * y, 7, 255}));
      }
}

// ---- colour spaces and orientation --------------------------------------------------------------

// A PNG of one colour with a chunk of the caller's before the pixels.
Bytes png_with(const Rgba& color, const std::function<void(png_structp, png_infop)>& extra) {
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
  png_set_IHDR(png, info, 1, 1, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  extra(png, info);
  png_byte row[3] = {png_byte(color[0]), png_byte(color[1]), png_byte(color[2])};
  png_write_info(png, info);
  png_bytep rows[] = {row};
  png_write_image(png, rows);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

Bytes profile_of(const cmsCIExyYTRIPLE& primaries) {
  const cmsFloat64Number curve[] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  cmsToneCurve* tone = cmsBuildParametricToneCurve(nullptr, 4, curve);
  cmsToneCurve* curves[] = {tone, tone, tone};
  const cmsCIExyY white{0.3127, 0.3290, 1};
  cmsHPROFILE profile = cmsCreateRGBProfile(&white, &primaries, curves);
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  Bytes bytes(size);
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  cmsFreeToneCurve(tone);
  return bytes;
}

constexpr cmsCIExyYTRIPLE kP3{{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}};
constexpr cmsCIExyYTRIPLE kSrgb{{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};

// By the matrix between the two sets of primaries (same white, same curve).
Rgba p3_in_srgb(const Rgba& color) {
  const double m[3][3] = {{1.2249401763, -0.2249401763, 0},
                          {-0.0420569547, 1.0420569547, 0},
                          {-0.0196375546, -0.0786360454, 1.0982736001}};
  Rgba out{0, 0, 0, 255};
  for (std::size_t i = 0; i < 3; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
      sum += m[i][k] * double(srgb8_to_linear(std::uint8_t(color[k])));
    out[i] = linear_to_srgb8(float(std::clamp(sum, 0.0, 1.0)));
  }
  return out;
}

void expect_near(const Rgba& is, const Rgba& wanted) {
  for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(is[c], wanted[c], 1) << c;
}

TEST(Profile, DisplayP3IsBroughtToSrgb) {
  const Rgba color{180, 120, 90, 255};
  const Bytes profile = profile_of(kP3);
  const Bytes icc = png_with(color, [&](png_structp png, png_infop info) {
    png_set_iCCP(png, info, "P3", 0, profile.data(), png_uint_32(profile.size()));
  });
  expect_near(at(decode_image(icc, "p3.png"), 0, 0), p3_in_srgb(color));
  EXPECT_NE(p3_in_srgb(color), color);
}

TEST(Profile, CicpOfDisplayP3Counts) {
  const Rgba color{180, 120, 90, 255};
  const Bytes bytes = png_with(color, [](png_structp png, png_infop info) {
    png_unknown_chunk chunk = {};
    std::memcpy(chunk.name, "cICP", 5);
    png_byte data[] = {12, 13, 0, 1};
    chunk.data = data;
    chunk.size = sizeof data;
    chunk.location = PNG_HAVE_IHDR;
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, nullptr, 0);
    png_set_unknown_chunks(png, info, &chunk, 1);
  });
  expect_near(at(decode_image(bytes, "cicp.png"), 0, 0), p3_in_srgb(color));
}

TEST(Profile, SrgbLeavesEveryByteAlone) {
  const Bytes profile = profile_of(kSrgb);
  for (const Rgba& color : {Rgba{1, 2, 3, 255}, Rgba{100, 150, 200, 255}, Rgba{255, 254, 0, 255}}) {
    const Bytes icc = png_with(color, [&](png_structp png, png_infop info) {
      png_set_iCCP(png, info, "sRGB", 0, profile.data(), png_uint_32(profile.size()));
    });
    EXPECT_EQ(at(decode_image(icc, "srgb.png"), 0, 0), color);
  }
}

// EXIF with nothing but an orientation, behind a JPEG's first marker.
Bytes turned_jpeg(const Image& image, int orientation) {
  Bytes jpeg = encode_jpeg(image, 95);
  Bytes exif = {0xff, 0xe1, 0, 34, 'E', 'x', 'i', 'f', 0, 0,
                'M',  'M',  0, 42, 0,   0,   0,   8,   0, 1,
                1,    0x12, 0, 3,  0,   0,   0,   1,   0, std::uint8_t(orientation),
                0,    0,    0, 0,  0,   0};
  jpeg.insert(jpeg.begin() + 2, exif.begin(), exif.end());
  return jpeg;
}

TEST(Exif, OrientationsShowTheSamePicture) {
  // The scene: red on the upper left, green on the upper right, blue below; 32 by 16.
  const auto scene = [](int x, int y) { return y >= 8 ? kBlue : x < 16 ? kRed : kGreen; };
  // Where the stored pixel (x, y) belongs in the scene.
  const auto place = [](int orientation, int x, int y) -> std::array<int, 2> {
    switch (orientation) {
      case 2:
        return {31 - x, y};
      case 3:
        return {31 - x, 15 - y};
      case 4:
        return {x, 15 - y};
      case 5:
        return {y, x};
      case 6:
        return {31 - y, x};
      case 7:
        return {31 - y, 15 - x};
      case 8:
        return {y, 15 - x};
      default:
        return {x, y};
    }
  };
  for (int orientation = 1; orientation <= 8; ++orientation) {
    Image stored = orientation < 5 ? Image(32, 16) : Image(16, 32);
    for (int y = 0; y < stored.height_px; ++y) {
      for (int x = 0; x < stored.width_px; ++x) {
        const auto [sx, sy] = place(orientation, x, y);
        for (std::size_t c = 0; c < 4; ++c) stored.pixel(x, y)[c] = std::uint8_t(scene(sx, sy)[c]);
      }
    }
    const Image seen = decode_image(turned_jpeg(stored, orientation), "a.jpg");
    ASSERT_EQ(seen.width_px, 32) << orientation;
    ASSERT_EQ(seen.height_px, 16) << orientation;
    for (const auto& [x, y] : {std::array<int, 2>{4, 3}, {28, 3}, {4, 13}, {28, 13}}) {
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(at(seen, x, y)[c], scene(x, y)[c], 12) << orientation << " " << x << " " << y;
    }
  }
}

TEST(Decode, BombsAreRefusedBeforeTheyAreUnpacked) {
  Bytes png = encode_png(four());
  png[18] = 0x7d, png[22] = 0x7d;  // 32,002 px a side
  png[24] = 1, png[25] = 0;        // one bit each
  png.resize(200000);
  try {
    decode_image(png, "bomb.png");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("GB of memory"), std::string::npos) << error.what();
  }
}

TEST(Decode, KindsThatAreNotReadAreNamed) {
  const auto said = [](const std::string& text) {
    try {
      decode_image({text.begin(), text.end()}, "a picture");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(said("8BPS....").find("Photoshop"), std::string::npos);
  EXPECT_NE(said("\xabKTX 20\xbb").find("KTX2"), std::string::npos);
  EXPECT_NE(said("<svg/>").find("SVG"), std::string::npos);
}

}  // namespace
}  // namespace hydrodip
