#include "model_io/mtl.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hydrodip::RunContext context;
  hydrodip::read_mtl("a.mtl", {data, data + size}, context);
  return 0;
}
