#include "plan/labelling.h"

#include <gtest/gtest.h>

#include <random>

namespace hydrodip {
namespace {

struct Problem {
  int labels;
  std::vector<std::int32_t> costs;
  std::vector<LabelEdge> edges;
  std::size_t nodes() const { return costs.size() / std::size_t(labels); }
};

std::int64_t least_of_all(const Problem& p) {
  std::vector<std::uint8_t> label(p.nodes(), 0);
  std::int64_t least = cost_of_labels(p.labels, p.costs, p.edges, label);
  for (;;) {
    std::size_t v = 0;
    while (v < label.size() && ++label[v] == p.labels) label[v++] = 0;
    if (v == label.size()) return least;
    least = std::min(least, cost_of_labels(p.labels, p.costs, p.edges, label));
  }
}

Problem random_problem(int labels, int nodes, unsigned seed, unsigned dearest = 100) {
  std::mt19937 random(seed);
  Problem p{labels, {}, {}};
  for (int i = 0; i < nodes * labels; ++i) p.costs.push_back(std::int32_t(random() % dearest));
  for (int a = 0; a < nodes; ++a)
    for (int b = a + 1; b < nodes; ++b)
      if (random() % 3 == 0) p.edges.push_back({a, b, std::int32_t(random() % 60)});
  return p;
}

// Where edges decide, where nodes do, and where some nodes are decided before any edge is looked
// at.
TEST(Labelling, TwoLabelsAreExact) {
  for (const unsigned dearest : {20, 100, 300, 2000})
    for (unsigned seed = 0; seed < 40; ++seed) {
      const Problem p = random_problem(2, 10, seed, dearest);
      const auto label = best_labels(2, p.costs, p.edges, std::vector<std::uint8_t>(p.nodes(), 0));
      EXPECT_EQ(cost_of_labels(2, p.costs, p.edges, label), least_of_all(p)) << seed;
    }
}

TEST(Labelling, ManyLabelsAreWithinAFactorOfTwo) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Problem p = random_problem(4, 7, seed);
    const auto label = best_labels(4, p.costs, p.edges, std::vector<std::uint8_t>(p.nodes(), 0));
    EXPECT_LE(cost_of_labels(4, p.costs, p.edges, label), 2 * least_of_all(p)) << seed;
  }
}

TEST(Labelling, NeverCostsMoreThanTheStart) {
  const Problem p = random_problem(5, 60, 7);
  std::vector<std::uint8_t> start(p.nodes());
  for (std::size_t v = 0; v < start.size(); ++v) start[v] = std::uint8_t(v % 5);
  const auto label = best_labels(5, p.costs, p.edges, start);
  EXPECT_LE(cost_of_labels(5, p.costs, p.edges, label), cost_of_labels(5, p.costs, p.edges, start));
}

// A strip of nodes, one end wanting one label and the other end the other: the change comes where
// it is cheap.
TEST(Labelling, ChangesWhereThatIsCheap) {
  constexpr int kNodes = 21;
  Problem p{2, std::vector<std::int32_t>(2 * kNodes, 0), {}};
  p.costs[1] = 1000;               // the first wants 0
  p.costs[2 * kNodes - 2] = 1000;  // the last wants 1
  for (int v = 0; v + 1 < kNodes; ++v) p.edges.push_back({v, v + 1, v == 13 ? 3 : 50});
  const auto label = best_labels(2, p.costs, p.edges, std::vector<std::uint8_t>(kNodes, 0));
  for (int v = 0; v < kNodes; ++v) EXPECT_EQ(int(label[std::size_t(v)]), v > 13 ? 1 : 0) << v;
}

TEST(Labelling, NothingIsNoProblem) { EXPECT_TRUE(best_labels(3, {}, {}, {}).empty()); }

}  // namespace
}  // namespace hydrodip
