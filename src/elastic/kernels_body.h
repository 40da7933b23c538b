// The kernels themselves: included by one file per instruction set, which sets KERNELS_VARIANT and
// KERNELS_WIDTH (floats per register). No header with inline functions may be used here: the linker
// keeps one copy of those, and it could be one that this processor cannot run.
#include "elastic/kernels.h"

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

// Calls body(at) for the places of the nodes of grid rows [begin, end), kWidth at a time.
template <typename Body>
inline void for_nodes(const Stencil& A, std::ptrdiff_t begin, std::ptrdiff_t end,
                      const Body& body) {
  for (std::ptrdiff_t j = begin; j < end; ++j) {
    const std::ptrdiff_t first = (j + 1) * A.stride + kLanes;
    for (std::ptrdiff_t at = first; at < first + A.groups * kLanes; at += kWidth) body(at);
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

void multiply(const Stencil& A, std::ptrdiff_t begin, std::ptrdiff_t end, Input x, Output out) {
  for_nodes(A, begin, end, [&](std::ptrdiff_t at) {
    Register ax, ay;
    apply(A, at, x, ax, ay);
    store(out.x + at, ax);
    store(out.y + at, ay);
  });
}

void residual(const Stencil& A, std::ptrdiff_t begin, std::ptrdiff_t end, Input b, Input x,
              Output r) {
  for_nodes(A, begin, end, [&](std::ptrdiff_t at) {
    Register ax, ay;
    apply(A, at, x, ax, ay);
    store(r.x + at, load(b.x + at) - ax);
    store(r.y + at, load(b.y + at) - ay);
  });
}

void smooth(const Stencil& A, std::ptrdiff_t begin, std::ptrdiff_t end, Input b, Input x,
            float weight, Output out) {
  for_nodes(A, begin, end, [&](std::ptrdiff_t at) {
    Register rx, ry;
    apply(A, at, x, rx, ry);
    rx = load(b.x + at) - rx;
    ry = load(b.y + at) - ry;
    divide(A, at, rx, ry);
    store(out.x + at, load(x.x + at) + weight * rx);
    store(out.y + at, load(x.y + at) + weight * ry);
  });
}

void precondition(const Stencil& A, std::ptrdiff_t begin, std::ptrdiff_t end, Input b, float weight,
                  Output out) {
  for_nodes(A, begin, end, [&](std::ptrdiff_t at) {
    Register rx = load(b.x + at), ry = load(b.y + at);
    divide(A, at, rx, ry);
    store(out.x + at, weight * rx);
    store(out.y + at, weight * ry);
  });
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
#pragma GCC ivdep
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
#pragma GCC ivdep
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
#pragma GCC ivdep
  for (std::size_t n = begin; n < end; ++n) {
    a.x[n] = scale * a.x[n] + b.x[n];
    a.y[n] = scale * a.y[n] + b.y[n];
  }
}

void rest_shapes(const Elements& e, std::size_t begin, std::size_t end, const double* place,
                 const std::uint8_t* film, double* const (*gradient)[2], double* area) {
  double* __restrict g1x = gradient[0][0];
  double* __restrict g1y = gradient[0][1];
  double* __restrict g2x = gradient[1][0];
  double* __restrict g2y = gradient[1][1];
#pragma GCC ivdep
  for (std::size_t t = begin; t < end; ++t) {
    const std::size_t a = 2 * std::size_t(e.corner[0][t]), b = 2 * std::size_t(e.corner[1][t]),
                      c = 2 * std::size_t(e.corner[2][t]);
    const double bx = place[b] - place[a], by = place[b + 1] - place[a + 1];
    const double cx = place[c] - place[a], cy = place[c + 1] - place[a + 1];
    const double twice = bx * cy - by * cx;
    const bool usable = twice > 0;
    const double present = film[t];
    const double inverse = present / (usable ? twice : 1.0) * (usable ? 1.0 : 0.0);
    g1x[t] = cy * inverse;
    g1y[t] = -cx * inverse;
    g2x[t] = -by * inverse;
    g2y[t] = bx * inverse;
    area[t] = usable ? 0.5 * twice * present : 0.0;
  }
}

struct Strain {
  double xx, xy, yx, yy;       // dU/dX
  double cosine, sine, trace;  // its polar decomposition
};

// corotated.h's deformation_gradient() and polar(), in a form that vectorises.
inline Strain strain_of(const Elements& e, std::size_t t, const double* u) {
  const std::size_t a = 2 * std::size_t(e.corner[0][t]), b = 2 * std::size_t(e.corner[1][t]),
                    c = 2 * std::size_t(e.corner[2][t]);
  const double bx = u[b] - u[a], by = u[b + 1] - u[a + 1];
  const double cx = u[c] - u[a], cy = u[c + 1] - u[a + 1];
  const double g1x = e.gradient[0][0][t], g1y = e.gradient[0][1][t];
  const double g2x = e.gradient[1][0][t], g2y = e.gradient[1][1][t];
  Strain s;
  s.xx = bx * g1x + cx * g2x;
  s.xy = bx * g1y + cx * g2y;
  s.yx = by * g1x + cy * g2x;
  s.yy = by * g1y + cy * g2y;
  const double x = s.xx + s.yy, y = s.yx - s.xy;
  const double root = __builtin_sqrt(x * x + y * y);
  s.trace = root > 1e-12 ? root : 1e-12;
  s.cosine = x / s.trace;
  s.sine = y / s.trace;
  return s;
}

std::int64_t forces(const Elements& e, std::size_t begin, std::size_t end, const double* u,
                    double* const (*force)[2]) {
  double* __restrict f1x = force[0][0];
  double* __restrict f1y = force[0][1];
  double* __restrict f2x = force[1][0];
  double* __restrict f2y = force[1][1];
  std::int64_t turned_over = 0;
#pragma GCC ivdep
  for (std::size_t t = begin; t < end; ++t) {
    const Strain s = strain_of(e, t, u);
    // A P = A (2 mu (F - R) + lambda (tr S - 2) R).
    const double stiff = 2 * e.mu[t] * e.area[t];
    const double turn = e.lambda[t] * e.area[t] * (s.trace - 2) - stiff;
    const double xx = stiff * s.xx + turn * s.cosine, xy = stiff * s.xy - turn * s.sine;
    const double yx = stiff * s.yx + turn * s.sine, yy = stiff * s.yy + turn * s.cosine;
    const double g1x = e.gradient[0][0][t], g1y = e.gradient[0][1][t];
    const double g2x = e.gradient[1][0][t], g2y = e.gradient[1][1][t];
    f1x[t] = xx * g1x + xy * g1y;
    f1y[t] = yx * g1x + yy * g1y;
    f2x[t] = xx * g2x + xy * g2y;
    f2y[t] = yx * g2x + yy * g2y;
    const double det = s.xx * s.yy - s.xy * s.yx;
    turned_over += (e.area[t] > 0) & !(det > 0) ? 1 : 0;
  }
  return turned_over;
}

std::int64_t turned_over(const Elements& e, std::size_t begin, std::size_t end, const double* u) {
  std::int64_t count = 0;
  for (std::size_t t = begin; t < end; ++t) {
    const std::size_t a = 2 * std::size_t(e.corner[0][t]), b = 2 * std::size_t(e.corner[1][t]),
                      c = 2 * std::size_t(e.corner[2][t]);
    const double twice =
        (u[b] - u[a]) * (u[c + 1] - u[a + 1]) - (u[b + 1] - u[a + 1]) * (u[c] - u[a]);
    count += (e.area[t] > 0) & !(twice > 0) ? 1 : 0;
  }
  return count;
}

void changed(const Elements& e, std::size_t begin, std::size_t end, const double* u,
             const Linearization& old, double tolerance, std::int64_t* out) {
  const double limit = tolerance * tolerance;
#pragma GCC ivdep
  for (std::size_t t = begin; t < end; ++t) {
    const Strain s = strain_of(e, t, u);
    const double turning = (e.lambda[t] * (s.trace - 2) - 2 * e.mu[t]) / s.trace;
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
  }
}

// The smallest singular value s of F is below 1 / limit: det(F^T F - s^2 I) < 0, or both are.
void overstretched(const Elements& e, std::size_t begin, std::size_t end, const double* u,
                   double limit, std::int64_t* out) {
  const double bound = 1 / (limit * limit);
#pragma GCC ivdep
  for (std::size_t t = begin; t < end; ++t) {
    const Strain s = strain_of(e, t, u);
    const double squares = s.xx * s.xx + s.xy * s.xy + s.yx * s.yx + s.yy * s.yy;
    const double det = s.xx * s.yy - s.xy * s.yx;
    const bool far = (det * det - squares * bound + bound * bound < 0) | (squares < 2 * bound);
    out[t] = e.area[t] > 0 ? (far ? 1 : 0) : 0;
  }
}

}  // namespace

extern const Table KERNELS_VARIANT;
const Table KERNELS_VARIANT = {
    multiply,      residual,    smooth,        precondition, restrict_rows, prolong_rows, dot,
    scale_and_add, rest_shapes, overstretched, forces,       turned_over,   changed};

}  // namespace hydrodip::kernels
