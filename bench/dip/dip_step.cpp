// What a dip step costs: against Newton with supernodal CHOLMOD, as the mesh grows, on hard ink,
// and how near the inner loops come to what this machine can do. Lengths of runs are chosen so that
// all of it takes a few minutes; judge the ratios, which come from one run.
// `bench_dip_step growth`: as the mesh grows only, for machines that are busy otherwise.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dip/dip.h"
#include "elastic/cholmod_solver.h"
#include "elastic/inner_loops.h"
#include "exact/shapes.h"

namespace hydrodip {
namespace {

using Clock = std::chrono::steady_clock;

struct Run {
  std::size_t triangles = 0;
  double ms_per_step = 0;  // median, without the first steps, which set everything up
  double iterations = 0;   // per step
  DippedFilm film;
};

constexpr int kSkippedSteps = 3;

Run dip_sphere(int elements, int steps, DipOptions options, double checker_mm = 0) {
  const shapes::Shape sphere = shapes::sphere_bowl(30, 28.6);
  const FilmMesh film =
      make_film_mesh({.width_mm = 215.9, .height_mm = 279.4, .elements = elements});
  const Surface surface(sphere.positions, sphere.triangles);
  options.step_mm = 0.1;
  options.even_steps = true;
  options.material.tear_stretch = 0;
  if (checker_mm > 0)
    for (const Triangle& t : film.triangles) {
      const Vec2 centre =
          (film.u[std::size_t(t[0])] + film.u[std::size_t(t[1])] + film.u[std::size_t(t[2])]) / 3;
      const Vec2 square = (centre / checker_mm).array().floor();
      options.modulus.push_back(std::fmod(std::abs(square.sum()), 2) == 0 ? 1 : 600);
    }
  std::vector<Clock::time_point> times;
  RunContext context;
  context.on_progress([&](const std::string&, double) { times.push_back(Clock::now()); });
  DipResult result = dip(film, sphere.positions, sphere.triangles, surface,
                         Trajectory::straight_down(options.step_mm * steps), options, context);

  std::vector<double> ms;
  for (std::size_t n = 1; n < times.size(); ++n)
    ms.push_back(std::chrono::duration<double, std::milli>(times[n] - times[n - 1]).count());
  if (ms.size() > kSkippedSteps) ms.erase(ms.begin(), ms.begin() + kSkippedSteps);
  std::nth_element(ms.begin(), ms.begin() + std::ptrdiff_t(ms.size() / 2), ms.end());
  const DipStatistics& s = result.statistics;
  return {film.triangles.size(), ms[ms.size() / 2], double(s.iterations) / s.steps,
          std::move(result.film)};
}

double largest_distance_mm(const DippedFilm& a, const DippedFilm& b) {
  double largest = 0;
  for (std::size_t v = 0; v < a.position.size(); ++v)
    largest = std::max(largest, (a.position[v] - b.position[v]).norm());
  return largest;
}

void against_cholmod() {
  constexpr int kSteps = 40;
  DipOptions direct;
  direct.make_solver = [](const FilmMesh&) { return make_cholmod_solver(); };
  // Ours on both sides of the slow one: the machine may change its speed in between.
  const Run before = dip_sphere(40000, kSteps, {});
  const Run slow = dip_sphere(40000, kSteps, direct);
  const Run after = dip_sphere(40000, kSteps, {});
  const double ours = 0.5 * (before.ms_per_step + after.ms_per_step);
  fmt::print("dip_step_40k: ours {:.2f} ms, direct {:.1f} ms, ratio {:.0f}\n", ours,
             slow.ms_per_step, slow.ms_per_step / ours);
  fmt::print("the two films differ by at most {:.1e} mm after {} steps\n",
             largest_distance_mm(after.film, slow.film), kSteps);
}

void growth() {
  fmt::print("\n{:>10} {:>10} {:>16}\n", "triangles", "ms/step", "iterations/step");
  std::vector<Vec2> points;
  for (const int elements : {10000, 40000, 160000, 640000, 1000000}) {
    const Run run = dip_sphere(elements, 20, {});
    fmt::print("{:>10} {:>10.2f} {:>16.2f}\n", run.triangles, run.ms_per_step, run.iterations);
    points.emplace_back(std::log(double(run.triangles)), std::log(run.ms_per_step));
  }
  Vec2 mean = Vec2::Zero();
  for (const Vec2& p : points) mean += p / double(points.size());
  double xy = 0, xx = 0;
  for (const Vec2& p : points) {
    xy += (p - mean).x() * (p - mean).y();
    xx += (p - mean).x() * (p - mean).x();
  }
  fmt::print("growth: time per step ~ triangles^{:.2f}\n", xy / xx);
}

// The machine may change its speed between two runs: each is made three times, taking turns, and
// the fastest counts.
void hard_ink() {
  fmt::print("\nhard ink, 600:1 checkerboard, 40k triangles, against uniform film\n");
  for (const double square_mm : {3.0, 6.0, 12.0}) {
    double uniform_ms = 1e300, hard_ms = 1e300, iterations = 0;
    for (int n = 0; n < 3; ++n) {
      uniform_ms = std::min(uniform_ms, dip_sphere(40000, 40, {}).ms_per_step);
      const Run hard = dip_sphere(40000, 40, {}, square_mm);
      hard_ms = std::min(hard_ms, hard.ms_per_step);
      iterations = hard.iterations;
    }
    fmt::print(
        "  squares of {:>4.1f} mm: {:.2f} against {:.2f} ms/step, {:.1f} iterations, ratio "
        "{:.2f}\n",
        square_mm, hard_ms, uniform_ms, iterations, hard_ms / uniform_ms);
  }
}

}  // namespace
}  // namespace hydrodip

int main(int argc, char** argv) {
  if (argc > 1 && argv[1] == std::string("growth")) {
    hydrodip::growth();
    return 0;
  }
  hydrodip::against_cholmod();
  hydrodip::growth();
  hydrodip::hard_ink();
  hydrodip::measure_inner_loops();
}
