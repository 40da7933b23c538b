#include "base/error.h"
#include "scan/read_scan.h"
#include "through_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  // The first byte says which kind.
  const char* name = data[0] % 3 == 0 ? "a.csv" : data[0] % 3 == 1 ? "a.obj" : "a.ply";
  try {
    hydrodip::read_corner_scan(hydrodip::fuzz::file_with(name, data + 1, size - 1),
                               {"mm", 10, false}, hydrodip::RunContext());
  } catch (const hydrodip::InputError&) {
  }
  return 0;
}
