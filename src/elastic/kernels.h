// The inner loops of the film solver, compiled once per instruction set and picked at run time.
// Every lane computes the same operations in the same order on all of them and nothing is fused,
// so results are the same bit for bit.
#pragma once

#include <cstddef>
#include <cstdint>

namespace hydrodip::kernels {

// Values of neighbouring grid nodes that are stored and computed together.
constexpr int kLanes = 16;

// A symmetric operator on a grid that couples every node with its eight neighbours by 2 x 2 blocks.
// Arrays over the grid hold node (i, j) at (j + 1) * stride + kLanes + i, and zero around it. Only
// half of the blocks is stored, as the solver is bound by memory: a node's own (xx, xy, yy) and
// those towards the four neighbours (1, 0), (-1, 1), (0, 1), (1, 1) (xx, xy, yx, yy); the others
// are those neighbours' transposed. Rows of nodes where the mask is 0 count as empty.
constexpr int kForward = 4;
struct Stencil {
  const float *own[3], *forward[kForward][4], *inverse_own[3];
  const float* mask;
  std::ptrdiff_t stride;
};
// Of a grid: these rows, and of each of them these groups of kLanes nodes, ends not included.
struct Part {
  std::ptrdiff_t row_begin, row_end, group_begin, group_end;
};
struct Input {
  const float *x, *y;
};
struct Output {
  float *x, *y;
};

// Node (i, j) of the coarse grid lies on (2 i, 2 j) of the fine one. Masks: 1 on free nodes, in the
// vectors' layout.
struct Transfer {
  std::ptrdiff_t fine_stride, coarse_stride;
  int fine_nx, fine_ny, coarse_nx;
  const float *fine_mask, *coarse_mask;
};

// The same in double precision.
struct ConstField {
  const double *x, *y;
};
struct Field {
  double *x, *y;
};

// The film's triangles, two in each cell of its grid: with a, b, c, d counter-clockwise round cell
// (i, j) from node (i, j), the lower one has the corners a, b and c or d, the upper one c, d and a
// or b; the former where `rising` is 1. Arrays over elements hold the lower triangle where arrays
// over the grid hold node (i, j), and the upper one `upper` entries behind it. The shape functions'
// gradients add up to 0, so that corner 0's is not kept. Entries behind a row's last cell are 0.
struct Elements {
  std::ptrdiff_t stride;
  int nx, ny;               // nodes
  const double* rising[2];  // per column, of rows with even and with odd numbers
  std::ptrdiff_t upper;
  const double* gradient[2][2];  // of corners 1 and 2: dN/dX [corner - 1][component], 1/mm
  const double* area;            // 0: no film
  const double* mu;
  double lambda_per_mu;
};
// What a triangle's part of the Hessian was computed with.
struct Linearization {
  const float *gradient[2][2], *area, *cosine, *sine, *turning;
};

// Of a step: its product with the gradient, and the square of the longest move in it.
struct Stride {
  double slope, largest_square;
};

// Rows of the grid that gradient() keeps to itself.
constexpr std::ptrdiff_t kScratchRows = 16;

struct Table {
  // On a part of the grid: out = A x, r = b - A x and out = x + weight * D^-1 (b - A x).
  void (*multiply)(const Stencil&, const Part&, Input x, Output out);
  void (*residual)(const Stencil&, const Part&, Input b, Input x, Output r);
  void (*smooth)(const Stencil&, const Part&, Input b, Input x, float weight, Output out);
  // out = weight * D^-1 b.
  void (*precondition)(const Stencil&, const Part&, Input b, float weight, Output out);
  // For each group of the part, over all its rows: the largest square of a node's D^-1 b.
  void (*largest_squares)(const Stencil&, const Part&, Input b, float* squares);

  // Between a fine grid and one with every second node, on the coarse (restrict) or fine (prolong)
  // grid's rows [begin, end): b = P^T r and x += P e, P bilinear interpolation. Only where the mask
  // is 1; elsewhere b = 0 and x stays.
  void (*restrict_rows)(const Transfer&, std::ptrdiff_t begin, std::ptrdiff_t end, Input r,
                        Output b);
  void (*prolong_rows)(const Transfer&, std::ptrdiff_t begin, std::ptrdiff_t end, Input e,
                       Output x);

  // On vector entries [begin, end), multiples of kLanes: a . b and a = scale a + b.
  double (*dot)(std::size_t begin, std::size_t end, Input a, Input b);
  void (*scale_and_add)(std::size_t begin, std::size_t end, Output a, float scale, Input b);

  // On entries [begin, end) of fields, multiples of kLanes: to = from - length * way, and what that
  // is against the gradient.
  Stride (*go)(std::size_t begin, std::size_t end, ConstField from, Input way, double length,
               ConstField gradient, Field to);
  // a . b.
  double (*dot_field)(std::size_t begin, std::size_t end, ConstField a, Input b);

  // Of the film's elements in the cells of rows [begin, end), at places given for all nodes:

  // Rest shapes of triangles whose corners lie flat there; area 0 where `film` is 0 and where the
  // corners run clockwise. Returns how many triangles with film have less than least_share of the
  // area given.
  std::int64_t (*rest_shapes)(const Elements&, std::ptrdiff_t begin, std::ptrdiff_t end,
                              ConstField place, const double* film, const double* flat_area,
                              double least_share, double* const (*gradient)[2], double* area);
  // 1 where film is stretched further than the limit at u, in some direction.
  void (*overstretched)(const Elements&, std::ptrdiff_t begin, std::ptrdiff_t end, ConstField u,
                        double limit, std::int64_t* out);
  // How many triangles with film are turned over at u.
  std::int64_t (*turned_over)(const Elements&, std::ptrdiff_t begin, std::ptrdiff_t end,
                              ConstField u);
  // 1 where the Hessian at u differs from the linearization by more than the tolerance, relatively.
  // Returns how many do.
  std::int64_t (*changed)(const Elements&, std::ptrdiff_t begin, std::ptrdiff_t end, ConstField u,
                          const Linearization&, double tolerance, std::int64_t* out);

  // Where the points `target`, one for each entry in [begin, end), lie when the film whose nodes
  // are at u is laid down with its nodes at `place`: each is looked for in one element only, given
  // by the arrays' entries of its corners (clockwise ones have nothing in them). 1 in `inside`
  // where it is found there and nearer to the entry's own place than `reach`.
  void (*carry)(std::size_t begin, std::size_t end, const std::int32_t* const corner[3],
                ConstField target, ConstField u, ConstField place, double reach, Field out,
                std::int64_t* inside);

  // The energy at u, added to one sum for each column; `sums` has `stride` entries.
  void (*energy)(const Elements&, std::ptrdiff_t begin, std::ptrdiff_t end, ConstField u,
                 double* sums);
  // The energy's gradient at the nodes of rows [begin, end), times the mask. `scratch`:
  // kScratchRows rows, zero. Returns how many triangles in the cells of those rows are turned over.
  std::int64_t (*gradient)(const Elements&, std::ptrdiff_t begin, std::ptrdiff_t end, ConstField u,
                           const double* mask, Field out, double* scratch);
};

}  // namespace hydrodip::kernels
