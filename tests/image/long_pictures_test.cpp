// Pictures of many rows: read in pieces, which must fit together, and given up in between.
#include <gif_lib.h>
#include <gtest/gtest.h>
#include <tiffio.h>
#include <webp/encode.h>

#include <cstdio>
// after cstdio, which it needs
#include <jpeglib.h>

#include <cstdlib>
#include <random>

#include "base/error.h"
#include "base/file.h"
#include "base/run_scope.h"
#include "contains.h"
#include "image/files.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Noise, so that no coder makes it small; opaque.
Image noise(int width_px, int height_px) {
  Image image(width_px, height_px);
  std::mt19937 random(7);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = i % 4 == 3 ? 255 : std::uint8_t(random() & 255);
  return image;
}

struct TiffLayout {
  std::uint32_t strip_rows = 0;  // 0: tiles of 32 x 32
  std::uint16_t compression = COMPRESSION_LZW;
  bool upside_down = false;
  std::uint16_t samples = 4;  // the first ones of each pixel
};

Bytes tiff(const Image& image, const TiffLayout& layout) {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.tif").string();
  TIFF* file = TIFFOpen(path.c_str(), "w");
  TIFFSetField(file, TIFFTAG_IMAGEWIDTH, image.width_px);
  TIFFSetField(file, TIFFTAG_IMAGELENGTH, image.height_px);
  TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, layout.samples);
  TIFFSetField(file, TIFFTAG_PHOTOMETRIC,
               layout.samples == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
  TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(file, TIFFTAG_COMPRESSION, layout.compression);
  const std::uint16_t extra[] = {EXTRASAMPLE_UNASSALPHA};
  if (layout.samples == 4) TIFFSetField(file, TIFFTAG_EXTRASAMPLES, 1, extra);
  if (layout.upside_down) TIFFSetField(file, TIFFTAG_ORIENTATION, ORIENTATION_BOTLEFT);
  const auto row = [&](int y) {
    return const_cast<std::uint8_t*>(
        image.pixel(0, layout.upside_down ? image.height_px - 1 - y : y));
  };
  if (layout.strip_rows > 0) {
    TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, layout.strip_rows);
    for (int y = 0; y < image.height_px; ++y) {
      Bytes line;
      for (int x = 0; x < image.width_px; ++x)
        line.insert(line.end(), row(y) + 4 * x, row(y) + 4 * x + layout.samples);
      TIFFWriteScanline(file, line.data(), std::uint32_t(y), 0);
    }
  } else {
    constexpr int kTile = 32;
    TIFFSetField(file, TIFFTAG_TILEWIDTH, kTile);
    TIFFSetField(file, TIFFTAG_TILELENGTH, kTile);
    for (int top = 0; top < image.height_px; top += kTile)
      for (int left = 0; left < image.width_px; left += kTile) {
        Bytes tile(std::size_t(4) * kTile * kTile);
        for (int y = 0; y < std::min(kTile, image.height_px - top); ++y)
          std::copy_n(row(top + y) + 4 * left, 4 * std::min(kTile, image.width_px - left),
                      &tile[std::size_t(4 * kTile * y)]);
        TIFFWriteTile(file, tile.data(), std::uint32_t(left), std::uint32_t(top), 0, 0);
      }
  }
  TIFFClose(file);
  return read_file(path);
}

TEST(LongPictures, TiffIsTheSameInStripsTilesAndUpsideDown) {
  const Image image = noise(70, 203);
  for (const std::uint32_t rows : {1, 7, 64, 100, 203, 0})
    for (const std::uint16_t compression : {COMPRESSION_NONE, COMPRESSION_LZW})
      for (const bool upside_down : {false, true})
        EXPECT_EQ(decode_image(tiff(image, {rows, compression, upside_down}), "a.tif").rgba,
                  image.rgba)
            << rows << " rows, compression " << compression << (upside_down ? ", upside down" : "");
}

// Without alpha, grey or not: in one strip by rows, in several by libtiff's own reader.
TEST(LongPictures, TiffInOneStripIsThatOfSeveral) {
  const Image image = noise(70, 203);
  for (const std::uint16_t samples : {1, 3})
    for (const std::uint16_t compression :
         {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS}) {
      const auto read = [&](std::uint32_t rows) {
        return decode_image(tiff(image, {rows, compression, false, samples}), "a.tif").rgba;
      };
      EXPECT_EQ(read(203), read(50)) << samples << " samples, compression " << compression;
      EXPECT_EQ(read(203)[0], image.rgba[0]);
    }
}

Bytes webp(const Image& image) {
  std::uint8_t* data = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(image.rgba.data(), image.width_px,
                                                  image.height_px, 4 * image.width_px, &data);
  Bytes bytes(data, data + size);
  WebPFree(data);
  return bytes;
}

TEST(LongPictures, WebpInPiecesIsTheWholePicture) {
  const Image image = noise(300, 300);
  const Bytes bytes = webp(image);
  ASSERT_GT(bytes.size(), 200000U);
  EXPECT_EQ(decode_image(bytes, "a.webp").rgba, image.rgba);
  EXPECT_THROW(decode_image({bytes.begin(), bytes.end() - 1000}, "cut.webp"), InputError);
}

// scans: empty for one scan.
Bytes jpeg(const Image& image, const std::vector<jpeg_scan_info>& scans, bool grey) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &data, &size);
  info.image_width = JDIMENSION(image.width_px);
  info.image_height = JDIMENSION(image.height_px);
  info.input_components = grey ? 1 : 3;
  info.in_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&info);
  if (!scans.empty()) {
    info.scan_info = scans.data();
    info.num_scans = int(scans.size());
  }
  jpeg_start_compress(&info, TRUE);
  Bytes row(std::size_t(3) * std::size_t(image.width_px));
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x)
      for (std::size_t c = 0; c < (grey ? 1 : 3); ++c)
        row[(grey ? 1 : 3) * std::size_t(x) + c] = image.pixel(x, y)[c];
    JSAMPROW rows[] = {row.data()};
    jpeg_write_scanlines(&info, rows, 1);
  }
  jpeg_finish_compress(&info);
  Bytes bytes(data, data + size);
  jpeg_destroy_compress(&info);
  std::free(data);
  return bytes;
}

// Each coefficient in scans of its own: first without its lowest bits, then bit by bit.
std::vector<jpeg_scan_info> scans(int low_bits) {
  std::vector<jpeg_scan_info> out = {{1, {0}, 0, 0, 0, 0}};
  for (int bits = low_bits; bits >= 0; --bits)
    for (int k = 1; k < 64; ++k)
      out.push_back({1, {0}, k, k, bits == low_bits ? 0 : bits + 1, bits});
  return out;
}

TEST(LongPictures, JpegsOfVeryManyScansAreRefused) {
  const Image image = noise(16, 16);
  const Bytes plain = jpeg(image, {}, true), some = jpeg(image, scans(2), true);
  EXPECT_EQ(decode_image(some, "190 scans").rgba, decode_image(plain, "plain").rgba);
  try {
    decode_image(jpeg(image, scans(3), true), "many.jpg");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("scans"), std::string::npos) << error.what();
  }
}

Bytes gif(const Image& image) {
  Bytes bytes;
  int error = 0;
  GifFileType* file = EGifOpen(
      &bytes,
      [](GifFileType* to, const GifByteType* data, int size) {
        auto* out = static_cast<Bytes*>(to->UserData);
        out->insert(out->end(), data, data + size);
        return size;
      },
      &error);
  std::vector<GifColorType> colors(256);
  ColorMapObject* map = GifMakeMapObject(256, colors.data());
  EGifPutScreenDesc(file, image.width_px, image.height_px, 8, 0, map);
  EGifPutImageDesc(file, 0, 0, image.width_px, image.height_px, false, nullptr);
  for (int y = 0; y < image.height_px; ++y) {
    Bytes line;
    for (int x = 0; x < image.width_px; ++x) line.push_back(image.pixel(x, y)[0]);
    EGifPutLine(file, line.data(), image.width_px);
  }
  GifFreeMapObject(map);
  EGifCloseFile(file, &error);
  return bytes;
}

// One colour is what compressors make smallest.
TEST(LongPictures, SmallFilesOfLargePicturesAreRead) {
  Image image(900, 700);
  std::fill(image.rgba.begin(), image.rgba.end(), std::uint8_t(255));
  for (const std::uint16_t compression :
       {COMPRESSION_LZW, COMPRESSION_DEFLATE, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS})
    for (const std::uint16_t samples : {1, 3, 4}) {
      const Bytes bytes = tiff(image, {700, compression, false, samples});
      EXPECT_EQ(decode_image(bytes, "a.tif").rgba, image.rgba) << compression << ", " << samples;
    }
  const Image read = decode_image(gif(image), "a.gif");
  EXPECT_EQ(read.width_px, 900);
  EXPECT_EQ(read.height_px, 700);
}

void put16(Bytes& bytes, std::size_t at, int value) {
  bytes[at] = std::uint8_t(value & 255);
  bytes[at + 1] = std::uint8_t(value >> 8);
}

// The value of a TIFF's tag, by the format's own tables.
void put_tiff_tag(Bytes& bytes, int tag, int value) {
  const auto number = [&](std::size_t at) { return bytes[at] | bytes[at + 1] << 8; };
  const auto directory = std::size_t(number(4) | number(6) << 16);
  for (int i = 0; i < number(directory); ++i) {
    const std::size_t entry = directory + 2 + std::size_t(12) * std::size_t(i);
    if (number(entry) == tag) put16(bytes, entry + 8, value);
  }
}

// A few hundred bytes that claim a quarter of a gigapixel.
TEST(LongPictures, ForgedSizesAreRefusedBeforeAnythingIsUnpacked) {
  constexpr int kSide_px = 16000;
  const Image image = noise(4, 4);
  Bytes forged_gif = gif(image);
  put16(forged_gif, 6, kSide_px);
  put16(forged_gif, 8, kSide_px);
  const std::size_t frame = 13 + std::size_t(3) * 256;  // behind the palette
  ASSERT_EQ(forged_gif[frame], ',');
  put16(forged_gif, frame + 5, kSide_px);
  put16(forged_gif, frame + 7, kSide_px);
  const std::string gif_says = refusal([&] { decode_image(forged_gif, "a.gif"); });
  EXPECT_TRUE(contains(gif_says, "too few bytes")) << gif_says;
  for (const std::uint16_t compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_DEFLATE,
                                          COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS}) {
    Bytes forged = tiff(image, {4, compression, false, 3});
    put_tiff_tag(forged, TIFFTAG_IMAGEWIDTH, kSide_px);
    put_tiff_tag(forged, TIFFTAG_IMAGELENGTH, kSide_px);
    const std::string said = refusal([&] { decode_image(forged, "a.tif"); });
    EXPECT_TRUE(contains(said, "too few bytes")) << compression << ": " << said;
  }
}

// Header, then three bytes a pixel. TGA and BMP say sizes at other places.
Bytes plain_rows(Bytes header, const Image& image, std::size_t width_at, std::size_t height_at) {
  header[width_at] = std::uint8_t(image.width_px & 255);
  header[width_at + 1] = std::uint8_t(image.width_px >> 8);
  header[height_at] = std::uint8_t(image.height_px & 255);
  header[height_at + 1] = std::uint8_t(image.height_px >> 8);
  header.resize(header.size() + 3 * std::size_t(image.width_px * image.height_px), 50);
  return header;
}

Bytes tga(const Image& image) {
  Bytes header(18);
  header[2] = 2;
  header[16] = 24;
  return plain_rows(header, image, 12, 14);
}

Bytes bmp(const Image& image) {
  Bytes header(54);
  header[0] = 'B', header[1] = 'M', header[10] = 54, header[14] = 40, header[26] = 1;
  header[28] = 24;
  return plain_rows(header, image, 18, 22);
}

// A job that is cancelled at its third look never sees the picture.
TEST(LongPictures, OfEveryKindAreGivenUpOnTheWay) {
  const Image image = noise(320, 320);
  const std::vector<jpeg_scan_info> several = scans(0);
  const std::pair<const char*, Bytes> kinds[] = {
      {"PNG", encode_png(image)},
      {"JPEG", jpeg(image, {}, false)},
      {"JPEG in scans", jpeg(image, several, true)},
      {"WebP", webp(image)},
      {"TIFF in strips", tiff(image, {8})},
      {"TIFF in tiles", tiff(image, {})},
      {"TIFF in one strip", tiff(image, {320, COMPRESSION_LZW, false, 3})},
      {"GIF", gif(image)},
      {"BMP", bmp(image)},
      {"TGA", tga(image)},
  };
  for (const auto& [kind, bytes] : kinds) {
    const RunContext context;
    const RunScope scope(context);
    EXPECT_NO_THROW(decode_image(bytes, kind)) << kind;
    context.cancel_at_check(3);
    EXPECT_THROW(decode_image(bytes, kind), Cancelled) << kind;
  }
}

}  // namespace
}  // namespace hydrodip
