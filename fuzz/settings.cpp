#include "settings/settings.h"
#include "base/error.h"
#include "through_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    hydrodip::read_settings(hydrodip::fuzz::file_with("a.toml", data, size));
  } catch (const hydrodip::InputError&) {
  }
  return 0;
}
