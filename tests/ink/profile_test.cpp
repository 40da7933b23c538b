// ICC profiles: ours, and others' through ours, against Little CMS's own command, transicc.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "base/file.h"
#include "ink/color_model.h"
#include "ink/difference.h"
#include "ink/printer.h"
#include "ink/profiles.h"
#include "ink/rgb_profile.h"
#include "temporary_folder.h"

namespace hydrodip {
namespace {

bool has_tool(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null 2>&1").c_str()) == 0;
}

std::string said_by(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
  std::string text;
  char chunk[4096];
  while (const std::size_t count = std::fread(chunk, 1, sizeof chunk, pipe))
    text.append(chunk, count);
  pclose(pipe);
  return text;
}

class Profiles : public ::testing::Test {
 protected:
  std::filesystem::path save(const std::string& name, const std::vector<std::uint8_t>& bytes) {
    write_file(folder_ / name, bytes.data(), bytes.size());
    return folder_ / name;
  }

  // transicc on lines of numbers; floating point, one line back for each.
  std::vector<std::vector<double>> transicc(const std::string& options,
                                            const std::vector<std::vector<double>>& rows) {
    std::ofstream in(folder_ / "in.txt");
    for (const auto& row : rows) {
      for (const double v : row) in << v << "\n";
    }
    in << "q\n";
    in.close();
    std::istringstream out(
        said_by("transicc -n -v0 " + options + " < " + (folder_ / "in.txt").string()));
    std::vector<std::vector<double>> result;
    for (std::string line; std::getline(out, line);) {
      std::istringstream words(line);
      std::vector<double> row;
      for (double v; words >> v;) row.push_back(v);
      if (!row.empty()) result.push_back(row);
    }
    return result;
  }

  TemporaryFolder folder_;
};

std::vector<SrgbColor> color_cube(int nodes) {
  std::vector<SrgbColor> colors;
  const float step = 1.0F / float(nodes - 1);
  for (int r = 0; r < nodes; ++r)
    for (int g = 0; g < nodes; ++g)
      for (int b = 0; b < nodes; ++b)
        colors.push_back({float(r) * step, float(g) * step, float(b) * step});
  return colors;
}

// There and back with the same model.
double largest_return_error(const ColorModel& model, const std::vector<SrgbColor>& colors) {
  std::vector<Inks> inks(colors.size());
  std::vector<SrgbColor> back(colors.size());
  model.separate(colors.data(), inks.data(), colors.size());
  model.look(inks.data(), back.data(), inks.size());
  double largest = 0;
  for (std::size_t i = 0; i < colors.size(); ++i)
    largest = std::max(largest, color_difference(colors[i], back[i]));
  return largest;
}

TEST_F(Profiles, TheDeviceFormulaReturnsEveryColour) {
  EXPECT_LT(largest_return_error(*make_device_model(), color_cube(9)), 1e-3);
}

// The profile in print.tif says what the formula says.
TEST_F(Profiles, OurProfileIsTheDeviceFormula) {
  const auto device = make_device_model();
  const auto profile = make_profile_model(device->profile(), "device", RenderingIntent::kRelative);
  EXPECT_EQ(profile->name(), "hydrodip device formula");
  double sum = 0, largest = 0;
  const auto colors = color_cube(9);
  for (const SrgbColor& color : colors) {
    Inks inks;
    device->separate(&color, &inks, 1);
    SrgbColor seen;
    profile->look(&inks, &seen, 1);
    const double difference = color_difference(color, seen);
    sum += difference;
    largest = std::max(largest, difference);
  }
  EXPECT_LT(sum / double(colors.size()), 0.5);
  EXPECT_LT(largest, 5);  // between the nodes of its tables, where an ink just runs out
}

TEST_F(Profiles, TheSameBytesEveryTime) {
  EXPECT_EQ(make_device_model()->profile(), make_device_model()->profile());
  EXPECT_GT(srgb_profile().size(), 300u);
}

TEST_F(Profiles, TransiccGivesTheSameInks) {
  if (!has_tool("transicc")) GTEST_SKIP() << "needs transicc";
  const std::filesystem::path installed = installed_cmyk_profile();
  if (installed.empty()) GTEST_SKIP() << "no CMYK profile is installed";
  const auto model =
      make_profile_model(read_file(installed), "installed", RenderingIntent::kRelative);
  const std::vector<SrgbColor> colors = color_cube(4);
  std::vector<std::vector<double>> rows;
  for (const SrgbColor& c : colors)
    rows.push_back({255.0 * double(c.r), 255.0 * double(c.g), 255.0 * double(c.b)});
  const auto inks = transicc("-i*sRGB -o" + installed.string() + " -t1 -b", rows);
  ASSERT_EQ(inks.size(), colors.size());
  std::vector<Inks> ours(colors.size());
  model->separate(colors.data(), ours.data(), colors.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    ASSERT_EQ(inks[i].size(), 4u);
    EXPECT_NEAR(100 * double(ours[i].c), inks[i][0], 0.5) << i;
    EXPECT_NEAR(100 * double(ours[i].m), inks[i][1], 0.5) << i;
    EXPECT_NEAR(100 * double(ours[i].y), inks[i][2], 0.5) << i;
    EXPECT_NEAR(100 * double(ours[i].k), inks[i][3], 0.5) << i;
  }

  const auto back = transicc("-i" + installed.string() + " -o*sRGB -t1 -b", inks);
  ASSERT_EQ(back.size(), colors.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    SrgbColor seen;
    model->look(&ours[i], &seen, 1);
    const SrgbColor theirs{float(back[i][0] / 255), float(back[i][1] / 255),
                           float(back[i][2] / 255)};
    EXPECT_LT(color_difference(seen, theirs), 1) << i;
  }
}

// An image with these colours side by side.
Image row_of(const std::vector<SrgbColor>& colors) {
  Image image(int(colors.size()), 1);
  const auto byte = [](float v) { return std::uint8_t(std::lround(255 * v)); };
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const SrgbColor& c = colors[i];
    const std::uint8_t pixel[4] = {byte(c.r), byte(c.g), byte(c.b), std::uint8_t(i)};
    std::copy_n(pixel, 4, image.pixel(int(i), 0));
  }
  return image;
}

TEST_F(Profiles, TransiccGivesTheSameColoursToAnRgbPrinter) {
  if (!has_tool("transicc")) GTEST_SKIP() << "needs transicc";
  const std::string printer = "/usr/share/color/icc/ghostscript/a98.icc";
  if (!std::filesystem::exists(printer)) GTEST_SKIP() << "needs Debian's libgs-common";
  ASSERT_TRUE(is_rgb_profile(read_file(printer)));
  const Image image = row_of(color_cube(6));
  std::vector<std::vector<double>> rows;
  for (int x = 0; x < image.width_px; ++x) {
    const std::uint8_t* p = image.pixel(x, 0);
    rows.push_back({double(p[0]), double(p[1]), double(p[2])});
  }
  const auto expected = transicc("-i*sRGB -o" + printer + " -t1 -b", rows);
  ASSERT_EQ(expected.size(), rows.size());
  const Image found =
      in_printer_rgb(image, read_file(printer), printer, RenderingIntent::kRelative);
  int changed = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::uint8_t* p = found.pixel(int(i), 0);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(p[k], expected[i][k], 1.5) << i;
    EXPECT_EQ(p[3], image.pixel(int(i), 0)[3]);
    changed += std::abs(p[0] - rows[i][0]) > 2;
  }
  EXPECT_GT(changed, 50);  // it is another space
}

TEST_F(Profiles, AnSrgbPrinterGetsTheImageAsItIs) {
  const Image image = row_of(color_cube(6));
  const Image found = in_printer_rgb(image, srgb_profile(), "sRGB", RenderingIntent::kRelative);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) EXPECT_NEAR(found.rgba[i], image.rgba[i], 1);
}

TEST_F(Profiles, OnlyRgbProfilesAreRgb) {
  EXPECT_TRUE(is_rgb_profile(srgb_profile()));
  EXPECT_FALSE(is_rgb_profile(make_device_model()->profile()));
  EXPECT_FALSE(is_rgb_profile(std::vector<std::uint8_t>(500, 7)));
  EXPECT_FALSE(is_rgb_profile({}));
}

// Each with its own table, and black point compensation where transicc's users switch it on.
TEST_F(Profiles, TransiccGivesTheSameInksByEveryIntent) {
  if (!has_tool("transicc")) GTEST_SKIP() << "needs transicc";
  const std::filesystem::path installed = installed_cmyk_profile();
  if (installed.empty()) GTEST_SKIP() << "no CMYK profile is installed";
  const std::vector<SrgbColor> colors = color_cube(3);
  std::vector<std::vector<double>> rows;
  for (const SrgbColor& c : colors)
    rows.push_back({255.0 * double(c.r), 255.0 * double(c.g), 255.0 * double(c.b)});
  const std::pair<RenderingIntent, const char*> intents[] = {
      {RenderingIntent::kPerceptual, " -t0"},
      {RenderingIntent::kRelative, " -t1 -b"},
      {RenderingIntent::kSaturation, " -t2"},
      {RenderingIntent::kAbsolute, " -t3"}};
  for (const auto& [intent, option] : intents) {
    const auto theirs = transicc("-i*sRGB -o" + installed.string() + option, rows);
    ASSERT_EQ(theirs.size(), colors.size());
    std::vector<Inks> ours(colors.size());
    make_profile_model(read_file(installed), "installed", intent)
        ->separate(colors.data(), ours.data(), colors.size());
    for (std::size_t i = 0; i < colors.size(); ++i) {
      const double inks[] = {ours[i].c, ours[i].m, ours[i].y, ours[i].k};
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_NEAR(100 * inks[k], theirs[i][k], 0.5) << option << " " << i;
    }
  }
}

// The same bytes whenever they are made.
TEST_F(Profiles, OwnProfilesHaveNoTime) {
  for (const auto& bytes : {make_device_profile(), srgb_profile()}) {
    ASSERT_GT(bytes.size(), 128U);
    const std::vector<std::uint8_t> date(bytes.begin() + 24, bytes.begin() + 36);
    EXPECT_EQ(date, (std::vector<std::uint8_t>{0x07, 0xE8, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0}));
  }
}

// A named profile wins over the formula, and which inks an RGB printer takes nobody knows.
TEST_F(Profiles, APrinterIsWhatItsProfileSays) {
  const TemporaryFolder folder;
  const auto written = [&](const char* name, const std::vector<std::uint8_t>& bytes) {
    write_file(folder / name, bytes.data(), bytes.size());
    return folder / name;
  };
  PrinterOptions options;
  EXPECT_EQ(make_printer(options).model->name(), "device formula");
  options.profile = written("cmyk.icc", make_device_profile());
  EXPECT_EQ(make_printer(options).model->name(), "hydrodip device formula");  // its description
  options.profile = written("rgb.icc", srgb_profile());
  EXPECT_TRUE(make_printer(options).is_rgb);
  EXPECT_EQ(make_printer(options).model->name(), "device formula");
  options.color = PrintColor::kCmyk;
  EXPECT_THROW(make_printer(options), InputError);
}

TEST_F(Profiles, WhatIsNoCmykProfileIsRefused) {
  const std::vector<std::uint8_t> rubbish(500, 7);
  for (const auto& bytes : {rubbish, std::vector<std::uint8_t>{}, srgb_profile()})
    EXPECT_THROW(make_profile_model(bytes, "some.icc", RenderingIntent::kRelative), InputError);
  try {
    make_profile_model(srgb_profile(), "some.icc", RenderingIntent::kRelative);
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).find("neither CMYK inks nor RGB") != std::string::npos);
  }
  auto cut = make_device_model()->profile();
  cut.resize(cut.size() / 2);
  EXPECT_THROW(make_profile_model(cut, "some.icc", RenderingIntent::kRelative), InputError);
}

}  // namespace
}  // namespace hydrodip
