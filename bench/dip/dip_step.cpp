// What a dip step costs: against Newton with supernodal CHOLMOD, as the mesh grows, on hard ink,
// and how near the inner loops come to what this machine can do. Lengths of runs are chosen so that
// all of it takes a few minutes; judge the ratios, which come from one run.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "dip/dip.h"
#include "elastic/cholmod_solver.h"
#include "elastic/kernel_variants.h"
#include "elastic/multigrid.h"
#include "exact/shapes.h"

namespace hydrodip {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Run {
  std::size_t triangles = 0;
  double ms_per_step = 0;  // median, without the first steps, which set everything up
  double iterations = 0;   // per step
};

constexpr int kSkippedSteps = 3;

Run dip_sphere(int elements, int steps, DipOptions options, double checker_mm = 0) {
  const shapes::Shape sphere = shapes::sphere_bowl(30, 28.6);
  const FilmMesh film =
      make_film_mesh({.width_mm = 215.9, .height_mm = 279.4, .elements = elements});
  const Surface surface(sphere.positions, sphere.triangles);
  options.step_mm = 0.1;
  options.depth_mm = options.step_mm * steps;
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
  const DipResult result = dip(film, sphere.positions, sphere.triangles, surface, options, context);

  std::vector<double> ms;
  for (std::size_t n = 1; n < times.size(); ++n)
    ms.push_back(std::chrono::duration<double, std::milli>(times[n] - times[n - 1]).count());
  if (ms.size() > kSkippedSteps) ms.erase(ms.begin(), ms.begin() + kSkippedSteps);
  std::nth_element(ms.begin(), ms.begin() + std::ptrdiff_t(ms.size() / 2), ms.end());
  const DipStatistics& s = result.statistics;
  return {film.triangles.size(), ms[ms.size() / 2], double(s.iterations) / s.steps};
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

void hard_ink() {
  const Run uniform = dip_sphere(40000, 40, {});
  fmt::print("\nhard ink, 600:1 checkerboard, 40k triangles (uniform film: {:.2f} ms/step)\n",
             uniform.ms_per_step);
  for (const double square_mm : {3.0, 6.0, 12.0}) {
    const Run hard = dip_sphere(40000, 40, {}, square_mm);
    fmt::print("  squares of {:>4.1f} mm: {:.2f} ms/step, {:.1f} iterations, ratio {:.2f}\n",
               square_mm, hard.ms_per_step, hard.iterations,
               hard.ms_per_step / uniform.ms_per_step);
  }
}

// ---- inner loops against the machine ----

double fastest_seconds(const std::function<void()>& body) {
  double best = 1e300;
  for (int n = 0; n < 20; ++n) {
    const auto start = Clock::now();
    for (int repeat = 0; repeat < 10; ++repeat) body();
    best = std::min(best, seconds_since(start) / 10);
  }
  return best;
}

// A stencil with something in it everywhere.
GridOperator some_operator(int nx, int ny) {
  GridOperator A(nx, ny);
  GridOperator::Row row{};
  for (std::size_t k = 0; k < 9; ++k) row[k] = {-0.1F, 0.01F, 0.01F, -0.1F};
  row[4] = {1, 0, 0, 1};
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) A.set_row(i, j, row);
  return A;
}

void kernels_on(int nx, int ny, double bandwidth) {
  const GridOperator A = some_operator(nx, ny);
  GridVector b = A.vector(), x = A.vector(), out = A.vector();
  const auto line = [&](const char* name, double bytes, double flops, double seconds) {
    const double nodes = double(A.nodes());
    fmt::print(
        "  {:>9} {:>9} nodes: {:>6.1f} GB/s, {:>5.1f} Gflop/s  ({:.0f} bytes and {:.0f} flops "
        "a node; at memory speed {:.3f} ms, took {:.3f} ms)\n",
        name, A.nodes(), bytes * nodes / seconds * 1e-9, flops * nodes / seconds * 1e-9, bytes,
        flops, bytes * nodes / bandwidth * 1e3, seconds * 1e3);
  };
  // Floats read and written a node: 3 own, 16 forward blocks, mask, vectors (and 3 of D^-1).
  line("multiply", 4 * 24, 74, fastest_seconds([&] { A.multiply(x, out); }));
  line("smooth", 4 * 29, 86, fastest_seconds([&] {
         A.for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
           kernels::best().smooth(A.stencil(), A.rows(begin, end), b, x, 0.5F, out);
         });
       }));
}

void inner_loops() {
  std::vector<double> from(1 << 24, 1.0), to(from.size());
  const double bandwidth = 2 * 8 * double(from.size()) / fastest_seconds([&] {
                             std::copy(from.begin(), from.end(), to.begin());
                           });
  fmt::print("\ninner loops ({}); copying 128 MiB: {:.1f} GB/s\n", kernels::variants().back().name,
             1e-9 * bandwidth);
  kernels_on(60, 10, bandwidth);  // in the innermost cache: what computing alone allows
  kernels_on(125, 161, bandwidth);
  kernels_on(497, 643, bandwidth);
}

}  // namespace
}  // namespace hydrodip

int main() {
  hydrodip::against_cholmod();
  hydrodip::growth();
  hydrodip::hard_ink();
  hydrodip::inner_loops();
}
