#include "elastic/material_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "elastic/corotated.h"

namespace hydrodip {

namespace {

// Below it the mirroring part has no direction of its own, and its stiffness is the same in all.
constexpr double kNoMirroring = 1e-6;

// Where laws are checked, and how: fourth-order differences of this width, which have to agree to
// this share of the largest derivative. A table's third derivative jumps.
constexpr double kChecked[] = {0.52, 0.7, 0.86, 1.0, 1.13, 1.4, 1.9};
constexpr double kWidth = 1e-3;
constexpr double kAgreement = 1e-3;
constexpr double kSymmetry = 1e-6;
// Of the largest energy; less is what a table's spline makes of rounding.
constexpr double kLeastStiffness = 1e-10;
// Between these proportions alone count; beyond, the solver's squares leave the range of doubles.
constexpr double kSoftest = 1e-15, kStiffest = 1e15;

class CorotatedLaw : public MaterialLaw {
 public:
  explicit CorotatedLaw(double poisson) : lame_(lame(1, poisson)) {}

  Value at(double a, double b) const override {
    const double x = a - 1, y = b - 1, dilation = x + y;
    const double mu = lame_.mu, lambda = lame_.lambda;
    return {mu * (x * x + y * y) + 0.5 * lambda * dilation * dilation,
            2 * mu * x + lambda * dilation,
            2 * mu * y + lambda * dilation,
            2 * mu + lambda,
            lambda,
            2 * mu + lambda};
  }

 private:
  Lame lame_;
};

using Member = double MaterialLaw::Value::*;

double difference(const MaterialLaw& law, Member member, double a, double b, bool by_a) {
  const auto at = [&](double d) { return law.at(a + (by_a ? d : 0), b + (by_a ? 0 : d)).*member; };
  return (8 * (at(kWidth) - at(-kWidth)) - (at(2 * kWidth) - at(-2 * kWidth))) / (12 * kWidth);
}

struct Derivative {
  const char* name;
  Member value, of;
  bool by_a;
};
constexpr Derivative kDerivatives[] = {
    {"by_a", &MaterialLaw::Value::by_a, &MaterialLaw::Value::energy, true},
    {"by_b", &MaterialLaw::Value::by_b, &MaterialLaw::Value::energy, false},
    {"by_aa", &MaterialLaw::Value::by_aa, &MaterialLaw::Value::by_a, true},
    {"by_ab", &MaterialLaw::Value::by_ab, &MaterialLaw::Value::by_a, false},
    {"by_bb", &MaterialLaw::Value::by_bb, &MaterialLaw::Value::by_b, false},
};

void check_finite(const MaterialLaw& law, double a, double b) {
  const MaterialLaw::Value v = law.at(a, b);
  for (const double x : {v.energy, v.by_a, v.by_b, v.by_aa, v.by_ab, v.by_bb})
    if (!std::isfinite(x))
      throw InputError(
          fmt::format("the material law is not finite at a = {:g}, b = {:g} (film {:.3g} and {:.3g}"
                      " times as long as printed)",
                      a, b, 1 / a, 1 / b));
}

// Film that does not resist being stretched or sheared would stay wherever it began, without a
// word.
void check_stiff(const MaterialLaw& law, double largest_energy) {
  const MaterialLaw::Value v = law.at(1, 1);
  // Of small waves along the film and across, which energies of area alone change in neither.
  const double along = v.by_aa, across = v.by_aa - v.by_ab + v.by_a;
  if (!(std::min(along, across) > kLeastStiffness * largest_energy))
    throw InputError(fmt::format(
        "the material law makes film without stiffness: about unstretched film its energy has to "
        "grow with every deformation (its second derivative along one is {:.3g}, across {:.3g})",
        along, across));
  if (!(along >= kSoftest && along <= kStiffest))
    throw InputError(
        fmt::format("the material law's energies are too {} to be computed with (its second "
                    "derivative is {:.3g}): multiply them by {:.0e}; only proportions count",
                    along < kSoftest ? "small" : "large", along, 1 / along));
}

}  // namespace

std::shared_ptr<const MaterialLaw> make_corotated_law(double poisson) {
  if (!(poisson > -1 && poisson < 0.5))
    throw InputError("Poisson's ratio must be above -1 and below 0.5");
  return std::make_shared<const CorotatedLaw>(poisson);
}

void check_law(const MaterialLaw& law) {
  double energy = 0, slope = 0, bend = 0;
  for (const double a : kChecked)
    for (const double b : kChecked) {
      check_finite(law, a, b);
      const MaterialLaw::Value v = law.at(a, b);
      energy = std::max(energy, std::abs(v.energy));
      slope = std::max({slope, std::abs(v.by_a), std::abs(v.by_b)});
      bend = std::max({bend, std::abs(v.by_aa), std::abs(v.by_ab), std::abs(v.by_bb)});
    }
  check_stiff(law, energy);
  for (const double a : kChecked)
    for (const double b : kChecked) {
      const MaterialLaw::Value v = law.at(a, b);
      if (std::abs(v.energy - law.at(b, a).energy) > kSymmetry * energy)
        throw InputError(fmt::format(
            "the material law is not isotropic: its energy at ({0:g}, {1:g}) is not that at ({1:g},"
            " {0:g})",
            a, b));
      for (const Derivative& d : kDerivatives) {
        const double said = v.*(d.value), found = difference(law, d.of, a, b, d.by_a);
        const double scale = d.of == &MaterialLaw::Value::energy ? slope : bend;
        if (std::abs(said - found) > kAgreement * scale)
          throw InputError(
              fmt::format("the material law's derivative {} at a = {:g}, b = {:g} is {:.6g}, but "
                          "differences of "
                          "what it derives say {:.6g}",
                          d.name, a, b, said, found));
      }
    }
}

LawState law_state(const MaterialLaw& law, const Mat2& F) {
  LawState s;
  const Vec2 turning(F(0, 0) + F(1, 1), F(1, 0) - F(0, 1));
  const Vec2 mirroring(F(0, 0) - F(1, 1), F(1, 0) + F(0, 1));
  // As polar(): a collapsed triangle has no rotation of its own.
  s.p = std::max(turning.norm(), 1e-12);
  s.q = mirroring.norm();
  s.turning = turning / s.p;
  s.mirroring = s.q > 1e-12 ? Vec2(mirroring / s.q) : Vec2(1, 0);
  const MaterialLaw::Value v = law.at(0.5 * (s.p + s.q), 0.5 * (s.p - s.q));
  s.energy = v.energy;
  s.by_p = 0.5 * (v.by_a + v.by_b);
  s.by_q = 0.5 * (v.by_a - v.by_b);
  s.by_pp = 0.25 * (v.by_aa + 2 * v.by_ab + v.by_bb);
  s.by_pq = 0.25 * (v.by_aa - v.by_bb);
  s.by_qq = 0.25 * (v.by_aa - 2 * v.by_ab + v.by_bb);
  return s;
}

Mat2 law_stress(const LawState& s) {
  const Vec2 t = s.by_p * s.turning, m = s.by_q * s.mirroring;
  Mat2 P;
  P << t.x() + m.x(), -t.y() + m.y(), t.y() + m.y(), t.x() - m.x();
  return P;
}

LawStiffness::LawStiffness(const LawState& s, bool definite)
    : turning_(s.turning),
      mirroring_(s.mirroring),
      pp_(s.by_pp),
      pq_(s.by_pq),
      qq_(s.by_qq),
      turn_(s.by_p / s.p),
      shear_(s.q > kNoMirroring ? s.by_q / s.q : s.by_qq) {
  if (!definite) return;
  turn_ = std::max(turn_, 0.0);
  shear_ = std::max(shear_, 0.0);
  // The lengths' 2 x 2 part without its negative eigenvalues.
  const double half = 0.5 * (pp_ + qq_), apart = 0.5 * (pp_ - qq_);
  const double root = std::hypot(apart, pq_);
  if (half - root >= 0) return;
  const double most = std::max(half + root, 0.0);
  const double cosine = root > 0 ? apart / root : 1, sine = root > 0 ? pq_ / root : 0;
  pp_ = 0.5 * most * (1 + cosine);
  qq_ = 0.5 * most * (1 - cosine);
  pq_ = 0.5 * most * sine;
}

Mat2 LawStiffness::block(const Vec2& ga, const Vec2& gb) const {
  struct Ways {
    Vec2 p, q, turn, shear;
  };
  // What a vertex does to F along each direction, by the vertex's coordinate.
  const auto ways = [&](const Vec2& g) {
    const double tx = turning_.x(), ty = turning_.y(), mx = mirroring_.x(), my = mirroring_.y();
    return Ways{{tx * g.x() - ty * g.y(), ty * g.x() + tx * g.y()},
                {mx * g.x() + my * g.y(), my * g.x() - mx * g.y()},
                {-ty * g.x() - tx * g.y(), tx * g.x() - ty * g.y()},
                {-my * g.x() + mx * g.y(), mx * g.x() + my * g.y()}};
  };
  const Ways a = ways(ga), b = ways(gb);
  return pp_ * a.p * b.p.transpose() + qq_ * a.q * b.q.transpose() +
         pq_ * (a.p * b.q.transpose() + a.q * b.p.transpose()) +
         turn_ * a.turn * b.turn.transpose() + shear_ * a.shear * b.shear.transpose();
}

}  // namespace hydrodip
