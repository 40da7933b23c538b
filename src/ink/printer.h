// The printer as colours see it: which inks it makes of a colour, and the profile that says so.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "ink/color_model.h"

namespace hydrodip {

enum class InkModel { kDevice, kProfile };
enum class PrintColor { kRgb, kCmyk };

struct PrinterOptions {
  InkModel model = InkModel::kDevice;
  std::filesystem::path profile;  // the printer's; not empty: kProfile. Empty with kProfile: the
                                  // installed one
  RenderingIntent intent = RenderingIntent::kRelative;
  PrintColor color = PrintColor::kRgb;  // what it is sent: of print.pdf
};

// Immutable. Its profile was read once.
struct Printer {
  PrinterOptions options;
  std::shared_ptr<const ColorModel> model;
  std::filesystem::path profile_file;       // empty: by formula
  std::vector<std::uint8_t> profile_bytes;  // that file's
  bool is_rgb = false;                      // the profile is an RGB printer's
};

// By the printer's profile, or by the device formula; that too if the profile is an RGB printer's.
// Throws InputError if the profile is unusable or none is installed.
Printer make_printer(const PrinterOptions& options);

}  // namespace hydrodip
