// A thousand dips with faults drawn at random, on both machines: nothing may move after a stop was
// due, and what is said about the stage must be true. Prints what went wrong and how it all ended.
#include <fmt/format.h>

#include <cstdlib>
#include <map>

#include "rig/session.h"

int main(int argc, char** argv) {
  using namespace hydrodip;
  const unsigned count = argc > 1 ? unsigned(std::atoi(argv[1])) : 1000;
  int broken = 0;
  std::map<std::string, int> endings;
  for (unsigned i = 0; i < count; ++i) {
    const bool zaber = i % 2 == 0;
    std::string story;
    const std::string complaint =
        random_faults(zaber ? Machine::kZaber : Machine::kMarlin, 1000 + i, story);
    ++endings[story.ends_with("finished")                              ? "finished"
              : story.find("stands still") != std::string::npos        ? "stopped, confirmed"
              : story.find("could not be asked") != std::string::npos  ? "stopped by the leash"
              : story.find("may still be homing") != std::string::npos ? "link lost while homing"
                                                                       : "never began"];
    if (complaint.empty()) continue;
    ++broken;
    fmt::print("{} {}: {}\n", zaber ? "zaber" : "marlin", complaint, story);
  }
  for (const auto& [ending, times] : endings) fmt::print("{:6} {}\n", times, ending);
  fmt::print("{} of {} fault sequences broke a promise\n", broken, count);
  return broken == 0 ? 0 : 1;
}
