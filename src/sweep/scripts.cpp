#include "sweep/scripts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/file.h"
#include "base/shell_word.h"

namespace hydrodip {
namespace {

constexpr double kWanted_s = 120;   // of a task
constexpr double kShortest_s = 10;  // worth a task of its own
constexpr int kFew = 8;             // tasks to share at least, if they are worth it
constexpr int kMost = 1000;         // Slurm's MaxArraySize is 1001 unless it is configured

// Its last line tells whether the lines before it are still as they were written.
constexpr const char* kSeal = "# as it was made: ";

std::string sealed(const std::string& script) { return script + kSeal + sha256_hex(script) + "\n"; }

}  // namespace

bool is_as_made(const std::string& script) {
  const std::size_t seal = script.rfind(kSeal);
  return seal != std::string::npos && script == sealed(script.substr(0, seal));
}

int tasks_for(std::size_t runs, double seconds) {
  const double whole_s = double(runs) * (seconds > 0 ? seconds : 1);
  const double few = std::min(double(kFew), whole_s / kShortest_s);
  const double most = std::min(double(kMost), double(runs));
  return int(std::clamp(std::ceil(std::max(whole_s / kWanted_s, few)), 1.0, std::max(most, 1.0)));
}

std::string parallel_script(int tasks) {
  return sealed(fmt::format(
      R"sh(#!/bin/sh
# Made by hydrodip sweep plan. Does the sweep's runs with GNU parallel: as many at once as there are
# cores here. On other machines, which have to see this folder under the same name:
#   PARALLEL='--sshlogin 8/big,4/small' ./parallel.sh
# Stopped and started again, it goes on where it was.
set -eu
cd "$(dirname -- "$0")"
seq {0} | parallel -q --workdir "$PWD" \
  "${{HYDRODIP:-hydrodip}}" sweep run . --shard {{}}/{0} --threads 1 --quiet
)sh",
      tasks));
}

std::string slurm_script(int tasks, const std::filesystem::path& folder) {
  return sealed(fmt::format(
      R"sh(#!/bin/sh
# Made by hydrodip sweep plan. Does the sweep's runs as an array of jobs: sbatch slurm.sh
# Submitted again, it goes on where it was.
#SBATCH --job-name=hydrodip-sweep
#SBATCH --array=1-{0}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --output=/dev/null
set -eu
cd {1}
exec "${{HYDRODIP:-hydrodip}}" sweep run . --threads "${{SLURM_CPUS_PER_TASK:-1}}" --quiet
)sh",
      tasks, shell_word(folder.string())));
}

}  // namespace hydrodip
