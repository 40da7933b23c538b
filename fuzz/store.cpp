#include "calibrate/store.h"
#include "base/error.h"
#include "through_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const hydrodip::SimulationStore store(hydrodip::fuzz::file_with("a.jsonl", data, size), {});
    store.oddities({"a"});
  } catch (const hydrodip::InputError&) {
  }
  return 0;
}
