#include "elastic/inner_loops.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "base/awake_threads.h"
#include "base/parallel.h"
#include "elastic/film_energy.h"
#include "elastic/grid_operator.h"
#include "elastic/kernel_variants.h"
#include "elastic/machine.h"

namespace hydrodip {
namespace {

// What a loop needs for a node: bytes that it cannot help reading and writing, operations.
struct Need {
  double bytes, flops, roots;  // roots: 1 / sqrt(x)
};

// Floats: own 3, forward blocks 16, mask, x and A x; and for smoothing D^-1 and b.
constexpr Need kMultiply = {4 * 24, 74, 0};
constexpr Need kSmooth = {4 * 29, 86, 0};
// Doubles: of two triangles gradients 8, area 2, mu 2; of the node u, mask, force. Operations: 63 a
// triangle (strain 29, forces 34), 12 to add up a cell, 8 to gather a node.
constexpr Need kGradient = {8 * 17, 2 * 63 + 12 + 8, 2};

// What the machine can do of it in a second, all threads together.
struct Best {
  double bandwidth, flops, roots;
};

void print_line(const char* name, std::size_t nodes, const Need& need, const Best& best,
                double seconds) {
  const double count = double(nodes);
  const double reading = count * need.bytes / best.bandwidth,
               computing = count * std::max(need.flops / best.flops, need.roots / best.roots);
  const double limit = std::max(reading, computing);
  fmt::print("{:>9} {:>8} nodes, {:>3.0f} bytes and {:>3.0f} operations each: {:.4f} ms; ", name,
             nodes, need.bytes, need.flops, 1e3 * seconds);
  fmt::print("{:>5.1f} of {:>5.1f} GB/s, {:>5.1f} of {:>5.1f} Gflop/s: ",
             1e-9 * count * need.bytes / seconds, 1e-9 * best.bandwidth,
             1e-9 * count * need.flops / seconds, 1e-9 * best.flops);
  fmt::print("{:.0f} % of the limit ({}, {:.4f} ms)\n", 100 * limit / seconds,
             reading > computing ? "memory" : "arithmetic", 1e3 * limit);
}

std::string_view instruction_set() {
  const auto& all = kernels::variants();
  return std::find_if(all.begin(), all.end(),
                      [](const kernels::Variant& v) { return v.table == &kernels::best(); })
      ->name;
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

void stencils(int nx, int ny, int threads, const Rates& rates) {
  const GridOperator A = some_operator(nx, ny);
  GridVector b = A.vector(), x = A.vector(), out = A.vector();
  const auto line = [&](const char* name, const Need& need, double seconds) {
    const double bandwidth = bytes_per_second(need.bytes * double(A.nodes()));
    print_line(name, A.nodes(), need, {bandwidth, threads * rates.floats, threads * rates.roots},
               seconds);
  };
  line("multiply", kMultiply, fastest_seconds([&] { A.multiply(x, out); }));
  line("smooth", kSmooth, fastest_seconds([&] {
         A.for_rows([&](std::ptrdiff_t begin, std::ptrdiff_t end) {
           kernels::best().smooth(A.stencil(), A.rows(begin, end), b, x, 0.5F, out);
         });
       }));
}

void energy(int elements, int threads, const Rates& rates) {
  const FilmMesh mesh = make_film_mesh({.width_mm = 200, .height_mm = 200, .elements = elements});
  FilmEnergy energy(mesh, {}, 0.3);
  const FilmGrid& grid = energy.grid();
  VertexVector moved = mesh.u;
  for (Vec2& p : moved) p += 0.1 * mesh.cell_mm * Vec2(std::sin(p.x()), std::cos(p.y()));
  energy.set_flat_rest(grid.field(mesh.u), 0);
  const GridField u = grid.field(moved);
  GridField out(grid.layout());
  GridArray<double> mask(grid.layout().entries());
  grid.to_mask(std::vector<std::uint8_t>(mesh.u.size(), 1), mask);
  const double bandwidth = bytes_per_second(kGradient.bytes * double(mesh.u.size()));
  print_line("gradient", mesh.u.size(), kGradient,
             {bandwidth, threads * rates.doubles, threads * rates.roots},
             fastest_seconds([&] { energy.gradient(u, mask, out); }));
}

}  // namespace

// Ours do not fuse additions and multiplications, for the same bytes everywhere: limits are those
// of operations apart from each other.
void measure_inner_loops() {
  const AwakeThreads threads_awake;  // as a dip has them
  const Rates rates = operations_per_second();
  const int threads = available_threads();
  fmt::print("\ninner loops ({}, {} threads)\n", instruction_set(), threads);
  fmt::print(
      "  a core in registers: {:.0f} Gflop/s in floats ({:.0f} fused), {:.0f} ({:.0f}) in "
      "doubles, ",
      1e-9 * rates.floats, 1e-9 * rates.fused_floats, 1e-9 * rates.doubles,
      1e-9 * rates.fused_doubles);
  fmt::print("{:.1f}e9 roots with divisions\n", 1e-9 * rates.roots);
  fmt::print(
      "  all cores on 128 MiB: {:.1f} GB/s; bounds below: on arrays of the loop's own size\n",
      1e-9 * bytes_per_second(128 << 20));
  stencils(60, 10, 1, rates);
  energy(1200, 1, rates);
  stencils(125, 161, threads, rates);
  energy(40000, threads, rates);
  stencils(497, 643, threads, rates);
  energy(640000, threads, rates);
}

}  // namespace hydrodip
