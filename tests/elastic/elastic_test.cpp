#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <random>

#include "base/eigenpairs.h"
#include "elastic/by_vertex.h"
#include "elastic/differences.h"
#include "elastic/film_energy.h"
#include "elastic/linear_solver.h"
#include "elastic/relaxation.h"

namespace hydrodip {
namespace {

using fixtures::RandomFilm;

constexpr double kPoissonRatios[] = {-0.3, 0.0, 0.3, 0.49};

TEST(Corotated, EnergyVanishesExactlyForRotations) {
  for (double nu : kPoissonRatios)
    for (double angle : {0.0, 0.3, 2.0, -3.1}) {
      Mat2 R;
      R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
      EXPECT_NEAR(energy_density(R, lame(2.5, nu)), 0, 1e-28);
    }
}

// Equation 3 evaluated from the singular values: tr(S - I) and |S - I| directly.
TEST(Corotated, EnergyIsThePapersEquation3) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 100; ++i) {
    Mat2 F = Mat2::Identity();
    for (int k = 0; k < 4; ++k) F(k / 2, k % 2) += 0.4 * unit(generator);
    if (F.determinant() < 0.05) continue;
    const Vec2 s = Eigen::JacobiSVD<Mat2>(F).singularValues();
    for (double nu : kPoissonRatios) {
      const double K = 3;
      const double trace = s.sum() - 2;
      const double expected = K * (s - Vec2::Ones()).squaredNorm() / (2 * (1 + nu)) +
                              K * nu * trace * trace / (2 * (1 + nu) * (1 - 2 * nu));
      EXPECT_NEAR(energy_density(F, lame(K, nu)), expected, 1e-10 * std::max(1.0, expected));
    }
    EXPECT_NEAR(largest_stretch(F), 1 / s.minCoeff(), 1e-9);
  }
}

TEST(Corotated, RestTriangleReproducesLinearMaps) {
  const Vec2 a(1, 2), b(4, 2.5), c(2, 6);
  Mat2 M;
  M << 1.2, 0.3, -0.1, 0.9;
  const RestTriangle rest = rest_triangle(a, b, c);
  EXPECT_NEAR((deformation_gradient(rest, M * a, M * b, M * c) - M).norm(), 0, 1e-14);
  EXPECT_EQ(rest_triangle(a, c, b).area, 0);
  const RestTriangle in_space =
      rest_triangle(Vec3(0, 0, 0), Vec3(3, 0, 4), Vec3(0, 2, 0));  // right angle, legs 5 and 2
  EXPECT_NEAR(in_space.area, 5, 1e-12);
}

// A triangle keeps its shape wherever it lies in space: inner products of its gradients.
TEST(Corotated, RestTriangleInSpaceIsTheOneInThePlane) {
  const Vec2 a(1, 2), b(4, 2.5), acute(2, 6), obtuse(-3, 3);
  for (const Vec2& c : {acute, obtuse}) {
    const RestTriangle flat = rest_triangle(a, b, c);
    const Eigen::Matrix3d shape = flat.gradient * flat.gradient.transpose();
    for (const double angle : {0.0, 0.9, 2.5}) {
      const Eigen::AngleAxisd turn(angle, Vec3(2, -1, 2) / 3);
      const auto at = [&](const Vec2& p) { return Vec3(turn * Vec3(p.x(), p.y(), 5)); };
      const RestTriangle in_space = rest_triangle(at(a), at(b), at(c));
      EXPECT_NEAR(in_space.area, flat.area, 1e-12);
      EXPECT_LT((in_space.gradient * in_space.gradient.transpose() - shape).norm(), 1e-12);
    }
  }
}

TEST(FilmEnergy, GradientAndHessianMatchFiniteDifferences) {
  for (double nu : kPoissonRatios) {
    const RandomFilm film(7);
    const FilmEnergy energy = film.energy(nu);
    fixtures::expect_gradient(energy, film.u, film.is_free, 1e-6);
    fixtures::expect_hessian(energy, film.u, 1e-6);
  }
}

Eigen::MatrixXd dense(const BlockMatrix& H) {
  const auto n = Eigen::Index(H.row_begin.size()) - 1;
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  for (Eigen::Index v = 0; v < n; ++v)
    for (auto s = H.row_begin[std::size_t(v)]; s < H.row_begin[std::size_t(v) + 1]; ++s)
      M.block<2, 2>(2 * v, 2 * H.column[std::size_t(s)]) = H.block[std::size_t(s)];
  return M;
}

Vec2 times(const BlockMatrix& H, const VertexVector& x, std::size_t v) {
  Vec2 sum = Vec2::Zero();
  for (auto s = H.row_begin[v]; s < H.row_begin[v + 1]; ++s)
    sum += H.block[std::size_t(s)] * x[std::size_t(H.column[std::size_t(s)])];
  return sum;
}

double norm(const VertexVector& x, const std::vector<std::uint8_t>& is_free) {
  double sum = 0;
  for (std::size_t v = 0; v < x.size(); ++v) sum += is_free[v] ? x[v].squaredNorm() : 0;
  return std::sqrt(sum);
}

TEST(FilmEnergy, ProjectedHessianIsDefiniteAndExactWhereNothingWasProjected) {
  const RandomFilm film(9);
  for (double nu : kPoissonRatios) {
    const FilmEnergy energy = film.energy(nu);
    BlockMatrix H;
    energy.hessian(film.u, true, H);
    const Eigen::MatrixXd M = dense(H);
    EXPECT_LT((M - M.transpose()).norm(), 1e-12 * M.norm());
    const Eigen::VectorXd eigenvalues = eigenpairs(M).values;
    EXPECT_GT(eigenvalues.minCoeff(), -1e-10 * eigenvalues.maxCoeff());

    VertexVector wide = film.u;  // tr S > 2 everywhere: nothing to project
    for (Vec2& p : wide) p *= 2;
    BlockMatrix exact;
    energy.hessian(wide, true, H);
    energy.hessian(wide, false, exact);
    EXPECT_LT((dense(H) - dense(exact)).norm(), 1e-12 * dense(exact).norm());
  }
}

// Of a quadratic energy: the direct solver's step ends at its minimum, conjugate directions get
// there step by step.
TEST(LinearSolver, BothSolversFindTheMinimum) {
  const RandomFilm film(10);

  for (double nu : kPoissonRatios) {
    const FilmEnergy energy = film.energy(nu);
    BlockMatrix H;
    energy.hessian(film.u, true, H);
    const FilmGrid& grid = energy.grid();
    VertexVector b(film.u.size()), exact;
    for (std::size_t v = 0; v < b.size(); ++v)
      b[v] = Vec2(std::sin(double(v)), std::cos(2.0 * double(v)));
    const auto direct = make_direct_solver();
    const auto multigrid = make_multigrid_solver(film.mesh);
    direct->update(energy, grid.field(film.u), film.is_free, true);
    multigrid->update(energy, grid.field(film.u), film.is_free, true);
    const auto exact_step = direct->direction(grid.field(b));
    ASSERT_TRUE(exact_step);
    exact = fixtures::by_vertex(grid, *exact_step);
    VertexVector iterative(b.size(), Vec2::Zero()), residual = b;
    int iterations = 0;
    while (norm(residual, film.is_free) > 1e-5 * norm(b, film.is_free)) {
      const auto step = multigrid->direction(grid.field(residual));
      ASSERT_TRUE(step);
      ASSERT_LT(++iterations, 25);
      const VertexVector way = fixtures::by_vertex(grid, *step);
      for (std::size_t v = 0; v < b.size(); ++v) iterative[v] += way[v];
      for (std::size_t v = 0; v < b.size(); ++v) residual[v] = b[v] - times(H, iterative, v);
    }
    double scale = 0, worst = 0;
    for (std::size_t v = 0; v < b.size(); ++v) {
      if (film.is_free[v])
        EXPECT_LT((times(H, exact, v) - b[v]).norm(), 1e-5);  // of 1, in single precision
      else
        EXPECT_EQ(exact[v].norm() + iterative[v].norm(), 0);
      scale = std::max(scale, exact[v].norm());
      worst = std::max(worst, (exact[v] - iterative[v]).norm());
    }
    EXPECT_LT(worst, 1e-3 * scale);
  }
}

// Even film whose rim is moved: the linear map is the exact minimiser for every Poisson's ratio.
struct StretchedFilm : RandomFilm {
  VertexVector minimum, start;

  StretchedFilm() : RandomFilm(11), minimum(mesh.u) {
    Mat2 M;
    M << 0.9, 0.05, 0.05, 0.8;
    for (Vec2& p : minimum) p = M * p;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& v = mesh.triangles[t];
      modulus[t] = 1;
      rest[t] = rest_triangle(mesh.u[std::size_t(v[0])], mesh.u[std::size_t(v[1])],
                              mesh.u[std::size_t(v[2])]);
    }
    start = minimum;
    for (std::size_t v = 0; v < start.size(); ++v)
      if (is_free[v]) start[v] += 0.1 * mesh.cell_mm * Vec2(std::sin(7.0 * double(v)), 0.5);
  }
  double error(const VertexVector& at) const {
    double worst = 0;
    for (std::size_t v = 0; v < at.size(); ++v)
      worst = std::max(worst, (at[v] - minimum[v]).norm());
    return worst;
  }
};

TEST(Relaxation, RecoversALinearMapFromAnyStart) {
  for (double nu : {0.0, 0.4}) {
    const StretchedFilm film;
    const FilmEnergy energy = film.energy(nu);
    VertexVector u = film.start;
    const auto solver = make_multigrid_solver(film.mesh);
    const RelaxationResult result =
        Relaxation(energy, *solver).run(film.is_free, {.tolerance_mm = 1e-10}, u);
    EXPECT_TRUE(result.converged);
    EXPECT_LT(film.error(u), 1e-7);
  }
}

// Stiff film on one side of a vertex has its rest shape where the vertex lies beyond the soft film
// on the other side: it stops before that turns over, and says which film is in the way.
TEST(Relaxation, SaysWhichFilmWouldHaveToTurnOver) {
  const FilmMesh mesh = make_film_mesh(
      {.width_mm = 30, .height_mm = 30, .margin_mm = 5, .elements = 8, .grading = 1});
  ASSERT_EQ(mesh.triangles.size(), 8U);
  const std::size_t centre = std::size_t(mesh.vertex_at[4]);
  VertexVector wanted = mesh.u;
  wanted[centre] = Vec2(14, 0);  // the film ends at 10
  std::vector<double> modulus;
  std::vector<RestTriangle> rest;
  std::vector<std::int32_t> in_the_way;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto triangle_in = [&](const VertexVector& at) {
      const Triangle& v = mesh.triangles[t];
      return rest_triangle(at[std::size_t(v[0])], at[std::size_t(v[1])], at[std::size_t(v[2])]);
    };
    const bool stiff = triangle_in(wanted).area > 0;
    rest.push_back(triangle_in(stiff ? wanted : mesh.u));
    modulus.push_back(stiff ? 1000 : 1);
    if (!stiff) in_the_way.push_back(std::int32_t(t));
  }
  ASSERT_FALSE(in_the_way.empty());
  FilmEnergy energy(mesh, modulus, 0);
  energy.set_rest(rest);
  std::vector<std::uint8_t> is_free(mesh.u.size(), 0);
  is_free[centre] = 1;
  for (const auto& solver : {make_multigrid_solver(mesh), make_direct_solver()}) {
    VertexVector u = mesh.u;
    const RelaxationResult result = Relaxation(energy, *solver).run(is_free, {}, u);
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.blocked, in_the_way);
    EXPECT_FALSE(energy.any_inverted(energy.grid().field(u)));
    EXPECT_GT(u[centre].x(), 8);
  }
}

// Newton's steps, but so many times as long.
class Misjudging : public LinearSolver {
 public:
  explicit Misjudging(double factor) : factor_(factor) {}
  void update(const FilmEnergy& energy, const GridField& u,
              const std::vector<std::uint8_t>& is_free, bool definite, double moved_mm) override {
    newton_->update(energy, u, is_free, definite, moved_mm);
  }
  std::optional<SearchDirection> direction(const GridField& gradient) override {
    auto newton = newton_->direction(gradient);
    if (newton) newton->length *= factor_;
    return newton;
  }

 private:
  std::unique_ptr<LinearSolver> newton_ = make_direct_solver();
  double factor_;
};

// By the slopes at both ends of a step it is known how long it should have been. Without them,
// steps of a sixth leave five sixths of the error each.
TEST(Relaxation, MendsStepsThatAreTooShortOrTooLong) {
  const StretchedFilm film;
  const FilmEnergy energy = film.energy(0.2);
  for (const double factor : {1.0 / 6, 0.4, 1.0, 2.2, 6.0}) {
    VertexVector u = film.start;
    Misjudging solver(factor);
    const RelaxationResult result =
        Relaxation(energy, solver).run(film.is_free, {.tolerance_mm = 1e-10}, u);
    EXPECT_TRUE(result.converged) << factor;
    EXPECT_LE(result.iterations, 8) << factor;
    EXPECT_LT(film.error(u), 1e-6) << factor;
  }
}

// Whatever the solver says: steps so long that they turn film over, or only lead far up the other
// side, end lower than they began.
TEST(Relaxation, NeverRaisesTheEnergy) {
  const StretchedFilm film;
  const FilmEnergy energy = film.energy(0.2);
  const auto energy_at = [&](const VertexVector& u) {
    return energy.value(energy.grid().field(u));
  };
  for (const double factor : {3.0, 20.0, 30.0, 45.0, 70.0, 100.0}) {
    VertexVector u = film.start;
    Misjudging solver(factor);
    Relaxation(energy, solver).run(film.is_free, {.tolerance_mm = 1e-10, .max_iterations = 1}, u);
    EXPECT_LT(energy_at(u), energy_at(film.start)) << factor;
    EXPECT_FALSE(energy.any_inverted(energy.grid().field(u))) << factor;
  }
}

TEST(Relaxation, ToleranceGrowsWithTheWay) {
  const StretchedFilm film;
  const FilmEnergy energy = film.energy(0.2);
  const auto iterations = [&](double per_way2, double loosest_mm, double* error_mm) {
    VertexVector u = film.start;
    const auto solver = make_multigrid_solver(film.mesh);
    const RelaxationOptions options{
        .tolerance_mm = 1e-9, .tolerance_per_way2 = per_way2, .loosest_mm = loosest_mm};
    const RelaxationResult result = Relaxation(energy, *solver).run(film.is_free, options, u);
    EXPECT_TRUE(result.converged);
    *error_mm = film.error(u);
    return result.iterations;
  };
  double exact = 0, rough = 0;
  const int many = iterations(0, 0, &exact);
  // It has a tenth of a cell to go.
  const double way = 0.1 * film.mesh.cell_mm, tolerance = 1e-3;
  const int few = iterations(tolerance / (way * way), 1, &rough);
  EXPECT_LT(few, many);
  EXPECT_LT(exact, 1e-7);
  EXPECT_LT(rough, 2 * tolerance);
  double bounded = 0;
  iterations(1e3, 1e-8, &bounded);
  EXPECT_LT(bounded, 1e-7);
}

}  // namespace
}  // namespace hydrodip
