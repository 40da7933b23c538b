// Film that resists its deformation by a law of one's own instead of the paper's Eq. 3: isotropic,
// a function of the two principal values of F = dU/dX.
//
// As everywhere in the solver (corotated.h), F takes film as it floats to the flat, printed film.
// Its principal values a and b are lengths printed over lengths now: the film's principal stretches
// are 1 / a and 1 / b. Energy counts per mm^2 of film as it floats, relative to blank film's
// modulus; ink multiplies it.
#pragma once

#include <memory>

#include "base/math.h"

namespace hydrodip {

// Immutable; asked from many threads.
class MaterialLaw {
 public:
  virtual ~MaterialLaw() = default;

  // Energy density and its derivatives by a and b.
  struct Value {
    double energy = 0;
    double by_a = 0, by_b = 0;
    double by_aa = 0, by_ab = 0, by_bb = 0;
  };
  // The same with a and b exchanged, and twice continuously differentiable. b may be 0 or less,
  // where the solver tries film that is turned over.
  virtual Value at(double a, double b) const = 0;
};

// The paper's own: mu ((a - 1)^2 + (b - 1)^2) + lambda / 2 (a + b - 2)^2 for Young's modulus 1.
std::shared_ptr<const MaterialLaw> make_corotated_law(double poisson);

// Throws InputError if the law has values that are not finite, depends on the order of a and b,
// makes unstretched film that does not resist, or names derivatives that finite differences of its
// energy contradict; for film that is stretched by less than two and pressed together to more than
// half.
void check_law(const MaterialLaw& law);

// ---- what the solver makes of it, for one triangle ----

// F's part that turns, p R(cosine, sine), and the part that mirrors, q times a reflection: both of
// unit length here. a = (p + q) / 2, b = (p - q) / 2, and derivatives of the energy g(p, q).
struct LawState {
  double p = 0, q = 0;
  Vec2 turning, mirroring;
  double energy = 0;
  double by_p = 0, by_q = 0;
  double by_pp = 0, by_pq = 0, by_qq = 0;
};
LawState law_state(const MaterialLaw& law, const Mat2& F);

// P = dpsi/dF.
Mat2 law_stress(const LawState& state);

// d2psi/dF2 as a sum over the four directions in which F can change: the lengths p and q, and the
// turns of both parts.
class LawStiffness {
 public:
  // definite: the nearest that is positive semidefinite.
  LawStiffness(const LawState& state, bool definite);

  // Of shape functions with these gradients (1/mm): d2psi / du_a du_b.
  Mat2 block(const Vec2& gradient_a, const Vec2& gradient_b) const;

 private:
  Vec2 turning_, mirroring_;
  double pp_, pq_, qq_, turn_, shear_;
};

}  // namespace hydrodip
