// stage_emulator zaber|marlin [MM]: a stage to try hydrodip on, with no hardware at all; MM is how
// far from its home it stands when it is switched on.
#include <poll.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "emulator.h"

int main(int argc, char** argv) {
  using namespace hydrodip;
  const bool marlin = argc > 1 && std::strcmp(argv[1], "marlin") == 0;
  if (argc < 2 || (!marlin && std::strcmp(argv[1], "zaber") != 0)) {
    std::fputs("usage: stage_emulator zaber|marlin [MM]\n", stderr);
    return 2;
  }
  const auto emulator = marlin ? marlin_emulator() : zaber_emulator();
  if (argc > 2) emulator->stand_at(std::atof(argv[2]));
  std::printf("%s\n", emulator->port().c_str());
  std::fflush(stdout);
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    pollfd wire = {emulator->descriptor(), POLLIN, 0};
    ::poll(&wire, 1, 1);
    const std::chrono::duration<double> past = std::chrono::steady_clock::now() - start;
    emulator->advance(past.count());
  }
}
