#include "calibrate/stiffness_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/dense_solvers.h"

namespace hydrodip {
namespace {

// 99 % quantiles of the chi-squared distribution with 1, 2, ... degrees of freedom.
constexpr double kChi99[] = {6.63, 9.21, 11.34, 13.28, 15.09, 16.81, 18.48, 20.09};

// The nearest values that do not fall, by least weighted squares: neighbours that fall are pooled
// (Ayer and others, 1955).
std::vector<double> not_falling(const std::vector<double>& values,
                                const std::vector<double>& weights) {
  struct Pool {
    double value, weight;
    std::size_t count;
  };
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < values.size(); ++i) {
    pools.push_back({values[i], weights[i], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].value > pools.back().value) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& first = pools.back();
      const double weight = first.weight + last.weight;
      first.value = (first.value * first.weight + last.value * last.weight) / weight;
      first.weight = weight;
      first.count += last.count;
    }
  }
  std::vector<double> result;
  for (const Pool& pool : pools) result.insert(result.end(), pool.count, pool.value);
  return result;
}

// What is left of the residual if all inks follow the law, with the ratio that suits them best: a
// ratio that was given, or ends at its range, says nothing against the law.
double squares_by_law(const Eigen::MatrixXd& slope, const Eigen::VectorXd& residual,
                      const std::vector<double>& densities, double ratio) {
  const auto inks = Eigen::Index(densities.size()), free = slope.cols() - inks;
  Eigen::VectorXd by_ratio(inks);  // of an ink's logarithm
  for (Eigen::Index i = 0; i < inks; ++i)
    by_ratio[i] = densities[std::size_t(i)] / (1 + densities[std::size_t(i)] * (ratio - 1));
  Eigen::MatrixXd law(slope.rows(), free + 1);
  law << slope.leftCols(free), slope.rightCols(inks) * by_ratio;
  return (residual + law * MinimumNorm(law).solve(-residual)).squaredNorm();
}

}  // namespace

StiffnessTable stiffness_table(const FilmFit& fit, const std::vector<double>& densities,
                               const Eigen::MatrixXd& by_ink) {
  StiffnessTable table;
  std::vector<Eigen::Index> rows, others;
  for (Eigen::Index i = 0; i < fit.residual.size(); ++i)
    if (std::isfinite(fit.residual[i]) && by_ink.row(i).allFinite()) rows.push_back(i);
  for (const int k : {0, 2})
    if (fit.free[std::size_t(k)]) others.push_back(k);
  const auto inks = Eigen::Index(densities.size()), free = Eigen::Index(others.size());
  const Eigen::VectorXd weight = weights_of(fit, rows);
  const double left = freedom_of(weight, double(fit.open) + double(inks + free));
  if (left <= 0 || inks == 0) return table;
  Eigen::MatrixXd slope(Eigen::Index(rows.size()), free + inks);
  slope << fit.jacobian(rows, others), by_ink(rows, Eigen::all);
  slope = weight.asDiagonal() * slope;
  const Eigen::VectorXd residual = weight.cwiseProduct(fit.residual(rows));
  const Eigen::VectorXd change = MinimumNorm(slope).solve(-residual);
  const double squares = (residual + slope * change).squaredNorm();
  const double variance = squares / left;
  const Eigen::MatrixXd covariance =
      variance * MinimumNorm(slope.transpose() * slope).pseudo_inverse();

  const double ratio = from_fit(fit.point).stiffness_ratio;
  std::vector<double> logarithms, weights;
  for (Eigen::Index i = 0; i < inks; ++i) {
    const double law = 1 + densities[std::size_t(i)] * (ratio - 1);
    logarithms.push_back(std::log(law) + change[free + i]);
    weights.push_back(1 / std::max(1e-12, covariance(free + i, free + i)));
  }
  const std::vector<double> rising = not_falling(logarithms, weights);
  for (std::size_t i = 0; i < densities.size(); ++i) {
    const double half = kQuantile / std::sqrt(weights[i]);
    table.inks.push_back({densities[i], 1 + densities[i] * (ratio - 1),
                          std::max(1.0, std::exp(rising[i])),
                          std::max(1.0, std::exp(logarithms[i] - half)),
                          std::max(1.0, std::exp(std::min(700.0, logarithms[i] + half)))});
  }
  if (inks > 1 && variance > 0) {
    const double gain = (squares_by_law(slope, residual, densities, ratio) - squares) / variance;
    const auto freedom = std::min(std::size_t(inks - 1), std::size(kChi99));
    table.gain_per_ink = gain / double(inks - 1);
    table.law_holds = gain < kChi99[freedom - 1];
  }
  return table;
}

CheckeredFilm with_ink_stiffer(const CheckeredFilm& film, const std::vector<double>& densities,
                               std::size_t which, double factor, double ratio) {
  const auto density_at = [&](std::size_t node) { return node == 0 ? 0 : densities[node - 1]; };
  const auto stiffness_at = [&](std::size_t node) {
    return (1 + density_at(node) * (ratio - 1)) * (node == which + 1 ? factor : 1);
  };
  CheckeredFilm bent = film;
  for (double& density : bent.ink_density) {
    std::size_t node = 1;
    while (node < densities.size() && density > density_at(node)) ++node;
    const double t = (density - density_at(node - 1)) / (density_at(node) - density_at(node - 1));
    const double stiffness = (1 - t) * stiffness_at(node - 1) + t * stiffness_at(node);
    density = (stiffness - 1) / (ratio - 1);
  }
  return bent;
}

}  // namespace hydrodip
