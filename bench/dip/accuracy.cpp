// Errors against exact solutions on ways straight down and on others, what a rolled dip costs
// against a straight one, and how exactly trapped air is found. Prints the tables of
// docs/accuracy.md.
//
//   bench_accuracy [LARGEST_MESH]

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "air/air.h"
#include "air/cups.h"
#include "exact/paths.h"

namespace hydrodip {
namespace {

using namespace exact;

struct Case {
  std::string name;
  std::function<PathError(int elements, double step_mm)> error;
};

std::vector<Case> cases() {
  const RolledCylinder straight{.shift = 0, .turn = 0}, rolled, shifted{.turn = 0},
      turned{.shift = 0};
  const auto cylinder = [](const RolledCylinder& c) {
    return
        [c](int elements, double step_mm) { return rolled_cylinder_error(c, elements, step_mm); };
  };
  const auto sphere = [](double turn_deg) {
    return [turn_deg](int elements, double step_mm) {
      return twisted_sphere_error(turn_deg, elements, step_mm);
    };
  };
  return {{"cylinder straight down", cylinder(straight)},
          {"cylinder shifted by 6 mm", cylinder(shifted)},
          {"cylinder rolled by 10 degrees", cylinder(turned)},
          {"cylinder rolled and shifted", cylinder(rolled)},
          {"sphere straight down", sphere(0)},
          {"sphere twisted by 2 degrees", sphere(2)}};
}

void print_errors(int largest_mesh) {
  fmt::print(
      "| path | triangles | step (mm) | steps | iterations a step | largest (mm) | root mean "
      "square "
      "(mm) |\n|---|---|---|---|---|---|---|\n");
  const auto row = [](const Case& c, int elements, double step_mm) {
    const PathError e = c.error(elements, step_mm);
    fmt::print("| {} | {} | {:g} | {} | {:.1f} | {:.4f} | {:.4f} |\n", c.name, elements, step_mm,
               e.statistics.steps, double(e.statistics.iterations) / e.statistics.steps,
               e.largest_mm, e.root_mean_square_mm);
    std::fflush(stdout);
  };
  for (const Case& c : cases()) {
    for (const int elements : {10000, 40000, 160000})
      if (elements <= largest_mesh) row(c, elements, 0.1);
    row(c, 40000, 0.05);
  }
}

// Interleaved, because machines have moods; the fastest of some.
void print_costs() {
  constexpr int kTurns = 5, kElements = 40000;
  const RolledCylinder straight{.shift = 0, .turn = 0}, rolled;
  const auto ms_a_step = [](const RolledCylinder& c) {
    const auto start = std::chrono::steady_clock::now();
    const int steps = dip_cylinder(c, strip(c.L, kElements), 0.1).statistics.steps;
    return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() /
           steps;
  };
  double down = 1e300, roll = 1e300;
  for (int turn = 0; turn < kTurns; ++turn) {
    down = std::min(down, ms_a_step(straight));
    roll = std::min(roll, ms_a_step(rolled));
  }
  fmt::print("\nA step of {} triangles: {:.2f} ms straight down, {:.2f} ms rolled, {:.2f} times\n",
             kElements, down, roll, roll / down);
}

// A cup, mouth down, at several tilts and numbers of cells.
void print_air() {
  fmt::print(
      "\n| cup, tilted by | cells | closes (mm) | error (mm) | area (mm2) | error | volume (mm3) | "
      "error | ms |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const double tilt : {0.0, 5.0, 20.0, 35.0}) {
    const Mat3 lean = Eigen::AngleAxisd(tilt * cups::kRad, Vec3::UnitY()).toRotationMatrix();
    const TriangleMesh cup = cups::moved(cups::mesh_of(cups::turned(cups::kCup)), lean);
    const Surface surface(cup.positions, cup.triangles);
    const cups::Kept kept = cups::kept_by_leaning_cup(tilt);
    for (const int cells : {40000, 600000, 4000000}) {
      const auto start = std::chrono::steady_clock::now();
      const TrappedAir air =
          find_air(cup, surface, Trajectory::straight_down(cup.bounds().max.z()), {cells}, {});
      const double ms =
          1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (air.pockets.size() != 1) {
        fmt::print("| {:g} degrees | {} | {} pockets |\n", tilt, cells, air.pockets.size());
        continue;
      }
      const AirPocket& pocket = air.pockets[0];
      fmt::print(
          "| {:g} degrees | {} | {:.4f} | {:.4f} | {:.2f} | {:.3f} | {:.1f} | {:.2f} | {:.0f} |\n",
          tilt, cells, kept.closed_at_mm, pocket.closed_at_mm - kept.closed_at_mm, kept.area_mm2,
          pocket.area_mm2 - kept.area_mm2, kept.volume_mm3, pocket.volume_mm3 - kept.volume_mm3,
          ms);
    }
  }
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  hydrodip::print_errors(argc > 1 ? std::atoi(argv[1]) : 160000);
  hydrodip::print_costs();
  hydrodip::print_air();
}
