// Drawings and text: drawn in pieces as in one, as finely as the print, in fonts that are known.
#include "artwork/drawing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdlib>

#include "artwork/fonts.h"
#include "artwork/picture.h"
#include "artwork/picture_marks.h"
#include "artwork/tiled_image.h"
#include "base/context.h"
#include "base/error.h"
#include "base/run_scope.h"
#include "image/files.h"

namespace hydrodip {
namespace {

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Drawing drawing_of(const std::string& inside) {
  return Drawing::from_svg(
      bytes_of("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 300 200'>" + inside +
               "</svg>"),
      "test.svg");
}

// By how much any channel of any pixel differs, colours weighted by how much they cover.
double largest_difference(const Image& a, const TiledImage& b) {
  double most = 0;
  for (int y = 0; y < a.height_px; ++y)
    for (int x = 0; x < a.width_px; ++x) {
      const std::uint8_t *p = a.pixel(x, y), *q = b.pixel(x, y);
      most = std::max(most, std::abs(double(p[3]) - q[3]));
      for (int c = 0; c < 3; ++c)
        most = std::max(most, std::abs(double(p[c]) * p[3] - double(q[c]) * q[3]) / 255);
    }
  return most;
}

TEST(TiledImage, GivesBackWhatWasPut) {
  constexpr int kTile = TiledImage::kTile_px;
  Image image(3 * kTile + 7, 2 * kTile + 1);
  for (int y = 0; y < image.height_px; ++y)
    for (int x = 0; x < image.width_px; ++x) {
      std::uint8_t* pixel = image.pixel(x, y);
      const bool plain = x < kTile;
      pixel[0] = plain ? 9 : std::uint8_t(x * 7 + y * 13);
      pixel[3] = plain ? 200 : std::uint8_t(x + y);
    }
  TiledImage tiles(image.width_px, image.height_px);
  EXPECT_FALSE(tiles.shows_anything());
  tiles.put(image, 0, 0);
  EXPECT_EQ(largest_difference(image, tiles), 0);
  EXPECT_TRUE(tiles.shows_anything());
  // 4 columns of tiles in 3 rows; those of the first column have one colour.
  EXPECT_EQ(tiles.bytes(), std::size_t(9 * 4 * kTile * kTile));
  // The same from two pieces.
  TiledImage pieces(image.width_px, image.height_px);
  Image left(kTile, image.height_px), right(image.width_px - kTile, image.height_px);
  for (int y = 0; y < image.height_px; ++y) {
    std::copy_n(image.pixel(0, y), 4 * kTile, left.pixel(0, y));
    std::copy_n(image.pixel(kTile, y), 4 * right.width_px, right.pixel(0, y));
  }
  pieces.put(right, kTile, 0);
  pieces.put(left, 0, 0);
  EXPECT_EQ(largest_difference(image, pieces), 0);
}

// Neither what is clipped nor groups, gradients, masks and blur show where one piece ends and the
// next begins.
TEST(Drawing, InPiecesIsAsInOne) {
  const std::string shapes =
      "<defs><linearGradient id='g'><stop stop-color='#f00'/><stop offset='1' stop-color='#00f' "
      "stop-opacity='0.3'/></linearGradient><clipPath id='c'><circle cx='150' cy='100' "
      "r='90'/></clipPath></defs>"
      "<rect width='300' height='200' fill='url(#g)'/><g fill-opacity='0.5'><circle cx='150' "
      "cy='100' "
      "r='70'/><path d='M10 190L290 10' stroke='#0a0' stroke-width='7'/></g><g fill-opacity='0.7'>"
      "<ellipse cx='200' cy='90' rx='80' ry='60' fill='#fc0'/></g><g clip-path='url(#c)'><rect "
      "x='100' y='20' width='190' height='90' fill='#0cc'/></g>";
  const Drawing plain = drawing_of(shapes);
  constexpr int kWide = 4200, kHigh = 2800;  // three pieces by two
  const auto tiles = plain.tiles(kWide, kHigh, std::size_t(1) << 30U);
  ASSERT_TRUE(tiles.has_value());
  // What cairo makes of an edge depends on where its surface begins, a little.
  EXPECT_LE(largest_difference(plain.pixels(kWide, kHigh), *tiles), 16);
  // Those that cannot be drawn in pieces are drawn in one.
  const Drawing blurred = drawing_of(
      "<filter id='b'><feGaussianBlur stdDeviation='6'/></filter><mask id='m'><rect x='50' "
      "width='90' "
      "height='200' fill='#fff'/></mask><circle cx='150' cy='100' r='60' filter='url(#b)' "
      "mask='url(#m)'/>");
  const auto soft = blurred.tiles(2250, 1500, std::size_t(1) << 30U);
  ASSERT_TRUE(soft.has_value());
  EXPECT_EQ(largest_difference(blurred.pixels(2250, 1500), *soft), 0);
  EXPECT_LT(blurred.limits().pixels, plain.limits().pixels);
  EXPECT_LT(drawing_of("<g opacity='0.5'><rect width='9' height='9'/></g>").limits().pixels,
            plain.limits().pixels);
}

// Longer than what cairo can draw at once: a line across A3 at 1200 dpi.
TEST(Drawing, IsSharpAcrossALargeSheet) {
  const Drawing drawing = Drawing::from_svg(
      bytes_of("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 420 1'><rect x='401.25' "
               "width='10' height='1'/></svg>"),
      "line.svg");
  constexpr double kPixelsPerMm = 3 * 1200 / 25.4;
  const int width = int(420 * kPixelsPerMm), height = int(kPixelsPerMm);
  ASSERT_GT(width, 32767);
  const auto tiles = drawing.tiles(width, height, std::size_t(1) << 30U);
  ASSERT_TRUE(tiles.has_value());
  const auto alpha = [&](double x_mm) {
    return int(tiles->pixel(int(x_mm / 420 * width), height / 2)[3]);
  };
  EXPECT_EQ(alpha(401.24), 0);
  EXPECT_EQ(alpha(401.26), 255);
  EXPECT_EQ(alpha(411.24), 255);
  EXPECT_EQ(alpha(411.26), 0);
}

// As large as its limits let it be: there it came out transparent.
TEST(Drawing, WhatIsMixedAsAWholeShowsAtItsLongest) {
  const Drawing drawing = Drawing::from_svg(
      bytes_of("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 1000 1'><g opacity='0.5'>"
               "<rect width='1000' height='1' fill='red'/></g></svg>"),
      "line.svg");
  const int side_px = int(drawing.limits().side_px);
  const std::optional<TiledImage> tiles =
      drawing.tiles(side_px, side_px / 1000, std::size_t(1) << 30U);
  ASSERT_TRUE(tiles.has_value());
  for (const int x : {0, side_px / 2, side_px - 1}) EXPECT_NEAR(tiles->pixel(x, 9)[3], 128, 1) << x;
}

// Letters of 70 mm, for a print of 1200 dpi: FreeType has a limit, and is not driven to
// it.
TEST(Drawing, LettersCanBeLarge) {
  const Drawing text = Drawing::from_text("1", "sans bold", {});
  const double high_mm = 70, pixels_per_mm = 3 * 1200 / 25.4;
  const int height = int(high_mm * pixels_per_mm), width = int(height * text.aspect());
  EXPECT_LE(std::max(width, height), text.limits().side_px);
  const auto tiles = text.tiles(width, height, std::size_t(1) << 30U);
  ASSERT_TRUE(tiles.has_value());
  EXPECT_TRUE(tiles->shows_anything());
}

// How much ink is in each column, and the first and last that have any.
struct Columns {
  std::vector<double> ink;
  int first = -1, last = -1;
};

Columns columns_of(const Image& image) {
  Columns columns{std::vector<double>(std::size_t(image.width_px), 0)};
  for (int x = 0; x < image.width_px; ++x) {
    for (int y = 0; y < image.height_px; ++y)
      columns.ink[std::size_t(x)] += image.pixel(x, y)[3] / 255.0;
    if (!(columns.ink[std::size_t(x)] > 0)) continue;
    if (columns.first < 0) columns.first = x;
    columns.last = x;
  }
  return columns;
}

// A word that is its own mirror image stays it at any size, small, rounded or stretched on purpose,
// and fills it from edge to edge, but for what half a pixel of its height comes to.
TEST(Drawing, WordsFillWhateverSizeIsAsked) {
  const Drawing word = Drawing::from_text("HIT IT OHO TI TIH", "sans bold", {});
  for (const double stretched : {1.0, 0.95, 1.04, 0.3, 4.0})
    for (const int width : {83, 151, 400, 3000}) {
      const int height = std::max(1, int(stretched * width / word.aspect()));
      const Columns columns = columns_of(word.pixels(width, height));
      SCOPED_TRACE(testing::Message() << width << " x " << height);
      const double rim = 0.02 * width + 1 + 0.5 * width / height;
      EXPECT_LE(columns.first, rim);
      EXPECT_GE(columns.last, width - 1 - rim);
      double sum = 0, left = 0;
      for (int x = 0; x < width; ++x) {
        sum += columns.ink[std::size_t(x)];
        if (2 * x + 1 < width) left += columns.ink[std::size_t(x)];
      }
      EXPECT_NEAR(left / sum, 0.5, 0.02);
    }
}

TEST(Drawing, TextInAStretchedDrawingStaysInItsPlace) {
  const Drawing drawing = drawing_of(
      "<text x='150' y='120' font-size='40' text-anchor='middle' font-weight='bold' "
      "font-family='sans'>HIT OHO TIH</text>");
  const Columns plain = columns_of(drawing.pixels(600, 400));
  for (const auto& [width, height] : {std::pair(600, 150), std::pair(200, 600)}) {
    const Columns columns = columns_of(drawing.pixels(width, height));
    const double scale = width / 600.0;
    EXPECT_NEAR(columns.first, scale * plain.first, 2) << width;
    EXPECT_NEAR(columns.last, scale * plain.last, 2) << width;
  }
}

using Names = std::vector<std::string>;

const std::string kShape = "<rect width='9' height='9'/>";

Names outside(const std::string& inside) { return drawing_of(kShape + inside).contents().outside; }

TEST(Drawing, KnowsWhetherItHasText) {
  const auto has_text = [](const std::string& inside) {
    return drawing_of(inside).contents().has_text;
  };
  EXPECT_FALSE(has_text(kShape));
  EXPECT_TRUE(has_text(kShape + "<text y='20'>A</text>"));
  EXPECT_TRUE(has_text(kShape + "<s:text xmlns:s='http://www.w3.org/2000/svg' y='20'>A</s:text>"));
  EXPECT_FALSE(has_text(kShape + "<g class='text' id='image'/><!-- <text>A</text> -->"));
}

TEST(Drawing, NamesAllThatIsNotInItsFile) {
  EXPECT_EQ(outside(""), Names{});
  EXPECT_EQ(outside("<image href='a.png'/><image width='3' href = \"photo 1.png\"/>"
                    "<g xmlns:x='http://www.w3.org/1999/xlink'><image x:href='b.png'/></g>"
                    "<image href='a.png'/>"),
            (Names{"a.png", "photo 1.png", "b.png"}));
  EXPECT_EQ(outside("<use href='other.svg#a'/><rect fill='url(other.svg#b)'/>"
                    "<rect style='fill:red; mask: url( \"m.svg#c\" )'/>"),
            (Names{"other.svg#a", "other.svg#b", "m.svg#c"}));
  EXPECT_EQ(outside("<style>/* url(old.png) */ @import 'a.css'; @font-face{src:url(x.woff)}</style>"
                    "<style><![CDATA[ rect { fill: url('p.svg#p') } ]]></style>"),
            (Names{"x.woff", "a.css", "p.svg#p"}));
  // What is in the file, what is only a way somewhere, and what is no part of the drawing.
  EXPECT_EQ(outside("<defs><g id='a'/></defs><use href='#a'/><rect fill='url(#a)'/>"
                    "<a href='http://example.com'><rect/></a><!-- <image href='old.png'/> -->"
                    "<desc>url(x) &lt;image href='x'></desc>"),
            Names{});
  const Drawing styled = Drawing::from_svg(
      bytes_of("<?xml version='1.0'?><?xml-stylesheet type='text/css' href='s.css'?>"
               "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'>" +
               kShape + "</svg>"),
      "test.svg");
  EXPECT_EQ(styled.contents().outside, Names{"s.css"});
  // Looking for the end of each of very many would take minutes.
  std::string comment = "<!--";
  for (int i = 0; i < 300'000; ++i) comment += " <image";
  EXPECT_EQ(outside(comment + "--><image href='b.png'/>"), Names{"b.png"});
}

std::string in_base64(const std::vector<std::uint8_t>& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t three = 0;
    for (std::size_t i = 0; i < 3; ++i)
      three = three << 8U | (at + i < bytes.size() ? bytes[at + i] : 0U);
    for (std::size_t i = 0; i < 4; ++i)
      out += at + i > bytes.size() ? '=' : kDigits[three >> (18 - 6 * i) & 63U];
  }
  return out;
}

TEST(Drawing, CountsPicturesInItThatAreNotShown) {
  const auto unreadable = [](const std::string& data) {
    return drawing_of(kShape + "<image width='9' height='9' href='data:" + data + "'/>")
        .contents()
        .unreadable_pictures;
  };
  Image image(40, 40);
  std::vector<std::uint8_t> clear = encode_png(image);
  std::fill(image.rgba.begin(), image.rgba.end(), std::uint8_t(200));
  std::vector<std::uint8_t> png = encode_png(image);
  EXPECT_EQ(unreadable("image/png;base64," + in_base64(png)), 0);
  EXPECT_EQ(unreadable("image/jpeg;base64," + in_base64(encode_jpeg(image, 90))), 0);
  EXPECT_EQ(unreadable("image/png;base64," + in_base64(clear)), 0);
  EXPECT_EQ(unreadable("image/png;base64,AAAA"), 1);
  EXPECT_EQ(unreadable("image/png;base64,"), 1);
  EXPECT_EQ(unreadable("image/png"), 1);
  std::vector<std::uint8_t> damaged = png;
  damaged[20] ^= 0x55U;
  EXPECT_EQ(unreadable("image/png;base64," + in_base64(damaged)), 1);
  EXPECT_EQ(unreadable("image/jp2;base64," + in_base64(bytes_of("\xff\x4f\xff\x51"))), 1);
}

// ---- pictures in drawings that say more than their pixels ----

using Bytes = std::vector<std::uint8_t>;

void put_big_endian(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    out.push_back(std::uint8_t(value >> unsigned(shift)));
}

// With a chunk after the header.
Bytes png_with(const Image& image, const std::string& name, const Bytes& data) {
  constexpr std::ptrdiff_t kHeaderEnd = 33;
  Bytes named = bytes_of(name), chunk, png = encode_png(image);
  named.insert(named.end(), data.begin(), data.end());
  put_big_endian(chunk, std::uint32_t(data.size()));
  chunk.insert(chunk.end(), named.begin(), named.end());
  put_big_endian(chunk, std::uint32_t(crc32(0, named.data(), uInt(named.size()))));
  png.insert(png.begin() + kHeaderEnd, chunk.begin(), chunk.end());
  return png;
}

// With a marker's data before all others.
Bytes jpeg_with(const Image& image, int marker, const std::string& data) {
  Bytes jpeg = encode_jpeg(image, 100);
  const std::size_t length = data.size() + 2;
  Bytes piece = {0xff, std::uint8_t(marker), std::uint8_t(length >> 8U), std::uint8_t(length)};
  piece.insert(piece.end(), data.begin(), data.end());
  jpeg.insert(jpeg.begin() + 2, piece.begin(), piece.end());
  return jpeg;
}

// "Lies on its side."
std::string turned_exif(char orientation) {
  return std::string("MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0", 19) + orientation +
         std::string("\0\0\0\0\0\0", 6);
}

// Four fields of 20 x 10 pixels.
Image fields() {
  Image image(40, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) {
      std::uint8_t* pixel = image.pixel(x, y);
      pixel[0] = x < 20 ? 200 : 60;
      pixel[1] = y < 10 ? 180 : 80;
      pixel[2] = 90;
      pixel[3] = 255;
    }
  return image;
}

struct Shown {
  Image image;
  int unreadable = 0;
  std::vector<std::string> warnings;
};

// As an SVG of the picture's own size shows it, a pixel for a pixel.
Shown shown_in_drawing(const Bytes& file, int width, int height,
                       const std::string& link = "xlink:href") {
  const RunContext context;
  const RunScope scope(context);
  const Drawing drawing = Drawing::from_svg(
      bytes_of(fmt::format("<s:svg xmlns:s='http://www.w3.org/2000/svg' "
                           "xmlns:xlink='http://www.w3.org/1999/xlink' viewBox='0 0 {0} {1}'>"
                           "<s:rect width='1' height='1'/><s:image width='{0}' height='{1}' "
                           "preserveAspectRatio='none' {2}='data:image/x;base64,\n{3}'/></s:svg>",
                           width, height, link, in_base64(file))),
      "test.svg");
  return {drawing.pixels(width, height), drawing.contents().unreadable_pictures,
          context.warnings()};
}

TEST(PictureInADrawing, LooksAsItDoesByItself) {
  const Bytes display_p3 = {12, 13, 0, 1};
  const std::string exif = turned_exif(6);
  for (const Bytes& file :
       {png_with(fields(), "cICP", display_p3), png_with(fields(), "eXIf", bytes_of(exif)),
        jpeg_with(fields(), 0xe1, std::string("Exif\0\0", 6) + exif)}) {
    const Image alone = decode_image(file, "alone");
    ASSERT_NE(alone.rgba, fields().rgba);
    for (const char* link : {"xlink:href", "href"}) {
      const Shown shown = shown_in_drawing(file, alone.width_px, alone.height_px, link);
      EXPECT_TRUE(shown.warnings.empty());
      EXPECT_EQ(shown.unreadable, 0);
      // But for the corner, where something else could be seen.
      int off = 0;
      for (std::size_t i = 4; i < alone.rgba.size(); ++i)
        off = std::max(off, std::abs(int(alone.rgba[i]) - int(shown.image.rgba[i])));
      EXPECT_LE(off, 1) << link;
    }
  }
}

TEST(PictureInADrawing, WarnsAsItDoesByItself) {
  const Shown shown = shown_in_drawing(
      jpeg_with(fields(), 0xe2, std::string("ICC_PROFILE\0\1\1no profile", 24)), 40, 20);
  ASSERT_EQ(shown.warnings.size(), 1U);
  EXPECT_NE(shown.warnings[0].find("test.svg, picture 1: its colour profile is damaged"),
            std::string::npos)
      << shown.warnings[0];
  EXPECT_NEAR(shown.image.pixel(30, 15)[0], 60, 3);
}

// Of a billion pixels in a small file nothing is unpacked.
TEST(PictureInADrawing, ThatIsTooLargeIsNamedAndLeftOut) {
  Bytes png = png_with(fields(), "cICP", {12, 13, 0, 1});
  constexpr std::size_t kWidth = 16, kHeight = 20, kType = 12, kCheck = 29;
  for (const std::size_t at : {kWidth, kHeight}) png[at + 2] = 0xf0;
  Bytes check;
  put_big_endian(check, std::uint32_t(crc32(0, png.data() + kType, uInt(kCheck - kType))));
  std::copy(check.begin(), check.end(), png.begin() + kCheck);
  const Shown shown = shown_in_drawing(png, 40, 20);
  ASSERT_EQ(shown.warnings.size(), 1U);
  EXPECT_TRUE(shown.warnings[0].starts_with("test.svg, picture 1: the image is "))
      << shown.warnings[0];
  EXPECT_NE(shown.warnings[0].find("It is not shown."), std::string::npos);
  EXPECT_EQ(shown.image.pixel(30, 15)[3], 0);
}

Image noise(int side_px) {
  Image noise(side_px, side_px);
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < noise.rgba.size(); ++i) {
    state = state * 1664525U + 1013904223U;
    noise.rgba[i] = i % 4 == 3 ? 255 : std::uint8_t(state >> 24U);
  }
  return noise;
}

// As plain PNG it has more than the 10 MB that an attribute may have otherwise.
TEST(PictureInADrawing, MayGrowSlow) {
  const Image image = noise(1600);
  Bytes jpeg = jpeg_with(image, 0xe1, std::string("Exif\0\0", 6) + turned_exif(3));
  ASSERT_LT(jpeg.size(), 7'000'000U);
  ASSERT_GT(encode_png(image).size(), 7'600'000U);
  const Shown shown = shown_in_drawing(jpeg, 180, 180);
  EXPECT_TRUE(shown.warnings.empty());
  EXPECT_EQ(shown.image.pixel(90, 90)[3], 255);
}

// As a picture program's drawing of one photo is.
TEST(PictureInADrawing, MayBeLargeSlow) {
  const Drawing drawing = Drawing::from_svg(
      bytes_of("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 60 60'><image width='60' "
               "height='60' href='data:image/png;base64," +
               in_base64(encode_png(noise(1700))) + "'/></svg>"),
      "test.svg");
  EXPECT_EQ(drawing.contents().unreadable_pictures, 0);
  const Image image = drawing.pixels(60, 60);
  // Every pixel is the mean of many: middling grey.
  double sum = 0;
  for (int y = 1; y < 60; ++y)
    for (int x = 1; x < 60; ++x) {
      EXPECT_EQ(image.pixel(x, y)[3], 255);
      for (int c = 0; c < 3; ++c) sum += image.pixel(x, y)[c];
    }
  EXPECT_NEAR(sum / (3 * 59 * 59), 127.5, 2);
}

// Ten of ten of ten ...: a gigabyte, if anybody wrote it out. In one byte a letter, or in two.
TEST(Drawing, EntitiesThatMultiplyAreRefused) {
  std::string svg = "<!DOCTYPE svg [<!ENTITY a0 '0123456789'>";
  for (int k = 1; k < 9; ++k) {
    svg += "<!ENTITY a" + std::to_string(k) + " '";
    for (int n = 0; n < 10; ++n) svg += "&a" + std::to_string(k - 1) + ";";
    svg += "'>";
  }
  svg += "]><svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><text>&a8;</text></svg>";
  std::string wide = "\xff\xfe";
  for (const char c : svg) wide += std::string(1, c) + std::string(1, '\0');
  for (const std::string& text : {svg, wide}) {
    EXPECT_TRUE(declares_entities(text));
    EXPECT_THROW(Drawing::from_svg({text.begin(), text.end()}, "test.svg"), InputError);
  }
  // In a drawing in the drawing, too.
  const Shown shown = shown_in_drawing({svg.begin(), svg.end()}, 40, 20);
  EXPECT_EQ(shown.unreadable, 1);
  EXPECT_EQ(shown.image.pixel(30, 10)[3], 0);
  EXPECT_FALSE(declares_entities("<svg><text>ENTITY &lt;!ENTIT</text></svg>"));
}

TEST(PictureInADrawing, WithNothingToSayStaysAsItIs) {
  EXPECT_FALSE(says_more_than_pixels(encode_png(fields())));
  EXPECT_FALSE(says_more_than_pixels(encode_jpeg(fields(), 90)));
  EXPECT_FALSE(says_more_than_pixels(
      jpeg_with(fields(), 0xe1, std::string("Exif\0\0", 6) + turned_exif(1))));
  EXPECT_TRUE(says_more_than_pixels(png_with(fields(), "iCCP", {1, 2, 3})));
  EXPECT_FALSE(says_more_than_pixels({}));
  const std::string svg =
      "<svg xmlns='http://www.w3.org/2000/svg'><!-- data:b --><image "
      "href='data:a'/><image href=' data:b '/><text>data:b</text></svg>";
  const std::string other = with_pictures(svg, {{"data:b", "data:c"}});
  EXPECT_NE(other.find("\"data:a\""), other.npos) << other;
  EXPECT_NE(other.find("\"data:c\""), other.npos) << other;
  EXPECT_NE(other.find("<!-- data:b -->"), other.npos) << other;
  EXPECT_NE(other.find("<text>data:b</text>"), other.npos) << other;
  // No cut of a file takes what is not there.
  for (Bytes file : {png_with(fields(), "cICP", {12, 13, 0, 1}),
                     jpeg_with(fields(), 0xe2, std::string("ICC_PROFILE\0\1\1no", 16))})
    for (; !file.empty(); file.pop_back()) says_more_than_pixels(file);
}

std::vector<std::uint8_t> gzipped(const std::string& text) {
  std::vector<std::uint8_t> out(text.size() + 1000);
  z_stream stream{};
  constexpr int kGzip = 16 + MAX_WBITS;
  deflateInit2(&stream, 9, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY);
  std::string copy = text;
  stream.next_in = reinterpret_cast<Bytef*>(copy.data());
  stream.avail_in = uInt(copy.size());
  stream.next_out = out.data();
  stream.avail_out = uInt(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

TEST(Drawing, IsTheSamePackedOrWithAPrefix) {
  const std::string inside = "<circle cx='100' cy='90' r='80' fill='#c02'/>";
  const Image plain = drawing_of(inside).pixels(60, 40);
  const std::string svg =
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 300 200'>" + inside + "</svg>";
  const std::vector<std::uint8_t> packed = gzipped(svg);
  EXPECT_TRUE(looks_like_svg(packed));
  EXPECT_EQ(Drawing::from_svg(packed, "a.svgz").pixels(60, 40).rgba, plain.rgba);
  const std::string prefixed =
      "<s:svg xmlns:s='http://www.w3.org/2000/svg' viewBox='0 0 300 200'><s:circle cx='100' "
      "cy='90' r='80' fill='#c02'/></s:svg>";
  EXPECT_TRUE(looks_like_svg(bytes_of(prefixed)));
  EXPECT_EQ(Drawing::from_svg(bytes_of(prefixed), "a.svg").pixels(60, 40).rgba, plain.rgba);
  EXPECT_FALSE(looks_like_svg(gzipped("no drawing")));
  EXPECT_FALSE(looks_like_svg(bytes_of("<html>svg</html>")));
  for (std::size_t size = 3; size < packed.size() - 8; size += 7)
    EXPECT_THROW(Drawing::from_svg({packed.begin(), packed.begin() + std::ptrdiff_t(size)}, "cut"),
                 InputError)
        << size;
}

TEST(Drawing, TakesNoMoreThanItMay) {
  const Drawing noise = drawing_of(
      "<defs><linearGradient id='g'><stop stop-color='#f00'/><stop offset='1' stop-color='#00f'/>"
      "</linearGradient></defs><rect width='300' height='200' fill='url(#g)'/>");
  EXPECT_FALSE(noise.tiles(3000, 2000, 1 << 20U).has_value());
  EXPECT_TRUE(noise.tiles(300, 200, 1 << 20U).has_value());
}

TEST(Fonts, AreTakenApart) {
  const FontWish wish = parse_font("DejaVu Serif bold italic");
  EXPECT_EQ(wish.family, "DejaVu Serif");
  EXPECT_TRUE(wish.bold && wish.italic);
  EXPECT_EQ(parse_font("").family, "sans-serif");
  EXPECT_EQ(parse_font("italic sans").family, "italic sans");
  EXPECT_EQ(parse_font("Semibold").family, "Semibold");
}

TEST(Fonts, AreFilesOfThisMachine) {
  const std::vector<FontUse> fonts = fonts_for("No. 7", parse_font("sans bold"), "test");
  ASSERT_EQ(fonts.size(), 1U);
  EXPECT_TRUE(std::filesystem::is_regular_file(fonts[0].file));
  EXPECT_TRUE(fonts[0].is_wanted);
  // By its own name it is found again; another is taken for one that nobody has.
  const std::string family = fonts[0].name.substr(0, fonts[0].name.rfind(' '));
  EXPECT_TRUE(fonts_for("7", parse_font(family), "test").front().is_wanted);
  EXPECT_FALSE(fonts_for("7", parse_font("No Such Font 7"), "test").front().is_wanted);
  EXPECT_TRUE(fonts_for(" ", parse_font("sans"), "test").empty());
}

TEST(Fonts, LettersThatNoneHasAreNamedOnce) {
  const FontWish wish = parse_font("sans");
  EXPECT_TRUE(letters_without_font("No. 7 \u200d", wish, "test").empty());
  const std::vector<std::string> none = {"\xf4\x8f\xbf\xbd", "\xf4\x8f\xbf\xbc"};
  EXPECT_EQ(letters_without_font(none[0] + "7" + none[1] + none[0], wish, "test"), none);
  EXPECT_THROW(letters_without_font("a\xff", wish, "test"), InputError);
}

// Capitals stand on it; blanks before a letter move it.
TEST(Lines, LieOnTheirBaseLine) {
  EXPECT_FALSE(Drawing::of_line(" \u3000", "sans").has_value());
  const auto letter = Drawing::of_line("H", "sans"), far = Drawing::of_line("      H", "sans");
  ASSERT_TRUE(letter && far);
  EXPECT_NEAR(letter->place.min.y(), 0, 0.02);
  EXPECT_GT(letter->place.max.y(), 0.6);
  EXPECT_LT(letter->place.max.y(), 0.8);
  EXPECT_GT(far->place.min.x(), letter->place.min.x() + 1);
  const Vec2 size = letter->place.max - letter->place.min;
  EXPECT_NEAR(letter->drawing.aspect(), size.x() / size.y(), 1e-9);
}

TEST(Fonts, WhatCannotBeSetIsRefused) {
  EXPECT_THROW(fonts_for("\xf4\x8f\xbf\xbd", parse_font("sans"), "test"), InputError);
  EXPECT_THROW(fonts_for("a\xff", parse_font("sans"), "test"), InputError);
  ArtworkLayer layer;
  layer.text = "\xf4\x8f\xbf\xbd";
  EXPECT_THROW(PictureSource{layer}, InputError);
  layer.text = "7";
  EXPECT_NO_THROW(PictureSource{layer});
  layer.image = "logo.png";
  EXPECT_THROW(PictureSource{layer}, InputError);  // either of them
}

}  // namespace
}  // namespace hydrodip
