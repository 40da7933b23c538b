// Pictures as press and photo programs store them: read as the same picture stored plainly, or not
// without a word.
#include <gtest/gtest.h>
#include <lcms2.h>
#include <tiffio.h>
#include <webp/encode.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include "base/file.h"
#include "base/run_scope.h"
#include "contains.h"
#include "image/files.h"
#include "image/picture_file.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A picture and what was said of it.
struct Read {
  Image image;
  std::vector<std::string> warnings;
};

Read read(const Bytes& bytes, const std::string& name = "a picture") {
  const RunContext context;
  const RunScope scope(context);
  Read result{decode_image(bytes, name), {}};
  result.warnings = context.warnings();
  return result;
}

void expect_one_warning(const Read& picture, const std::string& of) {
  ASSERT_EQ(picture.warnings.size(), 1U);
  EXPECT_TRUE(contains(picture.warnings[0], of)) << picture.warnings[0];
  EXPECT_TRUE(contains(picture.warnings[0], "a picture: ")) << picture.warnings[0];
}

constexpr int kWide = 19, kHigh = 23;

// Colours of all kinds, transparent in its first column, half so in its second.
Image colors(bool transparent) {
  Image image(kWide, kHigh);
  std::mt19937 random(3);
  for (int y = 0; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x) {
      std::uint8_t* pixel = image.pixel(x, y);
      for (int c = 0; c < 3; ++c) pixel[c] = std::uint8_t(random() & 255U);
      pixel[3] = !transparent || x > 1 ? 255 : x == 0 ? 0 : 128;
    }
  return image;
}

// Samples of a pixel.
using Samples = std::vector<std::uint16_t>;

struct TiffKind {
  std::uint16_t photometric = PHOTOMETRIC_RGB;
  std::vector<std::uint16_t> extra = {};
  std::uint16_t bits = 8;
  bool widened = true;  // of 16 bits: samples are given in 8
  bool in_planes = false, in_tiles = false;
  std::uint16_t compression = COMPRESSION_NONE;
  std::uint16_t format = SAMPLEFORMAT_UINT;
  Bytes profile = {};
};

template <typename SamplesOf>
Bytes tiff_of(const TiffKind& kind, SamplesOf samples_of) {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.tif").string();
  const std::size_t samples = samples_of(0, 0).size();
  TIFF* file = TIFFOpen(path.c_str(), "w");
  TIFFSetField(file, TIFFTAG_IMAGEWIDTH, kWide);
  TIFFSetField(file, TIFFTAG_IMAGELENGTH, kHigh);
  TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, kind.bits);
  TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, int(samples));
  TIFFSetField(file, TIFFTAG_PHOTOMETRIC, kind.photometric);
  TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, kind.format);
  TIFFSetField(file, TIFFTAG_COMPRESSION, kind.compression);
  TIFFSetField(file, TIFFTAG_PLANARCONFIG,
               kind.in_planes ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
  if (!kind.extra.empty())
    TIFFSetField(file, TIFFTAG_EXTRASAMPLES, int(kind.extra.size()), kind.extra.data());
  if (!kind.profile.empty())
    TIFFSetField(file, TIFFTAG_ICCPROFILE, std::uint32_t(kind.profile.size()), kind.profile.data());
  // The samples of pixels from (x, y) on, those of one plane or of all.
  const auto run = [&](int x, int y, int count, int plane) {
    Bytes out;
    for (int i = 0; i < count; ++i) {
      const Samples all = samples_of(std::min(x + i, kWide - 1), std::min(y, kHigh - 1));
      for (std::size_t s = 0; s < samples; ++s) {
        if (plane >= 0 && std::size_t(plane) != s) continue;
        const int value = kind.bits == 16 && kind.widened ? 257 * all[s] : all[s];
        for (int bit = 0; bit < kind.bits; bit += 8) out.push_back(std::uint8_t(value >> bit));
      }
    }
    return out;
  };
  const int planes = kind.in_planes ? int(samples) : 1;
  constexpr int kTile = 16;
  if (kind.in_tiles) {
    TIFFSetField(file, TIFFTAG_TILEWIDTH, kTile);
    TIFFSetField(file, TIFFTAG_TILELENGTH, kTile);
  } else {
    TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, 5);
  }
  for (int plane = 0; plane < planes; ++plane) {
    const int which = kind.in_planes ? plane : -1;
    for (int y = 0; y < kHigh && !kind.in_tiles; ++y)
      TIFFWriteScanline(file, run(0, y, kWide, which).data(), std::uint32_t(y),
                        std::uint16_t(plane));
    for (int top = 0; top < kHigh && kind.in_tiles; top += kTile)
      for (int left = 0; left < kWide; left += kTile) {
        Bytes tile;
        for (int y = 0; y < kTile; ++y) {
          const Bytes row = run(left, top + y, kTile, which);
          tile.insert(tile.end(), row.begin(), row.end());
        }
        TIFFWriteTile(file, tile.data(), std::uint32_t(left), std::uint32_t(top), 0,
                      std::uint16_t(plane));
      }
  }
  TIFFClose(file);
  return read_file(path);
}

// Every way in which the samples can lie in a file.
template <typename Check>
void in_every_layout(TiffKind kind, Check check) {
  for (const std::uint16_t bits : {8, 16})
    for (const bool in_planes : {false, true})
      for (const bool in_tiles : {false, true})
        for (const std::uint16_t compression : {COMPRESSION_NONE, COMPRESSION_LZW}) {
          SCOPED_TRACE(testing::Message()
                       << bits << " bits" << (in_planes ? ", planes" : "")
                       << (in_tiles ? ", tiles" : "") << ", compression " << compression);
          kind.bits = bits;
          kind.in_planes = in_planes;
          kind.in_tiles = in_tiles;
          kind.compression = compression;
          check(kind);
        }
}

// Where nothing shows no colour counts.
int largest_difference(const Image& a, const Image& b) {
  int most = a.rgba.size() == b.rgba.size() ? 0 : 255;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i)
    if (i % 4 == 3 || b.rgba[i / 4 * 4 + 3] > 0)
      most = std::max(most, std::abs(a.rgba[i] - b.rgba[i]));
  return most;
}

std::uint8_t times(int value, int alpha) { return std::uint8_t((value * alpha + 127) / 255); }

TEST(TiffColors, TransparencyIsWhatTheFileSaysIsSuch) {
  const Image image = colors(true);
  const Image opaque = colors(false);
  const auto with_fourth = [&](int x, int y) {
    const std::uint8_t* p = image.pixel(x, y);
    return Samples{p[0], p[1], p[2], p[3]};
  };
  in_every_layout({PHOTOMETRIC_RGB, {EXTRASAMPLE_UNASSALPHA}}, [&](const TiffKind& kind) {
    const Read picture = read(tiff_of(kind, with_fourth));
    EXPECT_EQ(picture.image.rgba, image.rgba);
    EXPECT_TRUE(picture.warnings.empty());
  });
  // A selection that was saved, marked or not: no transparency.
  for (const std::vector<std::uint16_t>& extra :
       {std::vector<std::uint16_t>{EXTRASAMPLE_UNSPECIFIED}, {}})
    in_every_layout({PHOTOMETRIC_RGB, extra}, [&](const TiffKind& kind) {
      const Read picture = read(tiff_of(kind, with_fourth));
      EXPECT_EQ(picture.image.rgba, opaque.rgba);
      expect_one_warning(picture, "left out");
    });
  // Colours multiplied by it, and further channels.
  in_every_layout(
      {PHOTOMETRIC_RGB, {EXTRASAMPLE_UNSPECIFIED, EXTRASAMPLE_ASSOCALPHA, EXTRASAMPLE_UNSPECIFIED}},
      [&](const TiffKind& kind) {
        const Read picture = read(tiff_of(kind, [&](int x, int y) {
          const std::uint8_t* p = image.pixel(x, y);
          return Samples{times(p[0], p[3]), times(p[1], p[3]), times(p[2], p[3]), 9, p[3], 7};
        }));
        EXPECT_LE(largest_difference(picture.image, image), 1);
        expect_one_warning(picture, "2 channels");
      });
}

TEST(TiffColors, GreyKeepsItsTransparency) {
  Image grey = colors(true);
  for (std::size_t i = 0; i < grey.rgba.size(); i += 4)
    grey.rgba[i + 1] = grey.rgba[i + 2] = grey.rgba[i];
  for (const std::uint16_t photometric : {PHOTOMETRIC_MINISBLACK, PHOTOMETRIC_MINISWHITE})
    for (const std::uint16_t alpha : {EXTRASAMPLE_UNASSALPHA, EXTRASAMPLE_ASSOCALPHA})
      in_every_layout({photometric, {alpha}}, [&](const TiffKind& kind) {
        const Read picture = read(tiff_of(kind, [&](int x, int y) {
          const std::uint8_t* p = grey.pixel(x, y);
          const int value = photometric == PHOTOMETRIC_MINISBLACK ? p[0] : 255 - p[0];
          return Samples{alpha == EXTRASAMPLE_ASSOCALPHA ? times(value, p[3]) : std::uint8_t(value),
                         p[3]};
        }));
        EXPECT_LE(largest_difference(picture.image, grey), alpha == EXTRASAMPLE_ASSOCALPHA ? 1 : 0);
        EXPECT_TRUE(picture.warnings.empty());
      });
}

// A profile of four inks, whose colours are others than those of the plain formula.
Bytes ink_profile() {
  cmsHPROFILE profile = cmsCreateProfilePlaceholder(nullptr);
  cmsSetProfileVersion(profile, 2.4);
  cmsSetDeviceClass(profile, cmsSigOutputClass);
  cmsSetColorSpace(profile, cmsSigCmykData);
  cmsSetPCS(profile, cmsSigLabData);
  cmsPipeline* pipeline = cmsPipelineAlloc(nullptr, 4, 3);
  cmsStage* table = cmsStageAllocCLut16bit(nullptr, 2, 4, 3, nullptr);
  cmsStageSampleCLut16bit(
      table,
      [](const cmsUInt16Number in[], cmsUInt16Number out[], void*) -> cmsInt32Number {
        const double ink = (in[0] + in[1] + in[2] + in[3]) / (4 * 65535.0);
        const cmsCIELab lab{100 - 80 * ink, 60.0 * (in[1] - in[0]) / 65535, 50.0 * in[2] / 65535};
        cmsFloat2LabEncodedV2(out, &lab);
        return 1;
      },
      nullptr, 0);
  cmsPipelineInsertStage(pipeline, cmsAT_END, table);
  cmsWriteTag(profile, cmsSigAToB0Tag, pipeline);
  cmsWriteTag(profile, cmsSigAToB1Tag, pipeline);
  cmsPipelineFree(pipeline);
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  Bytes bytes(size);
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  return bytes;
}

// By Little CMS alone.
Image inks_shown(const Image& inks, const Bytes& profile) {
  Image image(inks.width_px, inks.height_px);
  cmsHPROFILE from = cmsOpenProfileFromMem(profile.data(), cmsUInt32Number(profile.size()));
  cmsHPROFILE srgb = cmsCreate_sRGBProfile();
  cmsHTRANSFORM transform =
      cmsCreateTransform(from, TYPE_CMYK_8, srgb, TYPE_RGBA_8, INTENT_RELATIVE_COLORIMETRIC, 0);
  cmsDoTransform(transform, inks.rgba.data(), image.rgba.data(),
                 cmsUInt32Number(image.rgba.size() / 4));
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  cmsDeleteTransform(transform);
  cmsCloseProfile(from);
  cmsCloseProfile(srgb);
  return image;
}

// Four random inks a pixel.
Image inks() {
  Image image = colors(false);
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    image.rgba[i] = std::uint8_t(image.rgba[i - 1] / 2);
  return image;
}

TEST(TiffColors, InksAreSeenByTheirProfileHoweverTheyLie) {
  const Image ink = inks();
  const Bytes profile = ink_profile();
  const Image shown = inks_shown(ink, profile);
  const auto samples = [&](int x, int y) {
    const std::uint8_t* p = ink.pixel(x, y);
    return Samples{p[0], p[1], p[2], p[3]};
  };
  TiffKind plain{PHOTOMETRIC_SEPARATED};
  plain.profile = profile;
  in_every_layout(plain, [&](const TiffKind& kind) {
    if (kind.compression != COMPRESSION_NONE) return;  // each takes a tenth of a second
    const Read picture = read(tiff_of(kind, samples));
    EXPECT_EQ(picture.image.rgba, shown.rgba);
    EXPECT_TRUE(picture.warnings.empty());
  });
  // With a spot ink, and with transparency.
  for (const std::uint16_t extra :
       {EXTRASAMPLE_UNSPECIFIED, EXTRASAMPLE_UNASSALPHA, EXTRASAMPLE_ASSOCALPHA}) {
    Image wanted = shown;
    TiffKind with_fifth = plain;
    with_fifth.extra = {extra};
    const bool is_alpha = extra != EXTRASAMPLE_UNSPECIFIED;
    for (int y = 0; is_alpha && y < kHigh; ++y) wanted.pixel(0, y)[3] = 0;
    in_every_layout(with_fifth, [&](const TiffKind& kind) {
      if (kind.compression != COMPRESSION_NONE || kind.in_tiles != kind.in_planes) return;
      const Read picture = read(tiff_of(kind, [&](int x, int y) {
        const bool seen = x > 0;
        Samples all = samples(x, y);
        if (!seen && extra == EXTRASAMPLE_ASSOCALPHA) all = {0, 0, 0, 0};
        all.push_back(seen ? 255 : 0);
        return all;
      }));
      EXPECT_EQ(largest_difference(picture.image, wanted), 0);
      if (is_alpha)
        EXPECT_TRUE(picture.warnings.empty());
      else
        expect_one_warning(picture, "left out");
    });
  }
}

TEST(TiffColors, InksWithoutAProfileAreTakenByAPlainFormula) {
  const Image ink = inks();
  in_every_layout({PHOTOMETRIC_SEPARATED, {EXTRASAMPLE_UNASSALPHA}}, [&](const TiffKind& kind) {
    const Read picture = read(tiff_of(kind, [&](int x, int y) {
      const std::uint8_t* p = ink.pixel(x, y);
      return Samples{p[0], p[1], p[2], p[3], std::uint8_t(x == 0 ? 0 : 255)};
    }));
    for (int y = 0; y < kHigh; ++y)
      for (int x = 0; x < kWide; ++x) {
        const std::uint8_t *p = ink.pixel(x, y), *q = picture.image.pixel(x, y);
        ASSERT_EQ(q[3], x == 0 ? 0 : 255);
        for (int c = 0; c < 3; ++c)
          ASSERT_EQ(q[c], std::lround((255 - p[c]) * (255 - p[3]) / 255.0));
      }
  });
}

// The colours of sRGB as Lab, coded as TIFF or as ICC does.
TEST(TiffColors, LabIsTheSameColours) {
  const Image image = colors(true);
  cmsHPROFILE lab = cmsCreateLab4Profile(nullptr), srgb = cmsCreate_sRGBProfile();
  cmsHTRANSFORM to_lab =
      cmsCreateTransform(srgb, TYPE_RGBA_8, lab, TYPE_Lab_DBL, INTENT_RELATIVE_COLORIMETRIC, 0);
  std::vector<cmsCIELab> colors_lab(image.rgba.size() / 4);
  cmsDoTransform(to_lab, image.rgba.data(), colors_lab.data(), cmsUInt32Number(colors_lab.size()));
  cmsDeleteTransform(to_lab);
  cmsCloseProfile(lab);
  cmsCloseProfile(srgb);
  for (const std::uint16_t photometric : {PHOTOMETRIC_CIELAB, PHOTOMETRIC_ICCLAB}) {
    const bool icc = photometric == PHOTOMETRIC_ICCLAB;
    TiffKind lab_kind{photometric, {EXTRASAMPLE_UNASSALPHA}};
    lab_kind.widened = false;
    in_every_layout(lab_kind, [&](const TiffKind& kind) {
      const bool wide = kind.bits == 16;
      const double white = !wide ? 255 : icc ? 0xff00 : 0xffff;
      const int per_step = wide ? 256 : 1, zero = icc ? 128 * per_step : 0;
      const auto axis = [&](double value) {
        return std::uint16_t((std::lround(value * per_step) + zero) & (wide ? 0xffff : 0xff));
      };
      const Read picture = read(tiff_of(kind, [&](int x, int y) {
        const cmsCIELab& c = colors_lab[std::size_t(y * kWide + x)];
        return Samples{std::uint16_t(std::lround(c.L / 100 * white)), axis(c.a), axis(c.b),
                       std::uint16_t(image.pixel(x, y)[3] * (wide ? 257 : 1))};
      }));
      // With 8 bits, steps of one in a* and b* are up to a few of sRGB.
      double sum = 0;
      int most = 0;
      for (std::size_t i = 0; i < image.rgba.size(); ++i) {
        if (i % 4 == 3) continue;
        const int off = std::abs(picture.image.rgba[i] - image.rgba[i]);
        sum += off;
        most = std::max(most, off);
      }
      EXPECT_LE(sum / (0.75 * double(image.rgba.size())), wide ? 0.01 : 1.0);
      EXPECT_LE(most, wide ? 1 : 20);
      for (std::size_t i = 3; i < image.rgba.size(); i += 4)
        ASSERT_EQ(picture.image.rgba[i], image.rgba[i]);
      EXPECT_TRUE(picture.warnings.empty());
    });
  }
}

TEST(TiffColors, WhatWouldBeGuessedIsRefusedWithAWayOut) {
  const auto said = [](TiffKind kind, std::size_t samples) {
    return refusal([&] { read(tiff_of(kind, [&](int, int) { return Samples(samples, 40); })); });
  };
  const auto expect = [](const std::string& sentence, const std::string& what) {
    EXPECT_TRUE(contains(sentence, what)) << sentence;
    EXPECT_TRUE(contains(sentence, "save it as RGB with 8 bits a channel")) << sentence;
    EXPECT_FALSE(contains(sentence, "damaged")) << sentence;
  };
  TiffKind kind;
  kind.format = SAMPLEFORMAT_INT;
  expect(said(kind, 3), "signed");
  kind.format = SAMPLEFORMAT_IEEEFP;
  kind.bits = 32;
  expect(said(kind, 3), "floating-point");
  expect(said(kind, 1), "floating-point");
  kind.format = SAMPLEFORMAT_UINT;
  expect(said(kind, 3), "32 bits");
  expect(said({PHOTOMETRIC_SEPARATED}, 3), "inks");
}

// ---- profiles and data that are damaged ---------------------------------------------------------

void put32(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(std::uint8_t(value >> shift));
}

Bytes png_chunk(const std::string& type, const Bytes& data) {
  Bytes out, body(type.begin(), type.end());
  put32(out, std::uint32_t(data.size()));
  body.insert(body.end(), data.begin(), data.end());
  out.insert(out.end(), body.begin(), body.end());
  put32(out, std::uint32_t(crc32(0, body.data(), uInt(body.size()))));
  return out;
}

// ---- several pictures ---------------------------------------------------------------------------

Bytes with_page(const Bytes& tiff, std::uint32_t kind) {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.tif").string();
  write_file(path, tiff.data(), tiff.size());
  TIFF* file = TIFFOpen(path.c_str(), "a");
  TIFFSetField(file, TIFFTAG_SUBFILETYPE, kind);
  TIFFSetField(file, TIFFTAG_IMAGEWIDTH, 1);
  TIFFSetField(file, TIFFTAG_IMAGELENGTH, 1);
  TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  Bytes pixel = {7};
  TIFFWriteScanline(file, pixel.data(), 0, 0);
  TIFFClose(file);
  return read_file(path);
}

TEST(SeveralPictures, TheFirstIsTakenAndThatIsSaid) {
  const Image image = colors(false);
  const Bytes tiff = tiff_of({}, [&](int x, int y) {
    const std::uint8_t* p = image.pixel(x, y);
    return Samples{p[0], p[1], p[2]};
  });
  EXPECT_TRUE(read(tiff).warnings.empty());
  // What programs put beside a picture for themselves.
  const Bytes with_copy = with_page(tiff, FILETYPE_REDUCEDIMAGE);
  EXPECT_TRUE(read(with_copy).warnings.empty());
  EXPECT_TRUE(read(with_page(tiff, FILETYPE_MASK)).warnings.empty());
  const Read first = read(with_page(with_copy, FILETYPE_PAGE));
  EXPECT_EQ(first.image.rgba, image.rgba);
  expect_one_warning(first, "several pictures");

  const Bytes head = {'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0, 0x80, 0, 0, 9, 9, 9, 255, 255, 255};
  const Bytes frame = {0x21, 0xf9, 4, 0, 10, 0, 0, 0, 0x2c, 0, 0, 0,
                       0,    1,    0, 1, 0,  0, 2, 2, 0x44, 1, 0};
  Bytes gif = head;
  gif.insert(gif.end(), frame.begin(), frame.end());
  Bytes animated = gif;
  animated.insert(animated.end(), frame.begin(), frame.end());
  gif.push_back(0x3b);
  animated.push_back(0x3b);
  EXPECT_TRUE(read(gif).warnings.empty());
  EXPECT_EQ(read(animated).image.rgba, read(gif).image.rgba);
  expect_one_warning(read(animated), "several pictures");

  Bytes png = encode_png(image);
  EXPECT_TRUE(read(png).warnings.empty());
  const Bytes two_frames = png_chunk("acTL", {0, 0, 0, 2, 0, 0, 0, 0});
  constexpr int kBehindHead = 33;
  png.insert(png.begin() + kBehindHead, two_frames.begin(), two_frames.end());
  expect_one_warning(read(png), "several pictures");
}

Bytes deflated(const Bytes& data) {
  uLongf size = compressBound(uLong(data.size()));
  Bytes out(size);
  compress(out.data(), &size, data.data(), uLong(data.size()));
  out.resize(size);
  return out;
}

// Chunks behind the header of a picture that encode_png made, without its own sRGB.
Bytes png_with(const Image& image, const std::vector<Bytes>& chunks) {
  Bytes png = encode_png(image);
  constexpr std::size_t kHeader = 33, kSrgb = 13;
  png.erase(png.begin() + kHeader, png.begin() + kHeader + kSrgb);
  std::size_t at = kHeader;
  for (const Bytes& chunk : chunks) {
    png.insert(png.begin() + std::ptrdiff_t(at), chunk.begin(), chunk.end());
    at += chunk.size();
  }
  return png;
}

Bytes iccp(const Bytes& profile, std::size_t kept_bytes = SIZE_MAX) {
  Bytes data = {'p', 0, 0};
  Bytes packed = deflated(profile);
  packed.resize(std::min(packed.size(), kept_bytes));
  data.insert(data.end(), packed.begin(), packed.end());
  return png_chunk("iCCP", data);
}

// Red and blue change places.
Bytes swapped_profile() {
  const cmsCIExyYTRIPLE primaries{{0.15, 0.06, 1}, {0.30, 0.60, 1}, {0.64, 0.33, 1}};
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

Bytes grey_profile() {
  cmsToneCurve* tone = cmsBuildGamma(nullptr, 1.0);
  const cmsCIExyY white{0.3457, 0.3585, 1};
  cmsHPROFILE profile = cmsCreateGrayProfile(&white, tone);
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  Bytes bytes(size);
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  cmsFreeToneCurve(tone);
  return bytes;
}

Image swapped(Image image) {
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    std::swap(image.rgba[i], image.rgba[i + 2]);
  return image;
}

TEST(PngProfile, CountsWhereTheFileCallsItselfSrgbToo) {
  const Image image = colors(false);
  const Bytes srgb = png_chunk("sRGB", {1}), profile = iccp(swapped_profile());
  for (const std::vector<Bytes>& chunks :
       {std::vector<Bytes>{profile}, {srgb, profile}, {profile, srgb}}) {
    const Read picture = read(png_with(image, chunks));
    EXPECT_LE(largest_difference(picture.image, swapped(image)), 2);
    EXPECT_TRUE(picture.warnings.empty());
  }
}

TEST(PngProfile, DamagedIsToldAndTakenAsSrgb) {
  const Image image = colors(false);
  Bytes nonsense(200, 7);
  for (const Bytes& chunk : {iccp(swapped_profile(), 60), iccp(nonsense), iccp(ink_profile()),
                             iccp(grey_profile()), png_chunk("iCCP", {'p'})}) {
    const Read picture = read(png_with(image, {chunk}));
    EXPECT_EQ(picture.image.rgba, image.rgba);
    expect_one_warning(picture, "profile");
  }
  // Light that is not read: HDR.
  const Read hdr = read(png_with(image, {png_chunk("cICP", {9, 16, 0, 1})}));
  EXPECT_EQ(hdr.image.rgba, image.rgba);
  expect_one_warning(hdr, "cICP 9, 16, 0, 1");
}

TEST(TiffProfile, DamagedOrOfAnotherKindIsTold) {
  const Image image = colors(false);
  const auto rgb = [&](int x, int y) {
    const std::uint8_t* p = image.pixel(x, y);
    return Samples{p[0], p[1], p[2]};
  };
  TiffKind kind;
  kind.profile = swapped_profile();
  const Bytes whole = tiff_of(kind, rgb);
  EXPECT_LE(largest_difference(read(whole).image, swapped(image)), 2);
  for (const Bytes& profile : {Bytes(200, 7), ink_profile(), grey_profile()}) {
    kind.profile = profile;
    const Read picture = read(tiff_of(kind, rgb));
    EXPECT_EQ(picture.image.rgba, image.rgba);
    expect_one_warning(picture, "profile");
  }
  // Behind the end of the file.
  kind.profile = swapped_profile();
  Bytes cut = tiff_of(kind, rgb);
  const auto entry_at = [&]() -> std::size_t {
    const auto number = [&](std::size_t at) { return cut[at] | cut[at + 1] << 8; };
    const auto directory = std::size_t(number(4) | number(6) << 16);
    for (int i = 0; i < number(directory); ++i)
      if (number(directory + 2 + 12 * std::size_t(i)) == TIFFTAG_ICCPROFILE)
        return directory + 2 + 12 * std::size_t(i);
    return 0;
  };
  const std::size_t entry = entry_at();
  ASSERT_GT(entry, 0U);
  cut[entry + 10] = 0x7f;
  const Read picture = read(cut);
  EXPECT_EQ(picture.image.rgba, image.rgba);
  expect_one_warning(picture, "profile");
  TiffKind ink_kind{PHOTOMETRIC_SEPARATED};
  ink_kind.profile = swapped_profile();
  expect_one_warning(read(tiff_of(ink_kind,
                                  [](int, int) {
                                    return Samples{9, 9, 9, 9};
                                  })),
                     "plain formula");
}

// Little-endian.
void put_back(Bytes& out, std::uint32_t value, int count) {
  for (; count > 0; --count, value >>= 8U) out.push_back(std::uint8_t(value));
}

// The fifth version, with its profile behind the pixels.
Bytes bmp_with(const Image& image, const std::string& space, const Bytes& profile) {
  constexpr std::uint32_t kHeader = 124;
  const auto pixels = std::uint32_t(image.rgba.size());
  Bytes out = {'B', 'M'};
  put_back(out, 0, 8);
  put_back(out, 14 + kHeader, 4);
  put_back(out, kHeader, 4);
  put_back(out, std::uint32_t(image.width_px), 4);
  put_back(out, std::uint32_t(-image.height_px), 4);
  put_back(out, 1, 2);
  put_back(out, 32, 2);
  out.resize(14 + 56);
  out.insert(out.end(), space.rbegin(), space.rend());
  out.resize(14 + 112);
  put_back(out, kHeader + pixels, 4);
  put_back(out, std::uint32_t(profile.size()), 4);
  out.resize(14 + kHeader);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    for (const std::size_t c : {2, 1, 0, 3}) out.push_back(image.rgba[i + c]);
  out.insert(out.end(), profile.begin(), profile.end());
  return out;
}

TEST(BmpProfile, CountsOrIsMissed) {
  const Image image = colors(false);
  const Bytes profile = swapped_profile();
  Bytes bmp = bmp_with(image, "MBED", profile);
  const Read picture = read(bmp);
  EXPECT_LE(largest_difference(picture.image, swapped(image)), 2);
  EXPECT_TRUE(picture.warnings.empty());
  bmp.resize(bmp.size() - 10);
  expect_one_warning(read(bmp), "profile");
  expect_one_warning(read(bmp_with(image, "LINK", {'x'})), "profile");
  const Read srgb = read(bmp_with(image, "sRGB", {}));
  EXPECT_EQ(srgb.image.rgba, image.rgba);
  EXPECT_TRUE(srgb.warnings.empty());
}

// Red, and blue from the profile's view, in a GIF with an extension.
TEST(GifProfile, Counts) {
  Bytes gif = {'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0, 0x80, 0, 0, 255, 0, 0, 0, 0, 0};
  const Bytes pixel = {',', 0, 0, 0, 0, 1, 0, 1, 0, 0, 2, 2, 0x44, 0x01, 0, ';'};
  Bytes plain = gif;
  plain.insert(plain.end(), pixel.begin(), pixel.end());
  EXPECT_EQ(read(plain).image.rgba, (BlankArray<std::uint8_t>{255, 0, 0, 255}));
  const std::string label = "ICCRGBG1012";
  gif.insert(gif.end(), {'!', 0xff, 11});
  gif.insert(gif.end(), label.begin(), label.end());
  const Bytes profile = swapped_profile();
  for (std::size_t at = 0; at < profile.size(); at += 255) {
    const std::size_t size = std::min<std::size_t>(255, profile.size() - at);
    gif.push_back(std::uint8_t(size));
    gif.insert(gif.end(), profile.begin() + std::ptrdiff_t(at),
               profile.begin() + std::ptrdiff_t(at + size));
  }
  gif.push_back(0);
  gif.insert(gif.end(), pixel.begin(), pixel.end());
  const Read picture = read(gif);
  EXPECT_NEAR(picture.image.rgba[0], 0, 2);
  EXPECT_NEAR(picture.image.rgba[2], 255, 2);
}

// RIFF's chunks, with a profile before the pixels, or only said to be there.
Bytes webp_with(const Image& image, const Bytes& profile) {
  std::uint8_t* data = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(image.rgba.data(), image.width_px,
                                                  image.height_px, 4 * image.width_px, &data);
  const Bytes plain(data, data + size);
  WebPFree(data);
  Bytes body = {'W', 'E', 'B', 'P', 'V', 'P', '8', 'X'};
  put_back(body, 10, 4);
  put_back(body, 0x20, 4);
  put_back(body, std::uint32_t(image.width_px - 1), 3);
  put_back(body, std::uint32_t(image.height_px - 1), 3);
  if (!profile.empty()) {
    for (const char c : {'I', 'C', 'C', 'P'}) body.push_back(std::uint8_t(c));
    put_back(body, std::uint32_t(profile.size()), 4);
    body.insert(body.end(), profile.begin(), profile.end());
    if (profile.size() % 2 == 1) body.push_back(0);
  }
  body.insert(body.end(), plain.begin() + 12, plain.end());
  Bytes out = {'R', 'I', 'F', 'F'};
  put_back(out, std::uint32_t(body.size()), 4);
  out.insert(out.end(), body.begin(), body.end());
  return out;
}

TEST(WebpProfile, CountsOrIsMissed) {
  const Image image = colors(false);
  const Read picture = read(webp_with(image, swapped_profile()));
  EXPECT_LE(largest_difference(picture.image, swapped(image)), 2);
  EXPECT_TRUE(picture.warnings.empty());
  for (const Bytes& profile : {Bytes(), Bytes(100, 7)}) {
    const Read without = read(webp_with(image, profile));
    EXPECT_EQ(without.image.rgba, image.rgba);
    expect_one_warning(without, "profile");
  }
}

// The second version, whose last part says what the fourth channel is.
TEST(TgaAlpha, IsWhatTheFileSaysItIs) {
  const Image image = colors(true);
  const auto tga = [&](std::uint8_t kind) {
    Bytes out(18);
    out[2] = 2;
    out[12] = kWide, out[14] = kHigh;
    out[16] = 32, out[17] = 0x28;
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      const int alpha = image.rgba[i + 3];
      for (const std::size_t c : {2, 1, 0})
        out.push_back(kind == 4 ? times(image.rgba[i + c], alpha) : image.rgba[i + c]);
      out.push_back(std::uint8_t(alpha));
    }
    const auto extension = std::uint32_t(out.size());
    out.resize(out.size() + 495);
    out[extension + 494] = kind;
    put_back(out, extension, 4);
    put_back(out, 0, 4);
    for (const char c : std::string("TRUEVISION-XFILE.")) out.push_back(std::uint8_t(c));
    out.push_back(0);
    return read(out);
  };
  EXPECT_EQ(tga(3).image.rgba, image.rgba);
  EXPECT_LE(largest_difference(tga(4).image, image), 1);
  EXPECT_EQ(tga(1).image.rgba, colors(false).rgba);
  expect_one_warning(tga(1), "left out");
}

// One APP2 marker of an ICC profile.
Bytes profile_marker(int number, int of, const Bytes& part) {
  const std::string label("ICC_PROFILE\0", 12);
  Bytes out = {0xff, 0xe2};
  const std::size_t size = 2 + label.size() + 2 + part.size();
  out.push_back(std::uint8_t(size >> 8));
  out.push_back(std::uint8_t(size & 255));
  out.insert(out.end(), label.begin(), label.end());
  out.push_back(std::uint8_t(number));
  out.push_back(std::uint8_t(of));
  out.insert(out.end(), part.begin(), part.end());
  return out;
}

TEST(JpegProfile, MissingAPartIsTold) {
  const Bytes plain = encode_jpeg(colors(false), 90);
  const Bytes profile = swapped_profile();
  const auto with = [&](const Bytes& marker) {
    Bytes bytes = plain;
    bytes.insert(bytes.begin() + 2, marker.begin(), marker.end());
    return read(bytes);
  };
  EXPECT_TRUE(read(plain).warnings.empty());
  EXPECT_TRUE(with(profile_marker(1, 1, profile)).warnings.empty());
  const Read picture = with(profile_marker(1, 2, profile));
  EXPECT_EQ(picture.image.rgba, read(plain).image.rgba);
  expect_one_warning(picture, "profile");
}

// A smooth picture whose rows of blocks can be told apart.
Image smooth() {
  Image image(256, 256);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const std::uint8_t pixel[] = {std::uint8_t(x), std::uint8_t(y),
                                    std::uint8_t((x * 7 + y * 3) & 255), 255};
      std::copy_n(pixel, 4, image.pixel(x, y));
    }
  return image;
}

// With some of its rows' data twice, and without some: of other damages nobody can know.
Bytes with_more(Bytes jpeg) {
  const auto middle = jpeg.begin() + std::ptrdiff_t(jpeg.size() / 2);
  const Bytes part(middle, middle + 400);
  jpeg.insert(middle, part.begin(), part.end());
  return jpeg;
}

Bytes with_less(Bytes jpeg) {
  const auto middle = jpeg.begin() + std::ptrdiff_t(jpeg.size() / 2);
  jpeg.erase(middle, middle + 400);
  return jpeg;
}

// The JPEG as its only strip.
Bytes tiff_around(Bytes jpeg) {
  const TemporaryFolder folder;
  const std::string path = (folder / "a.tif").string();
  TIFF* file = TIFFOpen(path.c_str(), "w");
  TIFFSetField(file, TIFFTAG_IMAGEWIDTH, 256);
  TIFFSetField(file, TIFFTAG_IMAGELENGTH, 256);
  TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 3);
  TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, 256);
  TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(file, TIFFTAG_COMPRESSION, COMPRESSION_JPEG);
  TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_YCBCR);
  TIFFWriteRawStrip(file, 0, jpeg.data(), tmsize_t(jpeg.size()));
  TIFFClose(file);
  return read_file(path);
}

TEST(Jpeg, DamagedDataAreTold) {
  const Bytes whole = encode_jpeg(smooth(), 90);
  ASSERT_GT(whole.size(), 4000U);
  for (const bool in_tiff : {false, true}) {
    SCOPED_TRACE(in_tiff ? "in a TIFF" : "alone");
    const auto file = [&](const Bytes& jpeg) { return in_tiff ? tiff_around(jpeg) : jpeg; };
    const Read picture = read(file(whole));
    EXPECT_LE(largest_difference(picture.image, decode_image(whole, "whole")), 2);
    EXPECT_TRUE(picture.warnings.empty());
    expect_one_warning(read(file(with_more(whole))), "data are damaged");
    EXPECT_TRUE(contains(refusal([&] { read(file(with_less(whole))); }), "ends too early"));
  }
}

// ---- resolutions --------------------------------------------------------------------------------

// Behind a JPEG's first mark: EXIF with a resolution in its directory.
Bytes exif_marker(std::uint32_t across, std::uint32_t along, std::uint16_t unit) {
  Bytes exif = {'E', 'x', 'i', 'f', 0, 0, 'M', 'M', 0, 42, 0, 0, 0, 8, 0, 3};
  const auto entry = [&](std::uint16_t tag, std::uint16_t type, std::uint32_t value) {
    put32(exif, std::uint32_t(tag) << 16 | type);
    put32(exif, 1);
    put32(exif, value);
  };
  constexpr std::uint32_t kBehind = 8 + 2 + 3 * 12 + 4;
  entry(0x011a, 5, kBehind);
  entry(0x011b, 5, kBehind + 8);
  entry(0x0128, 3, std::uint32_t(unit) << 16);
  put32(exif, 0);
  for (const std::uint32_t value : {across, 1U, along, 1U}) put32(exif, value);
  Bytes out = {0xff, 0xe1, 0, std::uint8_t(exif.size() + 2)};
  out.insert(out.end(), exif.begin(), exif.end());
  return out;
}

TEST(Resolutions, OfEveryKindInBothDirections) {
  const Bytes jpeg = encode_jpeg(colors(false), 90);
  const auto with_exif = [&](std::uint32_t across, std::uint32_t along, std::uint16_t unit) {
    Bytes bytes = jpeg;
    const Bytes exif = exif_marker(across, along, unit);
    bytes.insert(bytes.begin() + 2, exif.begin(), exif.end());
    return bytes;
  };
  EXPECT_EQ(scan_dpi(jpeg), 0);
  EXPECT_EQ(scan_dpi(with_exif(300, 300, 2)), 300);
  EXPECT_NEAR(scan_dpi(with_exif(100, 100, 3)), 254, 1e-9);
  EXPECT_EQ(scan_dpi(with_exif(72, 72, 2)), 0);  // what cameras write for none
  EXPECT_EQ(scan_dpi(with_exif(300, 600, 2)), 0);
  EXPECT_EQ(recorded_resolution(with_exif(300, 600, 2)).along_dpi, 600);
  // JFIF's own: its density stands behind the mark, the version and the unit.
  Bytes jfif = jpeg;
  jfif[13] = 1;
  jfif[14] = 300 >> 8, jfif[15] = 300 & 255;
  jfif[16] = 600 >> 8, jfif[17] = 600 & 255;
  EXPECT_EQ(recorded_resolution(jfif).across_dpi, 300);
  EXPECT_EQ(recorded_resolution(jfif).along_dpi, 600);
  EXPECT_EQ(scan_dpi(jfif), 0);
  const Bytes png = png_with(colors(false), {png_chunk("pHYs", [] {
                               Bytes data;
                               put32(data, 11811);
                               put32(data, 23622);
                               data.push_back(1);
                               return data;
                             }())});
  EXPECT_EQ(recorded_resolution(png).across_dpi, 300);
  EXPECT_EQ(recorded_resolution(png).along_dpi, 600);
}

}  // namespace
}  // namespace hydrodip
