// Thousands of dips with faults drawn at random, on both machines, alone and led by the guide:
// nothing may move after a stop was due, and what is said about the stage must be true. Prints what
// went wrong and how it all ended. Usage: bench_fault_storm [SEQUENCES [FIRST_SEED]]
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "rig/guided.h"
#include "rig/session.h"

namespace {

std::string ending_of(const std::string& story) {
  const auto says = [&](const char* part) { return story.find(part) != std::string::npos; };
  if (story.ends_with("finished")) return "finished";
  if (says("no longer knows where")) return "stopped, confirmed, place lost";
  if (says("stands still at")) return "stopped, confirmed";
  if (says("could not be asked")) return "stopped by the leash";
  if (says("may still be homing")) return "link lost while homing";
  return "not moving when it struck";
}

}  // namespace

int main(int argc, char** argv) {
  using namespace hydrodip;
  const unsigned count = argc > 1 ? unsigned(std::atoi(argv[1])) : 5000;
  const unsigned first = argc > 2 ? unsigned(std::atoi(argv[2])) : 1000;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("hydrodip-storm-{}", ::getpid());
  int broken = 0;
  std::map<std::string, int> endings;
  for (unsigned i = 0; i < count; ++i) {
    const Machine machine = i % 2 == 0 ? Machine::kZaber : Machine::kMarlin;
    const bool guided = i / 2 % 2 == 1;
    std::string story;
    const std::string complaint = guided ? random_guided_faults(machine, first + i, folder, story)
                                         : random_faults(machine, first + i, story);
    const std::string kind = fmt::format("{}, {}", machine == Machine::kZaber ? "zaber" : "marlin",
                                         guided ? "guided" : "alone");
    ++endings[kind + ": " + ending_of(story)];
    if (complaint.empty()) continue;
    ++broken;
    fmt::print("{} {}: {}\n", kind, complaint, story);
    std::fflush(stdout);
  }
  std::filesystem::remove_all(folder);
  for (const auto& [ending, times] : endings) fmt::print("{:6} {}\n", times, ending);
  fmt::print("{} of {} fault sequences broke a promise\n", broken, count);
  return broken == 0 ? 0 : 1;
}
