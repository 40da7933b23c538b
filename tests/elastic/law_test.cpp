// Material laws of one's own, in the same harness and with the same solvers as the paper's.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

#include "base/eigenpairs.h"
#include "base/error.h"
#include "contains.h"
#include "elastic/corotated.h"
#include "elastic/differences.h"
#include "elastic/linear_solver.h"
#include "elastic/relaxation.h"
#include "elastic/table_law.h"
#include "refusal.h"

namespace hydrodip {
namespace {

using fixtures::RandomFilm;

// A rubber-like film (neo-Hookean in the plane, per mm^2 of flat film) by its principal stretches.
double rubber(double s, double t) {
  const double j = std::log(s * t);
  return 0.25 * (s * s + t * t - 2 - 2 * j) + 0.2 * j * j;
}

// With third and mixed derivatives everywhere, in closed form.
class WavyLaw : public MaterialLaw {
 public:
  Value at(double a, double b) const override {
    const double x = a - 1, y = b - 1, w = 0.3 * std::cos(2 * (x + y)), s = std::sin(2 * (x + y));
    return {x * x + y * y + w + 0.1 * x * x * y * y,
            2 * x - 0.6 * s + 0.2 * x * y * y,
            2 * y - 0.6 * s + 0.2 * x * x * y,
            2 - 4 * w + 0.2 * y * y,
            -4 * w + 0.4 * x * y,
            2 - 4 * w + 0.2 * x * x};
  }
};

// Says twice the slope that it has.
class WrongLaw : public WavyLaw {
 public:
  Value at(double a, double b) const override {
    Value v = WavyLaw::at(a, b);
    v.by_a *= 2;
    return v;
  }
};

struct Named {
  const char* name;
  std::shared_ptr<const MaterialLaw> law;
};
std::vector<Named> laws() {
  return {{"corotated", make_corotated_law(0.3)},
          {"wavy", std::make_shared<const WavyLaw>()},
          {"table of rubber",
           make_table_law(tabulated_by_stretch(rubber, {.samples = 1025, .energy = {}}))}};
}

TEST(MaterialLaw, GradientAndHessianMatchFiniteDifferences) {
  for (const Named& named : laws()) {
    SCOPED_TRACE(named.name);
    check_law(*named.law);
    const RandomFilm film(7);
    const FilmEnergy energy = film.energy(0, named.law);
    fixtures::expect_gradient(energy, film.u, film.is_free, 1e-6);
    fixtures::expect_hessian(energy, film.u, 2e-6);
  }
}

// The paper's energy by its kernels, and the same as a law and as a table.
TEST(MaterialLaw, PapersLawIsThePapersEnergy) {
  for (const double nu : {0.0, 0.3}) {
    const RandomFilm film(9);
    const FilmEnergy built_in = film.energy(nu);
    const LawEnergy energy = [law = make_corotated_law(nu)](double a, double b) {
      return law->at(a, b).energy;
    };
    const GridField u = built_in.grid().field(film.u);
    const VertexVector force = fixtures::gradient_by_vertex(built_in, film.u, film.is_free);
    BlockMatrix hessian, definite;
    built_in.hessian(film.u, false, hessian);
    built_in.hessian(film.u, true, definite);
    for (const auto& law : {make_corotated_law(nu), make_table_law(tabulated(energy))}) {
      const FilmEnergy same = film.energy(nu, law);
      EXPECT_NEAR(same.value(u), built_in.value(u), 1e-9 * built_in.value(u));
      const VertexVector again = fixtures::gradient_by_vertex(same, film.u, film.is_free);
      for (std::size_t v = 0; v < force.size(); ++v)
        EXPECT_LT((force[v] - again[v]).norm(), 1e-9 * built_in.value(u));
      for (const bool clamped : {false, true}) {
        BlockMatrix H;
        same.hessian(film.u, clamped, H);
        const BlockMatrix& expected = clamped ? definite : hessian;
        ASSERT_EQ(H.column, expected.column);
        for (std::size_t s = 0; s < H.block.size(); ++s)
          EXPECT_LT((H.block[s] - expected.block[s]).norm(), 1e-6);
      }
    }
  }
}

// Rotations on either side change nothing, and the table is exact between its nodes to its order.
TEST(MaterialLaw, TableOfStretchesIsTheFunctionOfPrincipalStretches) {
  const auto law = make_table_law(tabulated_by_stretch(rubber));
  Mat2 G;
  G << 1.2, 0.1, -0.2, 0.9;  // film now over film printed
  const Vec2 stretch = Eigen::JacobiSVD<Mat2>(G).singularValues();
  const double expected = rubber(stretch[0], stretch[1]) / G.determinant();
  for (const double turn : {0.0, 1.0, 3.0}) {
    Mat2 R;
    R << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
    EXPECT_NEAR(law_state(*law, R * G.inverse()).energy, expected, 1e-6);
    EXPECT_NEAR(law_state(*law, G.inverse() * R).energy, expected, 1e-6);
  }
}

// A spline through a cubic is the cubic; beyond the table it goes on as a parabola, smoothly.
TEST(MaterialLaw, TableIsExactForCubicsAndSmoothBeyond) {
  const auto cubic = [](double a, double b) { return a * a * a + b * b * b + 2 * a * b; };
  const auto law =
      make_table_law(tabulated(cubic, {.least = 0.5, .most = 2, .samples = 9, .energy = {}}));
  const MaterialLaw::Value v = law->at(0.77, 1.43);
  EXPECT_NEAR(v.energy, cubic(0.77, 1.43), 1e-12);
  EXPECT_NEAR(v.by_a, 3 * 0.77 * 0.77 + 2 * 1.43, 1e-11);
  EXPECT_NEAR(v.by_aa, 6 * 0.77, 1e-10);
  EXPECT_NEAR(v.by_ab, 2, 1e-10);
  const MaterialLaw::Value in = law->at(2 - 1e-9, 1.1), out = law->at(2 + 1e-9, 1.1);
  EXPECT_NEAR(in.by_aa, out.by_aa, 1e-6);
  EXPECT_NEAR(law->at(3, 1.1).by_aa, 12, 1e-9);
  EXPECT_TRUE(std::isfinite(law->at(-1, -2).energy));
}

// However the film is computed, what is turned over is counted.
TEST(MaterialLaw, FilmThatIsTurnedOverIsCounted) {
  const RandomFilm film(9);
  VertexVector folded = film.u;
  for (const std::size_t v : {30UL, 50UL}) folded[v] += Vec2(1.6, 0.3) * film.mesh.cell_mm;
  std::int64_t turned = 0;
  for (std::size_t t = 0; t < film.rest.size(); ++t) {
    const Triangle& v = film.mesh.triangles[t];
    turned += deformation_gradient(film.rest[t], folded[std::size_t(v[0])],
                                   folded[std::size_t(v[1])], folded[std::size_t(v[2])])
                  .determinant() <= 0;
  }
  ASSERT_GT(turned, 1);
  for (const auto& law : {std::shared_ptr<const MaterialLaw>(), make_corotated_law(0.3)}) {
    const FilmEnergy energy = film.energy(0.3, law);
    GridField force(energy.grid().layout());
    GridArray<double> mask(energy.grid().layout().entries());
    energy.grid().to_mask(film.is_free, mask);
    EXPECT_EQ(energy.gradient(energy.grid().field(film.u), mask, force), 0);
    EXPECT_EQ(energy.gradient(energy.grid().field(folded), mask, force), turned);
  }
}

TEST(MaterialLaw, WhatIsNoLawIsRefused) {
  EXPECT_THROW(check_law(WrongLaw()), InputError);
  const auto refused = [](const LawEnergy& energy) {
    EXPECT_THROW(make_table_law(tabulated(energy)), InputError);
  };
  refused([](double a, double b) { return a + 2 * b; });
  refused([](double a, double b) { return 1 / ((a - 0.4) * (b - 0.4)); });
  LawTable few = tabulated([](double a, double b) { return a * b; });
  few.energy.pop_back();
  EXPECT_THROW(make_table_law(few), InputError);
  few.samples = 4;
  EXPECT_THROW(make_table_law(few), InputError);
}

// A dip of it came out as if nothing pulled at the film, without a word.
TEST(MaterialLaw, FilmThatDoesNotResistIsRefused) {
  const auto papers = [](double factor) {
    return
        [factor](double a, double b) { return factor * ((a - 1) * (a - 1) + (b - 1) * (b - 1)); };
  };
  const auto check = [](const LawEnergy& energy) {
    return refusal([&] { check_law(*make_table_law(tabulated(energy))); });
  };
  for (const double factor : {1e-12, 1.0, 1e12}) EXPECT_EQ(check(papers(factor)), "") << factor;
  // What is added to every mm^2 of flat film, be it much, moves nothing.
  EXPECT_EQ(check([&](double a, double b) { return papers(1)(a, b) + 100 * a * b; }), "");
  for (const LawEnergy& without :
       {LawEnergy([](double, double) { return 0.0; }),
        LawEnergy([](double a, double b) { return 5 * a * b; }),
        LawEnergy([](double a, double b) { return a + b; }), LawEnergy(papers(-1))})
    EXPECT_TRUE(contains(check(without), "without stiffness"));
  EXPECT_TRUE(contains(check(papers(1e-200)), "too small"));
  EXPECT_TRUE(contains(check(papers(1e200)), "too large"));
}

// The clamped part has no negative eigenvalue, and is the exact one where nothing was negative.
TEST(MaterialLaw, ClampedStiffnessIsDefinite) {
  const auto matrix = [](const LawStiffness& stiffness) {
    Eigen::Matrix4d K;
    const Vec2 g[2] = {Vec2(1, 0), Vec2(0, 1)};
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) K.block<2, 2>(2 * a, 2 * b) = stiffness.block(g[a], g[b]);
    return K;
  };
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  int clamped = 0;
  for (const Named& named : laws())
    for (int n = 0; n < 200; ++n) {
      Mat2 F;
      F << 1 + 0.6 * unit(generator), unit(generator), unit(generator), 1 + 0.6 * unit(generator);
      const LawState state = law_state(*named.law, F);
      const Eigen::Matrix4d exact = matrix(LawStiffness(state, false));
      const Eigen::Matrix4d definite = matrix(LawStiffness(state, true));
      const Eigenpairs own = eigenpairs(exact), of_clamped = eigenpairs(definite);
      const double scale = own.values.cwiseAbs().maxCoeff();
      EXPECT_GT(of_clamped.values.minCoeff(), -1e-12 * scale);
      const Eigen::MatrixXd nearest =
          own.vectors * own.values.cwiseMax(0).asDiagonal() * own.vectors.transpose();
      EXPECT_LT((definite - nearest).norm(), 1e-9 * scale) << named.name;
      clamped += own.values.minCoeff() < 0;
    }
  EXPECT_GT(clamped, 20);
}

// Both solvers end in the same minimum of a law of one's own, whose forces vanish.
TEST(MaterialLaw, BothSolversRelaxToTheSameFilm) {
  const auto law = make_table_law(tabulated_by_stretch(rubber));
  const RandomFilm film(10);
  const FilmEnergy energy = film.energy(0, law);
  std::vector<VertexVector> found;
  for (const auto& solver : {make_multigrid_solver(film.mesh), make_direct_solver()}) {
    VertexVector u = film.u;
    for (std::size_t v = 0; v < u.size(); ++v)
      if (!film.is_free[v]) u[v] = 0.8 * film.mesh.u[v];
    const RelaxationResult result =
        Relaxation(energy, *solver).run(film.is_free, {.tolerance_mm = 1e-9}, u);
    EXPECT_TRUE(result.converged);
    found.push_back(std::move(u));
  }
  const VertexVector force = fixtures::gradient_by_vertex(energy, found[0], film.is_free);
  for (std::size_t v = 0; v < film.u.size(); ++v) {
    EXPECT_LT((found[0][v] - found[1][v]).norm(), 1e-6);
    EXPECT_LT(force[v].norm(), 1e-6);
  }
}

}  // namespace
}  // namespace hydrodip
