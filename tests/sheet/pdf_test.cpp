#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <tuple>
#include <vector>

#include "artwork/drawing.h"
#include "base/error.h"
#include "base/file.h"
#include "base/math.h"
#include "full_disk.h"
#include "sheet/pdf_document.h"
#include "sheet/sheet.h"
#include "sheet/sheet_testing.h"

namespace hydrodip {
namespace {

using fixtures::blank_image;
using fixtures::device_profile;
using fixtures::has_tool;
using fixtures::patterned_image;
using fixtures::patterned_inks;
using fixtures::rasterised;
using fixtures::run_tool;
using fixtures::sheet;

class PrintPdf : public fixtures::InFolder {
 protected:
  std::filesystem::path write(const Image& image, const SheetOptions& options) {
    const std::filesystem::path path = folder_ / "print.pdf";
    write_print_pdf(path, image, srgb_profile(), options, context_);
    return path;
  }
  std::string info(const std::filesystem::path& path) {
    const auto [status, said] = run_tool("pdfinfo " + path.string());
    EXPECT_EQ(status, 0);
    EXPECT_EQ(said.find("Error"), std::string::npos) << said;
    EXPECT_EQ(said.find("Warning"), std::string::npos) << said;
    return said;
  }
  static std::string contents(const std::filesystem::path& path) {
    const auto bytes = read_file(path);
    return {bytes.begin(), bytes.end()};
  }
  RunContext context_;
};

int darkness(const Image& image, int x, int y) {
  const std::uint8_t* pixel = image.pixel(x, y);
  return 255 - (pixel[0] + pixel[1] + pixel[2]) / 3;
}

// Centres of the dark runs of a row, in pixels from its left end, weighted by darkness.
std::vector<double> dark_runs(const Image& image, int y) {
  std::vector<double> centres;
  double sum = 0, moment = 0;
  for (int x = 0; x <= image.width_px; ++x) {
    const int dark = x < image.width_px ? darkness(image, x, y) : 0;
    if (dark > 8) {
      sum += dark;
      moment += dark * (x + 0.5);
    } else if (sum > 0) {
      centres.push_back(moment / sum);
      sum = moment = 0;
    }
  }
  return centres;
}

// Where the ruler's ticks are, mm from the page's left edge, in the row that shows `count` of them
// at equal distances; empty if there is none.
std::vector<double> measured_ticks(const Image& bottom, int dpi, std::size_t count) {
  for (int y = 0; y < bottom.height_px; ++y) {
    std::vector<double> x = dark_runs(bottom, y);
    if (x.size() != count) continue;
    const double step = (x.back() - x.front()) / double(count - 1);
    bool even = true;
    for (std::size_t i = 0; i < count; ++i) {
      even = even && std::abs(x[i] - x.front() - double(i) * step) < 1.5;
    }
    if (!even) continue;
    for (double& value : x) value *= kMmPerInch / dpi;
    return x;
  }
  return {};
}

TEST_F(PrintPdf, ThePageHasTheFilmsSize) {
  if (!has_tool("pdfinfo")) GTEST_SKIP() << "needs pdfinfo";
  struct Case {
    double width_mm, height_mm;
    const char* said;
  };
  for (const Case& c :
       {Case{210, 297, "595.276 x 841.89 pts (A4)"}, Case{215.9, 279.4, "612 x 792 pts (letter)"},
        Case{297, 420, "841.89 x 1190.55 pts (A3)"}, Case{60, 60, "170.079 x 170.079 pts"}}) {
    const SheetOptions options = sheet(c.width_mm, c.height_mm, 10, 72);
    const std::string said = info(write(blank_image(options), options));
    EXPECT_NE(said.find(c.said), std::string::npos) << said;
    EXPECT_NE(said.find("Pages:           1\n"), std::string::npos) << said;
  }
}

TEST_F(PrintPdf, TheRulerMeasuresOneHundredMillimetres) {
  if (!has_tool("pdftoppm")) GTEST_SKIP() << "needs pdftoppm";
  constexpr int kDpi = 600;
  const SheetOptions options = sheet(210, 297, 10, 100);
  const auto path = write(blank_image(options), options);
  const Image bottom = rasterised(path, kDpi, 0, int(287 / 25.4 * kDpi), 4961, 240);
  const std::vector<double> tens = measured_ticks(bottom, kDpi, 11);
  ASSERT_EQ(tens.size(), 11u);
  EXPECT_NEAR(tens.back() - tens.front(), 100, 0.05);
  EXPECT_NEAR(tens[5], 105, 0.05);
  const std::vector<double> ones = measured_ticks(bottom, kDpi, 101);
  ASSERT_EQ(ones.size(), 101u);
  EXPECT_NEAR(ones.back() - ones.front(), 100, 0.05);
}

TEST_F(PrintPdf, ATinySheetsRulerMeasuresWhatItSays) {
  if (!has_tool("pdftoppm")) GTEST_SKIP() << "needs pdftoppm";
  constexpr int kDpi = 600;
  const SheetOptions options = sheet(60, 60, 10, 100);
  const auto path = write(blank_image(options), options);
  const Image bottom = rasterised(path, kDpi, 0, int(50 / 25.4 * kDpi), 1418, 240);
  const std::vector<double> ones = measured_ticks(bottom, kDpi, 31);
  ASSERT_EQ(ones.size(), 31u);
  EXPECT_NEAR(ones.back() - ones.front(), 30, 0.05);
}

// Pictures a patch of 5 x 5 pixels and returns where its centre should lie, in film coordinates.
Vec2 paint_patch(Image& image, const SheetOptions& options, int x, int y) {
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i) {
      const std::array<std::uint8_t, 4> red = {255, 0, 0, 255};
      std::copy(red.begin(), red.end(), image.pixel(x + i, y + j));
    }
  }
  const double pixel_mm = kMmPerInch / options.dpi;
  return {(x + 0.5 - 0.5 * image.width_px) * pixel_mm,
          (0.5 * image.height_px - y - 0.5) * pixel_mm};
}

// Where the red around a film point really is, in film coordinates.
Vec2 measured_patch(const std::filesystem::path& pdf, const SheetOptions& options, const Vec2& u) {
  constexpr int kDpi = 600;
  constexpr int kHalf = 60;
  const double to_px = kDpi / kMmPerInch;
  const int left = int((0.5 * options.width_mm + u.x()) * to_px) - kHalf;
  const int top = int((0.5 * options.height_mm - u.y()) * to_px) - kHalf;
  const Image part = rasterised(pdf, kDpi, left, top, 2 * kHalf, 2 * kHalf);
  double sum = 0;
  Vec2 moment = Vec2::Zero();
  for (int y = 0; y < part.height_px; ++y) {
    for (int x = 0; x < part.width_px; ++x) {
      const std::uint8_t* pixel = part.pixel(x, y);
      const double red = pixel[0] - 0.5 * (pixel[1] + pixel[2]);
      sum += red;
      moment += red * Vec2(x + 0.5, y + 0.5);
    }
  }
  EXPECT_GT(sum, 0) << "nothing printed near " << u.transpose();
  const Vec2 at = moment / sum;
  return {(left + at.x()) / to_px - 0.5 * options.width_mm,
          0.5 * options.height_mm - (top + at.y()) / to_px};
}

TEST_F(PrintPdf, APatchLandsWhereTheFilmHasIt) {
  if (!has_tool("pdftoppm")) GTEST_SKIP() << "needs pdftoppm";
  for (const Vec2& size : {Vec2(210, 297), Vec2(215.9, 279.4), Vec2(60, 60.05)}) {
    for (const bool up : {true, false}) {
      if (size.x() == 210 && !up) continue;  // large pages take a while
      SheetOptions options = sheet(size.x(), size.y(), 10, 150);
      options.ink_side_up = up;
      Image image = blank_image(options);
      const std::vector<Vec2> wanted = {
          paint_patch(image, options, 70, 81),
          paint_patch(image, options, image.width_px - 80, image.height_px - 90)};
      const auto path = write(image, options);
      for (const Vec2& u : wanted) {
        const Vec2 printed(up ? u.x() : -u.x(), u.y());
        const Vec2 found = measured_patch(path, options, printed);
        EXPECT_NEAR(found.x(), printed.x(), 0.05) << size.transpose() << " up " << up;
        EXPECT_NEAR(found.y(), printed.y(), 0.05) << size.transpose() << " up " << up;
      }
    }
  }
}

TEST_F(PrintPdf, PartialCoverageIsWhitePaperBetweenTheInk) {
  if (!has_tool("pdftoppm")) GTEST_SKIP() << "needs pdftoppm";
  const SheetOptions options = sheet(101.6, 101.6, 10, 50);  // 200 x 200 pixels
  Image image = blank_image(options);
  ASSERT_EQ(image.width_px, 200);
  for (int y = 80; y < 120; ++y) {
    for (int x = 60; x < 140; ++x) {
      std::uint8_t* pixel = image.pixel(x, y);
      pixel[0] = 10;
      pixel[1] = 110;
      pixel[2] = 255;
      pixel[3] = x < 100 ? 255 : 51;  // full, one fifth
    }
  }
  const Image page = rasterised(write(image, options), 50, 0, 0, 200, 200);
  const auto color = [&](int x, int y) {
    const std::uint8_t* p = page.pixel(x, y);
    return std::array<int, 3>{p[0], p[1], p[2]};
  };
  EXPECT_EQ(color(80, 100), (std::array<int, 3>{10, 110, 255}));
  EXPECT_EQ(color(120, 100), (std::array<int, 3>{206, 226, 255}));
  EXPECT_EQ(color(80, 60), (std::array<int, 3>{255, 255, 255}));
  EXPECT_EQ(color(50, 100), (std::array<int, 3>{255, 255, 255}));
}

TEST_F(PrintPdf, EveryPixelOfThePictureIsKept) {
  if (!has_tool("pdfimages")) GTEST_SKIP() << "needs pdfimages";
  for (const bool up : {true, false}) {
    SheetOptions options = sheet(101.6, 81.3, 5, 50);
    options.ink_side_up = up;
    Image image = patterned_image(options);
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    const std::string root = (folder_ / "picture").string();
    const auto [status, said] =
        run_tool("pdfimages -png " + write(image, options).string() + " " + root);
    EXPECT_EQ(status, 0) << said;
    const Image kept = load_image(root + "-000.png");
    ASSERT_EQ(kept.width_px, image.width_px);
    ASSERT_EQ(kept.height_px, image.height_px);
    std::size_t wrong = 0;
    for (int y = 0; y < image.height_px; ++y) {
      for (int x = 0; x < image.width_px; ++x) {
        const std::uint8_t* wanted = image.pixel(up ? x : image.width_px - 1 - x, y);
        wrong += !std::equal(wanted, wanted + 3, kept.pixel(x, y));
      }
    }
    EXPECT_EQ(wrong, 0u) << "up " << up;
  }
}

TEST_F(PrintPdf, MarksLeaveTheFreeFilmWhiteAndReachAllFourEdges) {
  if (!has_tool("pdftoppm")) GTEST_SKIP() << "needs pdftoppm";
  constexpr int kDpi = 150;
  const double to_px = kDpi / kMmPerInch;
  for (const double margin : {10.0, 5.0}) {
    SheetOptions options = sheet(150, 200, margin, 72);
    options.job_name = std::string(400, 'W');
    const int width = int(options.width_mm * to_px);
    const int height = int(options.height_mm * to_px);
    const Image page = rasterised(write(blank_image(options), options), kDpi, 0, 0, width, height);
    const int inner = int(std::ceil(margin * to_px)) + 1;
    int worst = 0;
    for (int y = inner; y < height - inner; ++y) {
      for (int x = inner; x < width - inner; ++x) worst = std::max(worst, darkness(page, x, y));
    }
    EXPECT_EQ(worst, 0);
    const auto dark_near = [&](int x, int y) {
      int dark = 0;
      for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) dark = std::max(dark, darkness(page, x + i, y + j));
      }
      return dark;
    };
    EXPECT_GT(dark_near(width / 2, 2), 60);
    EXPECT_GT(dark_near(width / 2, height - 3), 60);
    EXPECT_GT(dark_near(2, height / 2), 60);
    EXPECT_GT(dark_near(width - 3, height / 2), 60);
  }
}

// A cross through a square of colour: drawn outside of it, mirrored as the image is, not inside.
TEST_F(PrintPdf, OutlinesGiveWayToColour) {
  if (!has_tool("pdftoppm")) GTEST_SKIP() << "needs pdftoppm";
  constexpr int kDpi = 200;
  for (const bool up : {true, false}) {
    SheetOptions options = sheet(101.6, 101.6, 10, 50);
    options.ink_side_up = up;
    options.outlines = {{Vec2(-60, 5), Vec2(60, 5)}, {Vec2(25, -20), Vec2(25, 20)}};
    Image image = blank_image(options);
    for (int y = 80; y < 120; ++y)
      for (int x = 80; x < 120; ++x) image.pixel(x, y)[3] = 255;  // black, 10 mm to all sides
    const Image page = rasterised(write(image, options), kDpi, 0, 0, 800, 800);
    const auto dark_at = [&](double x_mm, double y_mm) {
      const double side = up ? 1 : -1;
      int dark = 0;
      for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i)
          dark = std::max(dark, darkness(page, int((50.8 + side * x_mm) * kDpi / kMmPerInch) + i,
                                         int((50.8 - y_mm) * kDpi / kMmPerInch) + j));
      return dark;
    };
    EXPECT_GT(dark_at(25, -12), 60);
    EXPECT_EQ(dark_at(-25, -12), 0) << "mirrored with the image";
    EXPECT_GT(dark_at(20, 5), 60);
    EXPECT_GT(dark_at(-20, 5), 60);
    EXPECT_EQ(dark_at(10.4 + 0.2, 5 + 3), 0);
    EXPECT_EQ(dark_at(41.4, 5), 0) << "not in the margin";
    const auto [red, green] = std::pair(page.pixel(400, 400)[0], page.pixel(400, 361)[1]);
    EXPECT_EQ(red, 0);
    EXPECT_EQ(green, 0) << "the colour is whole where the line would cross it";
  }
}

TEST_F(PrintPdf, ADiscsRimIsOnThePage) {
  if (!has_tool("pdftoppm")) GTEST_SKIP() << "needs pdftoppm";
  constexpr int kDpi = 150;
  SheetOptions options = sheet(200, 220, 10, 72);
  options.disc = true;
  const Image page = rasterised(write(blank_image(options), options), kDpi, 0, 0, 1181, 1299);
  int on_rim = 0;
  int inside = 0;
  for (int y = 0; y < page.height_px; ++y) {
    for (int x = 0; x < page.width_px; ++x) {
      const double to_mm = kMmPerInch / kDpi;
      const double radius = std::hypot((x + 0.5) * to_mm - 100, (y + 0.5) * to_mm - 110);
      if (radius < 89.8) inside = std::max(inside, darkness(page, x, y));
      on_rim += std::abs(radius - 90.1) < 0.2 && darkness(page, x, y) > 60;
    }
  }
  EXPECT_GT(on_rim, 500);
  EXPECT_EQ(inside, 0);
}

TEST_F(PrintPdf, TheTextsCanBeReadByAnotherProgram) {
  if (!has_tool("pdftotext")) GTEST_SKIP() << "needs pdftotext";
  SheetOptions options = sheet(210, 297, 10, 72);
  options.job_name = "Gr\u00f6\u00dfe (80\\%) \u0141";
  const auto path = write(blank_image(options), options);
  auto [status, said] = run_tool("pdftotext -raw -enc UTF-8 " + path.string() + " -");
  EXPECT_EQ(status, 0);
  // It puts the words of turned texts on lines of their own.
  std::replace(said.begin(), said.end(), '\n', ' ');
  for (const char* text :
       {"TOP: this side up", "this edge left", "this edge right", "Print at 100 %, no scaling",
        "Gr\u00f6\u00dfe (80\\%) \u0141", "100 mm"}) {
    EXPECT_NE(said.find(text), std::string::npos) << text << " not in:\n" << said;
  }
}

// Polish, Russian, Greek, and accents that stand by themselves.
constexpr const char* kForeign =
    "\u0141\u00f3d\u017a \u041c\u0430\u0441\u043a\u0430 \u03a9 e\u0301";

TEST_F(PrintPdf, LettersThatPdfFontsLackAreTextToo) {
  if (!has_tool("pdftotext")) GTEST_SKIP() << "needs pdftotext";
  SheetOptions options = sheet(210, 297, 10, 72);
  options.job_name = kForeign;
  const auto path = write(blank_image(options), options);
  const auto size = std::filesystem::file_size(path);
  EXPECT_TRUE(context_.warnings().empty());
  EXPECT_NE(info(path).find("Title:           " + options.job_name), std::string::npos);
  const auto [status, said] = run_tool("pdftotext -raw -enc UTF-8 " + path.string() + " -");
  EXPECT_EQ(status, 0);
  // Accents that stand by themselves may come back with their letters.
  const std::string name = options.job_name.substr(0, options.job_name.rfind(' '));
  EXPECT_NE(said.find(name), std::string::npos) << said;
  // A picture of a few letters, and none where the PDF's own fonts have all.
  EXPECT_NE(contents(path).find("/ImageMask true"), std::string::npos);
  options.job_name = "Gr\u00f6\u00dfe 5 \u20ac";
  write(blank_image(options), options);
  EXPECT_LT(size, std::filesystem::file_size(path) + 6000);
  EXPECT_EQ(contents(path).find("/ImageMask"), std::string::npos);
}

// What of the page is dark: its mean and its area, in mm.
struct Darkness {
  double area_mm2 = 0;
  Box2 box;
};
Darkness darkness_of(const Image& page, int dpi) {
  const double mm = kMmPerInch / dpi;
  Darkness all;
  for (int y = 0; y < page.height_px; ++y)
    for (int x = 0; x < page.width_px; ++x) {
      const int dark = darkness(page, x, y);
      all.area_mm2 += dark / 255.0 * mm * mm;
      if (dark > 127) all.box.add(mm * Vec2(x + 0.5, page.height_px - y - 0.5));
    }
  return all;
}

// However they are turned, they lie where their base line is, as large as the font, and as black as
// the letters are.
TEST_F(PrintPdf, LettersThatPdfFontsLackLieWhereTheyShould) {
  if (!has_tool("pdftoppm")) GTEST_SKIP() << "needs pdftoppm";
  constexpr int kDpi = 300, kSide_px = 1500;
  constexpr double kSize_pt = 36, kSide_mm = kSide_px * kMmPerInch / kDpi;
  const double em_mm = kSize_pt * kMmPerPt;
  const auto line = Drawing::of_line(kForeign, "Helvetica");
  ASSERT_TRUE(line.has_value());
  const Image letters = line->drawing.pixels(1000, int(1000 / line->drawing.aspect()));
  double ink = 0;  // share of the drawing
  for (std::size_t i = 3; i < letters.rgba.size(); i += 4)
    ink += letters.rgba[i] / 255.0 / (double(letters.rgba.size()) / 4);
  const Vec2 size_mm = em_mm * (line->place.max - line->place.min);
  for (const int turns : {0, 1, -1}) {
    const Vec2 start = turns == 0 ? Vec2(5, 40) : turns == 1 ? Vec2(40, 5) : Vec2(40, 120);
    PdfDocument pdf;
    pdf.add_page(kSide_mm, kSide_mm);
    pdf.draw_text({kForeign, start, kSize_pt, PdfFont::kRegular, turns, 0});
    pdf.save(folder_ / "letters.pdf");
    const Darkness seen =
        darkness_of(rasterised(folder_ / "letters.pdf", kDpi, 0, 0, kSide_px, kSide_px), kDpi);
    EXPECT_NEAR(seen.area_mm2, ink * size_mm.x() * size_mm.y(), 0.03 * seen.area_mm2) << turns;
    const Vec2 along = turns == 0 ? Vec2(1, 0) : Vec2(0, turns), up(-along.y(), along.x());
    Box2 expected;
    for (const Vec2& corner : {line->place.min, line->place.max})
      expected.add(start + em_mm * (corner.x() * along + corner.y() * up));
    // There is a hundredth of the font size around the letters.
    constexpr double kSlack_mm = 0.3;
    EXPECT_LT((seen.box.min - expected.min).cwiseAbs().maxCoeff(), kSlack_mm) << turns;
    EXPECT_LT((seen.box.max - expected.max).cwiseAbs().maxCoeff(), kSlack_mm) << turns;
    EXPECT_NEAR(pdf.text_width(kForeign), line->place.max.x(), 1e-12);
  }
}

// No font has them: the page says so, and the PDF is whole.
TEST_F(PrintPdf, LettersThatNoFontHasAreReplacedAndToldOf) {
  if (!has_tool("pdftotext")) GTEST_SKIP() << "needs pdftotext";
  SheetOptions options = sheet(210, 297, 10, 72);
  options.job_name = "mask \xf4\x8f\xbf\xbd 2";
  const auto path = write(blank_image(options), options);
  ASSERT_EQ(context_.warnings().size(), 1u);
  EXPECT_NE(context_.warnings()[0].find("'mask ? 2'"), std::string::npos);
  info(path);
  EXPECT_NE(run_tool("pdftotext -raw " + path.string() + " -").second.find("mask ? 2"),
            std::string::npos);
}

// Blanks and marks alone, and no UTF-8 at all.
TEST_F(PrintPdf, NamesThatShowNothingAreNoFault) {
  SheetOptions options = sheet(210, 297, 10, 72);
  for (const char* name : {"\u3000", "\u200d", "\xff\xfe", "\u202e", "\u0301"}) {
    options.job_name = name;
    EXPECT_NO_THROW(write(blank_image(options), options)) << name;
  }
}

TEST_F(PrintPdf, TheProfileIsAttached) {
  if (!has_tool("pdfimages")) GTEST_SKIP() << "needs pdfimages";
  const SheetOptions options = sheet(101.6, 81.3, 5, 50);
  const auto rgb = write(patterned_image(options), options);
  auto [status, said] = run_tool("pdfimages -list " + rgb.string());
  EXPECT_EQ(status, 0);
  EXPECT_NE(said.find(" icc "), std::string::npos) << said;

  const auto cmyk = folder_ / "cmyk.pdf";
  write_print_pdf(cmyk, patterned_inks(options), device_profile(), options, context_);
  std::tie(status, said) = run_tool("pdfimages -list " + cmyk.string());
  EXPECT_EQ(status, 0);
  EXPECT_NE(said.find(" cmyk "), std::string::npos) << said;
  // Ours draws every pixel 1/50 inch wide.
  EXPECT_NE(said.find(" 50    50 "), std::string::npos) << said;
  const auto bytes = read_file(cmyk);
  EXPECT_NE(std::string(bytes.begin(), bytes.end()).find("/OutputIntents"), std::string::npos);
}

// Ghostscript adds up the inks of the page as a printer would get them.
TEST_F(PrintPdf, InksReachThePrinterAsTheyAre) {
  if (!has_tool("gs")) GTEST_SKIP() << "needs gs";
  SheetOptions options = sheet(101.6, 101.6, 0, 50);  // 200 x 200 pixels, no margin: no marks
  options.job_name.clear();
  InkImage inks(200, 200);
  const std::array<std::uint8_t, 4> amount = {51, 102, 153, 204};
  for (int y = 50; y < 150; ++y)
    for (int x = 50; x < 150; ++x) std::copy(amount.begin(), amount.end(), inks.pixel(x, y));
  const auto path = folder_ / "inks.pdf";
  write_print_pdf(path, inks, device_profile(), options, context_);
  const auto [status, said] =
      run_tool("gs -q -dBATCH -dNOPAUSE -r200 -sDEVICE=ink_cov -o - " + path.string());
  EXPECT_EQ(status, 0) << said;
  std::istringstream words(said);
  for (const double expected : {5.0, 10.0, 15.0, 20.0}) {  // % of the page
    double found = -1;
    words >> found;
    EXPECT_NEAR(found, expected, 0.15) << said;
  }
}

TEST_F(PrintPdf, TheSameInputGivesTheSameBytes) {
  const SheetOptions options = sheet(80, 90, 10, 100);
  const Image image = patterned_image(options);
  const auto first = read_file(write(image, options));
  EXPECT_EQ(first, read_file(write(image, options)));
  const std::string text(first.begin(), first.end());
  EXPECT_EQ(text.find("Date"), std::string::npos);
  EXPECT_EQ(text.find("/ID"), std::string::npos);
}

TEST_F(PrintPdf, ADateIsRecordedOnlyWhenGiven) {
  SheetOptions options = sheet(80, 90, 10, 72);
  options.date = "2026-02-03T04:05:06";
  const auto bytes = read_file(write(blank_image(options), options));
  EXPECT_NE(std::string(bytes.begin(), bytes.end()).find("D:20260203040506Z"), std::string::npos);
  options.date = "yesterday";
  EXPECT_THROW(write(blank_image(options), options), InputError);
  options.date = "2026-13-45";
  EXPECT_THROW(write(blank_image(options), options), InputError);
  options.date = "2026-02-03 and more";
  EXPECT_THROW(write(blank_image(options), options), InputError);
}

TEST_F(PrintPdf, TransparentPixelsAreNotStored) {
  const SheetOptions options = sheet(210, 297, 10, 300);
  Image image = blank_image(options);
  image.pixel(1000, 2000)[3] = 255;
  write(image, options);
  EXPECT_LT(std::filesystem::file_size(folder_ / "print.pdf"), 16000u);
}

TEST_F(PrintPdf, FilesThatCannotBeWrittenAreNamed) {
  const SheetOptions options = sheet(80, 90, 10, 72);
  const Image image = patterned_image(options);
  std::ofstream(folder_ / "file") << "x";
  for (const std::filesystem::path& path :
       {folder_ / "missing" / "print.pdf", folder_ / "file" / "print.pdf", folder_.path()}) {
    try {
      write_print_pdf(path, image, srgb_profile(), options, context_);
      FAIL() << path;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
    }
  }
}

TEST_F(PrintPdf, AFullDiskIsNoticed) {
  if (!std::filesystem::is_character_file("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  for (const double size : {40.0, 300.0}) {
    const SheetOptions options = sheet(size, size, 10, 72);
    EXPECT_THROW(
        write_print_pdf("/dev/full", patterned_image(options), srgb_profile(), options, context_),
        InputError);
  }
}

// Whatever the library says of its writing: a file without its end is none. Of the last bytes,
// which leave its buffer when the file is closed, it says nothing.
TEST_F(PrintPdf, AFileThatIsCutShortIsNoticed) {
  const SheetOptions options = sheet(80, 90, 10, 72);
  const auto write = [&](const char* name) {
    write_print_pdf(folder_ / name, patterned_image(options), srgb_profile(), options, context_);
  };
  write("whole.pdf");
  const auto size = rlim_t(std::filesystem::file_size(folder_ / "whole.pdf"));
  for (const rlim_t kept : {rlim_t(3000), size - 8}) {
    const FullDisk disk(kept);
    EXPECT_THROW(write("cut.pdf"), InputError) << kept << " of " << size << " bytes";
  }
}

TEST_F(PrintPdf, ViewersMayNotScaleIt) {
  const SheetOptions options = sheet(80, 90, 10, 72);
  write_print_pdf(folder_ / "print.pdf", patterned_image(options), srgb_profile(), options,
                  context_);
  const auto bytes = read_file(folder_ / "print.pdf");
  EXPECT_NE(std::string(bytes.begin(), bytes.end()).find("/PrintScaling /None"), std::string::npos);
}

TEST_F(PrintPdf, WarnsOfMarksThatHaveNoRoom) {
  const SheetOptions tiny = sheet(30, 30, 3, 72), roomy = sheet(200, 200, 10, 72);
  write_print_pdf(folder_ / "roomy.pdf", patterned_image(roomy), srgb_profile(), roomy, context_);
  EXPECT_TRUE(context_.warnings().empty());
  write_print_pdf(folder_ / "tiny.pdf", patterned_image(tiny), srgb_profile(), tiny, context_);
  EXPECT_FALSE(context_.warnings().empty());
}

TEST_F(PrintPdf, CanBeCancelled) {
  const SheetOptions options = sheet(80, 90, 10, 72);
  context_.cancel();
  EXPECT_THROW(write(patterned_image(options), options), Cancelled);
}

TEST_F(PrintPdf, ImpossibleSheetsAreRefused) {
  const SheetOptions good = sheet(80, 90, 10, 72);
  const Image image = blank_image(good);
  SheetOptions bad = good;
  bad.dpi = 0;
  EXPECT_THROW(write(image, bad), InputError);
  bad = good;
  bad.width_mm = std::nan("");
  EXPECT_THROW(write(image, bad), InputError);
  bad = good;
  bad.margin_mm = 40;
  EXPECT_THROW(write(image, bad), InputError);
  bad = good;
  bad.height_mm = 91;
  EXPECT_THROW(write(image, bad), InputError) << "the image is for another sheet";
  const SheetOptions huge = sheet(6000, 90, 10, 10);
  EXPECT_THROW(write(blank_image(huge), huge), InputError);
}

}  // namespace
}  // namespace hydrodip
