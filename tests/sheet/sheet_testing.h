// What the tests of this folder share: a scratch folder, outside readers, sheets and pictures.
#pragma once

#include <gtest/gtest.h>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "image/files.h"
#include "ink/color_model.h"
#include "sheet/sheet.h"
#include "temporary_folder.h"

namespace hydrodip::fixtures {

class InFolder : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
};

inline bool has_tool(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null 2>&1").c_str()) == 0;
}

// Exit status and everything the command said.
inline std::pair<int, std::string> run_tool(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string output;
  char chunk[4096];
  while (const std::size_t count = std::fread(chunk, 1, sizeof chunk, pipe)) {
    output.append(chunk, count);
  }
  return {pclose(pipe), output};
}

// The part of a page from (x, y), in pixels from the upper left, as pdftoppm sees it.
inline Image rasterised(const std::filesystem::path& pdf, int dpi, int x, int y, int width,
                        int height) {
  const std::filesystem::path picture = pdf.parent_path() / "page.png";
  const std::string command = "pdftoppm -singlefile -png -r " + std::to_string(dpi) + " -x " +
                              std::to_string(x) + " -y " + std::to_string(y) + " -W " +
                              std::to_string(width) + " -H " + std::to_string(height) + " " +
                              pdf.string() + " " + (pdf.parent_path() / "page").string();
  const auto [status, said] = run_tool(command);
  EXPECT_EQ(status, 0) << said;
  EXPECT_EQ(said, "");
  return load_image(picture);
}

inline SheetOptions sheet(double width_mm, double height_mm, double margin_mm, double dpi) {
  SheetOptions options;
  options.width_mm = width_mm;
  options.height_mm = height_mm;
  options.margin_mm = margin_mm;
  options.dpi = dpi;
  options.job_name = "a job";
  return options;
}

inline Image blank_image(const SheetOptions& options) {
  return Image(static_cast<int>(std::lround(options.width_mm * options.dpi / 25.4)),
               static_cast<int>(std::lround(options.height_mm * options.dpi / 25.4)));
}

// Every row and column different, alpha included, so that no exchange goes unnoticed.
inline Image patterned_image(const SheetOptions& options) {
  Image image = blank_image(options);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      std::uint8_t* pixel = image.pixel(x, y);
      pixel[0] = static_cast<std::uint8_t>(x);
      pixel[1] = static_cast<std::uint8_t>(y);
      pixel[2] = static_cast<std::uint8_t>(7 * x + 3 * y);
      pixel[3] = static_cast<std::uint8_t>(x + y < 100 ? 0 : 5 * x + y);
    }
  }
  return image;
}

// The same for inks; blank where the picture is transparent.
inline InkImage patterned_inks(const SheetOptions& options) {
  const Image image = patterned_image(options);
  InkImage inks(image.width_px, image.height_px);
  for (std::size_t i = 0; i < inks.cmyk.size(); i += 4) {
    if (image.rgba[i + 3] == 0) continue;
    for (std::size_t k = 0; k < 4; ++k) inks.cmyk[i + k] = image.rgba[i + k];
  }
  return inks;
}

// The profile that an ICC reader finds in an sRGB picture or in inks.
inline std::vector<std::uint8_t> device_profile() { return make_device_model()->profile(); }

}  // namespace hydrodip::fixtures
