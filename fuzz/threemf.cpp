#include "model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return hydrodip::fuzz::read(hydrodip::read_3mf, "a.3mf", data, size);
}
