#include <algorithm>

#include "image/to_byte.h"
#include "ink/color_model.h"
#include "ink/profiles.h"

namespace hydrodip {

namespace {

class DeviceModel : public ColorModel {
 public:
  void separate(const SrgbColor* colors, Inks* inks, std::size_t count) const override {
    for (std::size_t i = 0; i < count; ++i) inks[i] = device_inks(colors[i]);
  }
  void look(const Inks* inks, SrgbColor* colors, std::size_t count) const override {
    for (std::size_t i = 0; i < count; ++i) colors[i] = device_look(inks[i]);
  }
  std::string name() const override { return "device formula"; }
  const std::vector<std::uint8_t>& profile() const override {
    static const std::vector<std::uint8_t> bytes = make_device_profile();
    return bytes;
  }
};

}  // namespace

std::array<std::uint8_t, 4> to_bytes(const Inks& inks) {
  return {to_byte(inks.c), to_byte(inks.m), to_byte(inks.y), to_byte(inks.k)};
}

Inks from_bytes(const std::uint8_t* cmyk) {
  const auto amount = [](std::uint8_t byte) { return static_cast<float>(byte) / 255.0f; };
  return {amount(cmyk[0]), amount(cmyk[1]), amount(cmyk[2]), amount(cmyk[3])};
}

Inks device_inks(const SrgbColor& color) {
  const float c = 1 - color.r, m = 1 - color.g, y = 1 - color.b;
  const float k = std::min({c, m, y});
  return {c - k, m - k, y - k, k};
}

SrgbColor device_look(const Inks& inks) {
  const auto left = [&](float amount) { return std::max(0.0f, 1 - amount - inks.k); };
  return {left(inks.c), left(inks.m), left(inks.y)};
}

std::unique_ptr<ColorModel> make_device_model() { return std::make_unique<DeviceModel>(); }

}  // namespace hydrodip
