// The kernels themselves: included by one file per instruction set, which sets KERNELS_VARIANT and
// KERNELS_WIDTH (floats per register). No header with inline functions may be used here: the linker
// keeps one copy of those, and it could be one that this processor cannot run.
#include "elastic/kernels.h"

// Before a loop whose turns have nothing to do with each other.
#if defined(__clang__)
#define KERNELS_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define KERNELS_INDEPENDENT _Pragma("GCC ivdep")
#endif

// NOLINTBEGIN(misc-definitions-in-headers)
namespace hydrodip::kernels {
namespace {

constexpr int kWidth = KERNELS_WIDTH;
typedef float Register __attribute__((vector_size(4 * KERNELS_WIDTH)));

inline Register load(const float* from) {
  Register r;
  __builtin_memcpy(&r, from, sizeof r);
  return r;
}
inline void store(float* to, Register r) { __builtin_memcpy(to, &r, sizeof r); }

// Calls body(at) for the places of a part's nodes, kWidth at a time.
template <typename Body>
inline void for_nodes(const Stencil& A, const Part& part, const Body& body) {
  for (std::ptrdiff_t j = part.row_begin; j < part.row_end; ++j) {
    const std::ptrdiff_t row = (j + 1) * A.stride + kLanes;
    for (std::ptrdiff_t at = row + part.group_begin * kLanes; at < row + part.group_end * kLanes;
         at += kWidth)
      body(at);
  }
}

inline void apply(const Stencil& A, std::ptrdiff_t at, Input x, Register& out_x, Register& out_y) {
  const std::ptrdiff_t way[kForward] = {1, A.stride - 1, A.stride, A.stride + 1};
  const Register own_x = load(x.x + at), own_y = load(x.y + at), own_xy = load(A.own[1] + at);
  Register sum_x = load(A.own[0] + at) * own_x + own_xy * own_y;
  Register sum_y = own_xy * own_x + load(A.own[2] + at) * own_y;
#pragma GCC unroll 4
  for (int k = 0; k < kForward; ++k) {
    const float* const* block = A.forward[k];
    const std::ptrdiff_t ahead = at + way[k], behind = at - way[k];
    const Register ax = load(x.x + ahead), ay = load(x.y + ahead);
    const Register bx = load(x.x + behind), by = load(x.y + behind);
    sum_x += load(block[0] + at) * ax + load(block[1] + at) * ay;
    sum_y += load(block[2] + at) * ax + load(block[3] + at) * ay;
    sum_x += load(block[0] + behind) * bx + load(block[2] + behind) * by;
    sum_y += load(block[1] + behind) * bx + load(block[3] + behind) * by;
  }
  const Register mask = load(A.mask + at);
  out_x = mask * sum_x;
  out_y = mask * sum_y;
}

inline void divide(const Stencil& A, std::ptrdiff_t at, Register& x, Register& y) {
  const Register xx = load(A.inverse_own[0] + at), xy = load(A.inverse_own[1] + at),
                 yy = load(A.inverse_own[2] + at);
  const Register new_x = xx * x + xy * y;
  y = xy * x + yy * y;
  x = new_x;
}

void multiply(const Stencil& A, const Part& part, Input x, Output out) {
  for_nodes(A, part, [&](std::ptrdiff_t at) {
    Register ax, ay;
    apply(A, at, x, ax, ay);
    store(out.x + at, ax);
    store(out.y + at, ay);
  });
}

void residual(const Stencil& A, const Part& part, Input b, Input x, Output r) {
  for_nodes(A, part, [&](std::ptrdiff_t at) {
    Register ax, ay;
    apply(A, at, x, ax, ay);
    store(r.x + at, load(b.x + at) - ax);
    store(r.y + at, load(b.y + at) - ay);
  });
}

void smooth(const Stencil& A, const Part& part, Input b, Input x, float weight, Output out) {
  for_nodes(A, part, [&](std::ptrdiff_t at) {
    Register rx, ry;
    apply(A, at, x, rx, ry);
    rx = load(b.x + at) - rx;
    ry = load(b.y + at) - ry;
    divide(A, at, rx, ry);
    store(out.x + at, load(x.x + at) + weight * rx);
    store(out.y + at, load(x.y + at) + weight * ry);
  });
}

void precondition(const Stencil& A, const Part& part, Input b, float weight, Output out) {
  for_nodes(A, part, [&](std::ptrdiff_t at) {
    Register rx = load(b.x + at), ry = load(b.y + at);
    divide(A, at, rx, ry);
    store(out.x + at, weight * rx);
    store(out.y + at, weight * ry);
  });
}

void largest_squares(const Stencil& A, const Part& part, Input b, float* squares) {
  for (std::ptrdiff_t group = part.group_begin; group < part.group_end; ++group) {
    Register largest = {};
    for_nodes(A, {part.row_begin, part.row_end, group, group + 1}, [&](std::ptrdiff_t at) {
      Register x = load(b.x + at), y = load(b.y + at);
      divide(A, at, x, y);
      const Register square = x * x + y * y;
      largest = square > largest ? square : largest;
    });
    float most = 0;
    for (int k = 0; k < kWidth; ++k) most = largest[k] > most ? largest[k] : most;
    squares[group - part.group_begin] = most;
  }
}

void restrict_rows(const Transfer& t, std::ptrdiff_t begin, std::ptrdiff_t end, Input r, Output b) {
  for (std::ptrdiff_t J = begin; J < end; ++J)
    for (int component = 0; component < 2; ++component) {
      // The grid may end half a coarse cell before its last row: that row has only one below.
      const bool beyond = 2 * J >= t.fine_ny;
      const float* from = (component == 0 ? r.x : r.y) + (2 * J + 1) * t.fine_stride + kLanes;
      const float* below = from - t.fine_stride;
      const float* above = beyond ? below : from + t.fine_stride;
      const float centre = beyond ? 0.0F : 1.0F, side = beyond ? 0.25F : 0.5F;
      if (beyond) from = below;
      const std::ptrdiff_t first = (J + 1) * t.coarse_stride + kLanes;
      const float* mask = t.coarse_mask + first;
      float* to = (component == 0 ? b.x : b.y) + first;
      KERNELS_INDEPENDENT
      for (int I = 0; I < t.coarse_nx; ++I) {
        const int i = 2 * I;
        const float left = centre * from[i - 1] + side * (below[i - 1] + above[i - 1]);
        const float middle = centre * from[i] + side * (below[i] + above[i]);
        const float right = centre * from[i + 1] + side * (below[i + 1] + above[i + 1]);
        to[I] = mask[I] * (middle + 0.5F * (left + right));
      }
    }
}

void prolong_rows(const Transfer& t, std::ptrdiff_t begin, std::ptrdiff_t end, Input e, Output x) {
  for (std::ptrdiff_t j = begin; j < end; ++j)
    for (int component = 0; component < 2; ++component) {
      const float* from = (component == 0 ? e.x : e.y) + (j / 2 + 1) * t.coarse_stride + kLanes;
      const float* above = from + (j % 2) * t.coarse_stride;
      const std::ptrdiff_t first = (j + 1) * t.fine_stride + kLanes;
      const float* mask = t.fine_mask + first;
      float* to = (component == 0 ? x.x : x.y) + first;
      const int pairs = t.fine_nx / 2;
      if (t.fine_nx % 2 == 1)
        to[2 * pairs] += mask[2 * pairs] * 0.5F * (from[pairs] + above[pairs]);
      KERNELS_INDEPENDENT
      for (int I = 0; I < pairs; ++I) {
        const float here = from[I] + above[I], next = from[I + 1] + above[I + 1];
        to[2 * I] += mask[2 * I] * 0.5F * here;
        to[2 * I + 1] += mask[2 * I + 1] * 0.25F * (here + next);
      }
    }
}

// Lane by lane first, in a fixed order: the same sum on every instruction set.
inline double sum_of(const float* lanes) {
  double sum = 0;
  for (int k = 0; k < kLanes; ++k) sum += double(lanes[k]);
  return sum;
}

double dot(std::size_t begin, std::size_t end, Input a, Input b) {
  alignas(64) float lanes[kLanes] = {};
  for (std::size_t n = begin; n < end; n += kLanes)
    for (std::size_t k = 0; k < kLanes; ++k)
      lanes[k] += a.x[n + k] * b.x[n + k] + a.y[n + k] * b.y[n + k];
  return sum_of(lanes);
}

void scale_and_add(std::size_t begin, std::size_t end, Output a, float scale, Input b) {
  KERNELS_INDEPENDENT
  for (std::size_t n = begin; n < end; ++n) {
    a.x[n] = scale * a.x[n] + b.x[n];
    a.y[n] = scale * a.y[n] + b.y[n];
  }
}

// Doubles that are summed apart from each other: as many for all register sizes.
constexpr std::size_t kParts = 8;
constexpr std::size_t kDoubles = KERNELS_WIDTH / 2;  // per register
typedef double Doubles __attribute__((vector_size(8 * kDoubles)));
typedef float HalfRegister __attribute__((vector_size(4 * kDoubles)));

inline Doubles load(const double* from) {
  Doubles r;
  __builtin_memcpy(&r, from, sizeof r);
  return r;
}
inline Doubles load_doubled(const float* from) {
  HalfRegister r;
  __builtin_memcpy(&r, from, sizeof r);
  return __builtin_convertvector(r, Doubles);
}
inline void store(double* to, Doubles r) { __builtin_memcpy(to, &r, sizeof r); }

// Calls body(n, register) for the registers from entry `begin` to `end`; `register` counts those of
// kParts entries.
template <typename Body>
inline void for_parts(std::size_t begin, std::size_t end, const Body& body) {
  for (std::size_t n = begin; n < end; n += kParts)
#pragma GCC unroll 4
    for (std::size_t part = 0; part < kParts / kDoubles; ++part) body(n + part * kDoubles, part);
}

double sum_of(const Doubles* registers) {
  double a[kParts];
  __builtin_memcpy(a, registers, sizeof a);
  return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
}

Stride go(std::size_t begin, std::size_t end, ConstField from, Input way, double length,
          ConstField gradient, Field to) {
  Doubles slope[kParts / kDoubles] = {}, largest[kParts / kDoubles] = {};
  for_parts(begin, end, [&](std::size_t n, std::size_t part) {
    const Doubles dx = length * load_doubled(way.x + n), dy = length * load_doubled(way.y + n);
    store(to.x + n, load(from.x + n) - dx);
    store(to.y + n, load(from.y + n) - dy);
    slope[part] += load(gradient.x + n) * dx + load(gradient.y + n) * dy;
    const Doubles square = dx * dx + dy * dy;
    largest[part] = square > largest[part] ? square : largest[part];
  });
  double squares[kParts], most = 0;
  __builtin_memcpy(squares, largest, sizeof squares);
  for (const double square : squares) most = square > most ? square : most;
  return {sum_of(slope), most};
}

double dot_field(std::size_t begin, std::size_t end, ConstField a, Input b) {
  Doubles sum[kParts / kDoubles] = {};
  for_parts(begin, end, [&](std::size_t n, std::size_t part) {
    sum[part] += load(a.x + n) * load_doubled(b.x + n) + load(a.y + n) * load_doubled(b.y + n);
  });
  return sum_of(sum);
}

// Where an array over the grid holds the first node of a row.
inline std::ptrdiff_t first_of_row(const Elements& e, std::ptrdiff_t row) {
  return (row + 1) * e.stride + kLanes;
}

// Columns that a loop over a row takes: whole registers, also behind the last node, where there is
// no film and the mask is 0.
inline std::ptrdiff_t columns(const Elements& e) { return (e.stride / kLanes - 1) * kLanes; }

struct Corners {
  double x0, y0, x1, y1, x2, y2;
};

// Of the triangle in the cell behind node `at`.
template <bool kUpper>
[[gnu::always_inline]] inline Corners corners_of(const double* x, const double* y,
                                                 std::ptrdiff_t at, std::ptrdiff_t stride,
                                                 double rising) {
  const double ax = x[at], bx = x[at + 1], cx = x[at + stride + 1], dx = x[at + stride];
  const double ay = y[at], by = y[at + 1], cy = y[at + stride + 1], dy = y[at + stride];
  const bool up = rising > 0;
  if (kUpper) return {cx, cy, dx, dy, up ? ax : bx, up ? ay : by};
  return {ax, ay, bx, by, up ? cx : dx, up ? cy : dy};
}

template <bool kUpper>
inline std::int64_t rest_shapes_of(const Elements& e, std::ptrdiff_t row, ConstField place,
                                   const double* film, const double* flat_area, double least_share,
                                   double* const (*gradient)[2], double* area) {
  const std::ptrdiff_t count = columns(e);
  const std::ptrdiff_t first = first_of_row(e, row), shift = kUpper ? e.upper : 0;
  const double *x = place.x + first, *y = place.y + first, *rising = e.rising[row & 1];
  const std::ptrdiff_t stride = e.stride;
  double* __restrict g1x = gradient[0][0] + first + shift;
  double* __restrict g1y = gradient[0][1] + first + shift;
  double* __restrict g2x = gradient[1][0] + first + shift;
  double* __restrict g2y = gradient[1][1] + first + shift;
  double* __restrict size = area + first + shift;
  film += first + shift;
  flat_area += first + shift;
  std::int64_t small = 0;
  KERNELS_INDEPENDENT
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Corners t = corners_of<kUpper>(x, y, i, stride, rising[i]);
    const double bx = t.x1 - t.x0, by = t.y1 - t.y0, cx = t.x2 - t.x0, cy = t.y2 - t.y0;
    const double twice = bx * cy - by * cx;
    const bool usable = twice > 0;
    const double present = film[i];
    const double inverse = present / (usable ? twice : 1.0) * (usable ? 1.0 : 0.0);
    const double found = usable ? 0.5 * twice * present : 0.0;
    g1x[i] = cy * inverse;
    g1y[i] = -cx * inverse;
    g2x[i] = -by * inverse;
    g2y[i] = bx * inverse;
    size[i] = found;
    small += ((present > 0) & (found < least_share * flat_area[i])) ? 1 : 0;
  }
  return small;
}

std::int64_t rest_shapes(const Elements& e, std::ptrdiff_t begin, std::ptrdiff_t end,
                         ConstField place, const double* film, const double* flat_area,
                         double least_share, double* const (*gradient)[2], double* area) {
  std::int64_t small = 0;
  for (std::ptrdiff_t row = begin; row < end; ++row) {
    small += rest_shapes_of<false>(e, row, place, film, flat_area, least_share, gradient, area);
    small += rest_shapes_of<true>(e, row, place, film, flat_area, least_share, gradient, area);
  }
  return small;
}

struct Strain {
  double xx, xy, yx, yy;                      // dU/dX
  double cosine, sine, trace, inverse_trace;  // its polar decomposition
};

// 1 / sqrt(x) to within 1e-14 of it, for x that a float can hold: from single precision, where
// roots and divisions take a quarter of the time, by one step of Newton's.
inline double inverse_root(double x) {
  const double rough = double(1.0F / __builtin_sqrtf(float(x)));
  return rough * (1.5 - 0.5 * x * rough * rough);
}

// corotated.h's deformation_gradient() and polar(), in a form that vectorises. `at`: of the
// element.
[[gnu::always_inline]] inline Strain strain_of(const Elements& e, std::ptrdiff_t at,
                                               const Corners& u) {
  const double bx = u.x1 - u.x0, by = u.y1 - u.y0, cx = u.x2 - u.x0, cy = u.y2 - u.y0;
  const double g1x = e.gradient[0][0][at], g1y = e.gradient[0][1][at];
  const double g2x = e.gradient[1][0][at], g2y = e.gradient[1][1][at];
  Strain s;
  s.xx = bx * g1x + cx * g2x;
  s.xy = bx * g1y + cx * g2y;
  s.yx = by * g1x + cy * g2x;
  s.yy = by * g1y + cy * g2y;
  const double x = s.xx + s.yy, y = s.yx - s.xy;
  const double square = x * x + y * y;
  const double bounded = square > 1e-24 ? (square < 1e30 ? square : 1e30) : 1e-24;
  s.inverse_trace = inverse_root(bounded);
  s.trace = bounded * s.inverse_trace;
  s.cosine = x * s.inverse_trace;
  s.sine = y * s.inverse_trace;
  return s;
}

// Forces on corners 1 and 2 (on corner 0 minus their sum), and whether the triangle is turned over.
struct Forces {
  double x1, y1, x2, y2;
  std::int64_t turned_over;
};
[[gnu::always_inline]] inline Forces forces_of(const Elements& e, std::ptrdiff_t at,
                                               const Corners& u) {
  const Strain s = strain_of(e, at, u);
  // A P = A (2 mu (F - R) + lambda (tr S - 2) R).
  const double stiff = 2 * e.mu[at] * e.area[at];
  const double turn = stiff * (0.5 * e.lambda_per_mu * (s.trace - 2) - 1);
  const double xx = stiff * s.xx + turn * s.cosine, xy = stiff * s.xy - turn * s.sine;
  const double yx = stiff * s.yx + turn * s.sine, yy = stiff * s.yy + turn * s.cosine;
  const double g1x = e.gradient[0][0][at], g1y = e.gradient[0][1][at];
  const double g2x = e.gradient[1][0][at], g2y = e.gradient[1][1][at];
  const double det = s.xx * s.yy - s.xy * s.yx;
  return {xx * g1x + xy * g1y, yx * g1x + yy * g1y, xx * g2x + xy * g2y, yx * g2x + yy * g2y,
          ((e.area[at] > 0) & !(det > 0)) ? 1 : 0};
}

// A psi = A (mu |F - R|^2 + lambda / 2 (tr S - 2)^2).
[[gnu::always_inline]] inline double energy_of(const Elements& e, std::ptrdiff_t at,
                                               const Corners& u) {
  const Strain s = strain_of(e, at, u);
  const double xx = s.xx - s.cosine, xy = s.xy + s.sine, yx = s.yx - s.sine, yy = s.yy - s.cosine;
  const double dilation = s.trace - 2;
  const double density =
      xx * xx + xy * xy + yx * yx + yy * yy + 0.5 * e.lambda_per_mu * dilation * dilation;
  return e.area[at] * e.mu[at] * density;
}

void energy(const Elements& e, std::ptrdiff_t begin, std::ptrdiff_t end, ConstField u,
            double* sums) {
  double* __restrict sum = sums;
  const std::ptrdiff_t count = columns(e);
  for (std::ptrdiff_t row = begin; row < end; ++row) {
    const std::ptrdiff_t first = first_of_row(e, row), stride = e.stride;
    const double *x = u.x, *y = u.y, *rising = e.rising[row & 1];
    KERNELS_INDEPENDENT
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const std::ptrdiff_t at = first + i;
      sum[i] += energy_of(e, at, corners_of<false>(x, y, at, stride, rising[i])) +
                energy_of(e, at + e.upper, corners_of<true>(x, y, at, stride, rising[i]));
    }
  }
}

// What the cells of one row add to their nodes' forces: per corner of the cell, by column.
struct CellForces {
  double *ax, *ay, *bx, *by, *cx, *cy, *dx, *dy;
};

// Of this row of the scratch space, behind room for one column before the first.
inline CellForces cell_forces(double* scratch, std::ptrdiff_t row, std::ptrdiff_t stride) {
  double* first = scratch + (row & 1) * (kScratchRows / 2) * stride + kLanes;
  return {first,
          first + stride,
          first + 2 * stride,
          first + 3 * stride,
          first + 4 * stride,
          first + 5 * stride,
          first + 6 * stride,
          first + 7 * stride};
}

std::int64_t add_up_cells(const Elements& e, std::ptrdiff_t row, ConstField u,
                          const CellForces& to) {
  const std::ptrdiff_t count = columns(e);
  const std::ptrdiff_t first = first_of_row(e, row), stride = e.stride;
  const double *x = u.x, *y = u.y, *rising = e.rising[row & 1];
  double* __restrict ax = to.ax, * __restrict ay = to.ay, * __restrict bx = to.bx;
  double* __restrict by = to.by, * __restrict cx = to.cx, * __restrict cy = to.cy;
  double* __restrict dx = to.dx, * __restrict dy = to.dy;
  std::int64_t turned_over = 0;
  KERNELS_INDEPENDENT
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const std::ptrdiff_t at = first + i;
    const bool up = rising[i] > 0;
    const Forces lower = forces_of(e, at, corners_of<false>(x, y, at, stride, rising[i]));
    const Forces upper = forces_of(e, at + e.upper, corners_of<true>(x, y, at, stride, rising[i]));
    const double lower_x = -(lower.x1 + lower.x2), lower_y = -(lower.y1 + lower.y2);
    const double upper_x = -(upper.x1 + upper.x2), upper_y = -(upper.y1 + upper.y2);
    ax[i] = lower_x + (up ? upper.x2 : 0.0);
    ay[i] = lower_y + (up ? upper.y2 : 0.0);
    bx[i] = lower.x1 + (up ? 0.0 : upper.x2);
    by[i] = lower.y1 + (up ? 0.0 : upper.y2);
    cx[i] = upper_x + (up ? lower.x2 : 0.0);
    cy[i] = upper_y + (up ? lower.y2 : 0.0);
    dx[i] = upper.x1 + (up ? 0.0 : lower.x2);
    dy[i] = upper.y1 + (up ? 0.0 : lower.y2);
    turned_over += lower.turned_over + upper.turned_over;
  }
  return turned_over;
}

std::int64_t gradient(const Elements& e, std::ptrdiff_t begin, std::ptrdiff_t end, ConstField u,
                      const double* mask, Field out, double* scratch) {
  const std::ptrdiff_t count = columns(e);
  std::int64_t turned_over = 0;
  for (std::ptrdiff_t row = begin > 0 ? begin - 1 : 0; row < end; ++row) {
    const CellForces here = cell_forces(scratch, row, e.stride);
    const CellForces before = cell_forces(scratch, row + 1, e.stride);
    if (row < e.ny - 1) {
      const std::int64_t found = add_up_cells(e, row, u, here);
      if (row >= begin) turned_over += found;
    } else {
      for (std::ptrdiff_t i = 0; i < count; ++i)
        here.ax[i] = here.ay[i] = here.bx[i] = here.by[i] = 0;
    }
    if (row < begin) continue;
    const std::ptrdiff_t first = first_of_row(e, row);
    const double* free = mask + first;
    double* __restrict x = out.x + first, * __restrict y = out.y + first;
    KERNELS_INDEPENDENT
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      x[i] = free[i] * ((here.ax[i] + here.bx[i - 1]) + (before.cx[i - 1] + before.dx[i]));
      y[i] = free[i] * ((here.ay[i] + here.by[i - 1]) + (before.cy[i - 1] + before.dy[i]));
    }
  }
  return turned_over;
}

template <bool kUpper>
inline std::int64_t turned_over_of(const Elements& e, std::ptrdiff_t row, ConstField u) {
  const std::ptrdiff_t count = columns(e);
  const std::ptrdiff_t first = first_of_row(e, row), stride = e.stride;
  const double *x = u.x + first, *y = u.y + first, *rising = e.rising[row & 1];
  const double* area = e.area + first + (kUpper ? e.upper : 0);
  std::int64_t found = 0;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Corners t = corners_of<kUpper>(x, y, i, stride, rising[i]);
    const double twice = (t.x1 - t.x0) * (t.y2 - t.y0) - (t.y1 - t.y0) * (t.x2 - t.x0);
    found += ((area[i] > 0) & !(twice > 0)) ? 1 : 0;
  }
  return found;
}

std::int64_t turned_over(const Elements& e, std::ptrdiff_t begin, std::ptrdiff_t end,
                         ConstField u) {
  std::int64_t found = 0;
  for (std::ptrdiff_t row = begin; row < end; ++row)
    found += turned_over_of<false>(e, row, u) + turned_over_of<true>(e, row, u);
  return found;
}

template <bool kUpper>
inline std::int64_t changed_of(const Elements& e, std::ptrdiff_t row, ConstField u,
                               const Linearization& old, double tolerance, std::int64_t* out) {
  const double limit = tolerance * tolerance;
  std::int64_t found = 0;
  const std::ptrdiff_t count = columns(e);
  const std::ptrdiff_t first = first_of_row(e, row), stride = e.stride;
  const double* rising = e.rising[row & 1];
  KERNELS_INDEPENDENT
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const std::ptrdiff_t t = first + i + (kUpper ? e.upper : 0);
    const Strain s = strain_of(e, t, corners_of<kUpper>(u.x, u.y, first + i, stride, rising[i]));
    const double turning = e.mu[t] * (e.lambda_per_mu * (s.trace - 2) - 2) * s.inverse_trace;
    const double g1x = e.gradient[0][0][t], g1y = e.gradient[0][1][t];
    const double g2x = e.gradient[1][0][t], g2y = e.gradient[1][1][t];
    const double d1x = g1x - double(old.gradient[0][0][t]),
                 d1y = g1y - double(old.gradient[0][1][t]);
    const double d2x = g2x - double(old.gradient[1][0][t]),
                 d2y = g2y - double(old.gradient[1][1][t]);
    const double moved = d1x * d1x + d1y * d1y + d2x * d2x + d2y * d2y;
    const double size = g1x * g1x + g1y * g1y + g2x * g2x + g2y * g2y;
    const double grown = e.area[t] - double(old.area[t]);
    const double dc = s.cosine - double(old.cosine[t]), ds = s.sine - double(old.sine[t]);
    const double stiffened = turning - double(old.turning[t]);
    const bool film = e.area[t] > 0;
    const bool differs = (moved > limit * size) | (grown * grown > limit * e.area[t] * e.area[t]) |
                         (dc * dc + ds * ds > limit) |
                         (stiffened * stiffened > limit * e.mu[t] * e.mu[t]);
    const bool emptied = old.area[t] > 0;
    out[t] = film ? (differs ? 1 : 0) : (emptied ? 1 : 0);
    found += out[t];
  }
  return found;
}

std::int64_t changed(const Elements& e, std::ptrdiff_t begin, std::ptrdiff_t end, ConstField u,
                     const Linearization& old, double tolerance, std::int64_t* out) {
  std::int64_t found = 0;
  for (std::ptrdiff_t row = begin; row < end; ++row) {
    found += changed_of<false>(e, row, u, old, tolerance, out);
    found += changed_of<true>(e, row, u, old, tolerance, out);
  }
  return found;
}

// The smallest singular value s of F is below 1 / limit: det(F^T F - s^2 I) < 0, or both are.
template <bool kUpper>
inline void overstretched_of(const Elements& e, std::ptrdiff_t row, ConstField u, double bound,
                             std::int64_t* out) {
  const std::ptrdiff_t count = columns(e);
  const std::ptrdiff_t first = first_of_row(e, row), stride = e.stride;
  const double* rising = e.rising[row & 1];
  KERNELS_INDEPENDENT
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const std::ptrdiff_t t = first + i + (kUpper ? e.upper : 0);
    const Strain s = strain_of(e, t, corners_of<kUpper>(u.x, u.y, first + i, stride, rising[i]));
    const double squares = s.xx * s.xx + s.xy * s.xy + s.yx * s.yx + s.yy * s.yy;
    const double det = s.xx * s.yy - s.xy * s.yx;
    const bool far = (det * det - squares * bound + bound * bound < 0) | (squares < 2 * bound);
    out[t] = e.area[t] > 0 ? (far ? 1 : 0) : 0;
  }
}

void overstretched(const Elements& e, std::ptrdiff_t begin, std::ptrdiff_t end, ConstField u,
                   double limit, std::int64_t* out) {
  const double bound = 1 / (limit * limit);
  for (std::ptrdiff_t row = begin; row < end; ++row) {
    overstretched_of<false>(e, row, u, bound, out);
    overstretched_of<true>(e, row, u, bound, out);
  }
}

void carry(std::size_t begin, std::size_t end, const std::int32_t* const corner[3],
           ConstField target, ConstField u, ConstField place, double reach, Field out,
           std::int64_t* inside) {
  constexpr double kInside = -1e-12;
  double* __restrict to_x = out.x, * __restrict to_y = out.y;
  KERNELS_INDEPENDENT
  for (std::size_t n = begin; n < end; ++n) {
    const std::int32_t a = corner[0][n], b = corner[1][n], c = corner[2][n];
    const double ux = u.x[a], uy = u.y[a];
    const double bx = u.x[b] - ux, by = u.y[b] - uy, cx = u.x[c] - ux, cy = u.y[c] - uy;
    const double tx = target.x[n] - ux, ty = target.y[n] - uy;
    const double twice = bx * cy - by * cx;
    const bool usable = twice > 0;
    const double inverse = 1 / (usable ? twice : 1.0);
    const double wb = (tx * cy - ty * cx) * inverse, wc = (bx * ty - by * tx) * inverse;
    const double wa = 1 - wb - wc;
    const double x = wa * place.x[a] + wb * place.x[b] + wc * place.x[c];
    const double y = wa * place.y[a] + wb * place.y[b] + wc * place.y[c];
    const double dx = x - place.x[n], dy = y - place.y[n];
    const bool near = dx * dx + dy * dy < reach * reach;
    to_x[n] = x;
    to_y[n] = y;
    inside[n] = (usable & near & (wa >= kInside) & (wb >= kInside) & (wc >= kInside)) ? 1 : 0;
  }
}

}  // namespace

extern const Table KERNELS_VARIANT;
const Table KERNELS_VARIANT = {
    multiply,      residual,    smooth,        precondition, largest_squares, restrict_rows,
    prolong_rows,  dot,         scale_and_add, go,           dot_field,       rest_shapes,
    overstretched, turned_over, changed,       carry,        energy,          gradient};

}  // namespace hydrodip::kernels
// NOLINTEND(misc-definitions-in-headers)
