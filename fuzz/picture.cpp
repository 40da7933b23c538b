#include <cstdlib>

#include "base/error.h"
#include "image/files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<std::uint8_t> bytes(data, data + size);
  try {
    const hydrodip::Image image = hydrodip::decode_image(bytes, "a picture");
    if (image.rgba.size() != 4 * std::size_t(image.width_px) * std::size_t(image.height_px))
      std::abort();
  } catch (const hydrodip::InputError&) {
  }
  static_cast<void>(hydrodip::recorded_dpi(bytes));
  return 0;
}
