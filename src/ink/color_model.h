// Between colours and inks on white film: by a formula, or by the printer's ICC profile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ink/inks.h"

namespace hydrodip {

// sRGB values (encoded, as in files) in [0, 1].
struct SrgbColor {
  float r = 0, g = 0, b = 0;
};

// Immutable; safe to use from many threads.
class ColorModel {
 public:
  virtual ~ColorModel() = default;

  // The inks that give colours on white film. `count` of each.
  virtual void separate(const SrgbColor* colors, Inks* inks, std::size_t count) const = 0;
  // The colours that inks give on white film.
  virtual void look(const Inks* inks, SrgbColor* colors, std::size_t count) const = 0;

  // For people: "device formula" or the profile's description.
  virtual std::string name() const = 0;
  // An ICC profile that says the same; embedded in the files to print.
  virtual const std::vector<std::uint8_t>& profile() const = 0;
};

// Without a profile, the paper's case: c = 1 - r, m = 1 - g, y = 1 - b in sRGB values, and what the
// three have in common is printed in black: k = min(c, m, y), taken off each. Backwards
// r = 1 - c - k, and 0 where that is negative: more pigment than black needs is still black.
std::unique_ptr<ColorModel> make_device_model();

enum class RenderingIntent { kRelative, kPerceptual, kSaturation, kAbsolute };

// By an ICC profile of a CMYK printer. Relative: with black point compensation. Throws InputError
// naming `name` if the bytes are no such profile, or it lacks a direction.
std::unique_ptr<ColorModel> make_profile_model(std::vector<std::uint8_t> profile,
                                               const std::string& name, RenderingIntent intent);

// A CMYK profile that Debian has installed on this machine; empty if there is none.
std::filesystem::path installed_cmyk_profile();

// The profile of the sRGB images. Its bytes are always the same.
const std::vector<std::uint8_t>& srgb_profile();

}  // namespace hydrodip
